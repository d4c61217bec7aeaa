"""What townspeople do at places of work: keep a stall, sweep, sit, draw water.

Each clip starts from relaxed standing (clips.py), bends the trunk, and then puts hands and feet
where the work is by two-bone inverse kinematics. Lengths are metres on a figure of 1.7 m; x is
the person's left, -y ahead, z up.
"""

import numpy as np

from townspeople import clips, gait
from townspeople import skeleton as sk
from townspeople.body import WALK_FRAMES_PER_SECOND

SEAT_M = 0.46  # of the seats that `sit` is made for, whoever sits
UNDER_HIP_M = 0.085  # from the hip joint down to the seat
ARM = ("shoulder02", "upperarm02", "lowerarm01", "lowerarm02", "wrist")
FINGERS = ("finger1-1", "finger3-1", "finger3-2")
SIDES = (("_L", 1.0), ("_R", -1.0))
ON_PALM = 0.28  # of a palm's length, that what is gripped lies before it

# By person, what they can do. Skirts and long tunics stand off like bells where somebody sits.
WORK = {
    "merchant": ("keep", "sit"), "farmer": ("keep", "sweep"), "craftsman": ("sweep", "sit"),
    "townswoman": ("keep",), "maid": ("sweep", "draw_water"),
}


def _unit(v):
    v = np.asarray(v, float)
    return v / np.sqrt(v @ v)


def _frame(way, side):
    """Columns: the way, what is left of `side` across it, and both's normal."""
    way = _unit(way)
    left = _unit(side - way * (side @ way))
    return np.stack([way, left, sk.cross(way, left)], axis=1)


def _reach(skeleton, rotations, root, side, hand, elbow, turn=None):
    """Bends an arm so that the wrist is at `hand`, the elbow pointing to `elbow`.

    turn: the hand's own rotation, else it goes on as the forearm does.
    """
    rest = [skeleton.head(name + side) for name in ("shoulder02", "lowerarm01", "wrist")]
    upper, fore = np.linalg.norm(rest[1] - rest[0]), np.linalg.norm(rest[2] - rest[1])
    start = sk.head_in_pose(skeleton, rotations, root, skeleton.index("shoulder02" + side))
    line = hand - start
    distance = np.clip(np.linalg.norm(line), 0.3 * (upper + fore), 0.995 * (upper + fore))
    line = _unit(line)
    out = _unit(np.asarray(elbow, float) - line * (line @ elbow))
    along = (upper**2 - fore**2 + distance**2) / (2 * distance)
    bend = start + line * along + out * np.sqrt(max(upper**2 - along**2, 0.0))
    end = start + line * distance
    hinge = _unit(sk.cross(end - bend, bend - start))
    at_rest = sk.cross(rest[2] - rest[1], rest[1] - rest[0])
    at_rest = _unit(at_rest) if np.linalg.norm(at_rest) > 1e-6 else np.array([1.0, 0.0, 0.0])
    first = _frame(bend - start, hinge) @ _frame(rest[1] - rest[0], at_rest).T
    second = _frame(end - bend, hinge) @ _frame(rest[2] - rest[1], at_rest).T
    wrist = skeleton.index("wrist" + side)
    curls = {name: rotations[wrist].T @ rotations[skeleton.index(name + side)] for name in FINGERS}
    for name, own in zip(ARM, (first, first, second, second, second if turn is None else turn)):
        rotations[skeleton.index(name + side)] = own
    for name, curl in curls.items():
        rotations[skeleton.index(name + side)] = rotations[wrist] @ curl


def hand_frame(skeleton, side):
    """Of a hand at rest: the middle of what it grips, the way of the fingers, and up along what it
    grips (where the thumb is).
    """
    wrist, knuckle = skeleton.head("wrist" + side), skeleton.head("finger3-1" + side)
    fingers = _unit(knuckle - wrist)
    thumb = skeleton.head("finger1-1" + side) - wrist
    thumb = _unit(thumb - fingers * (thumb @ fingers))
    off_palm = ON_PALM * np.linalg.norm(knuckle - wrist) * _palm(fingers, thumb, side)
    return wrist + 0.85 * (knuckle - wrist) + off_palm, fingers, thumb


def _palm(fingers, thumb, side):
    """The way that the palm looks."""
    return sk.cross(fingers, thumb) * dict(SIDES)[side]


def _close(skeleton, rotations, side, fingers, thumb):
    """Fingers and thumb, whose ways at rest these are, about what lies on the palm."""
    palm = _palm(fingers, thumb, side)
    hand = rotations[skeleton.index("wrist" + side)]
    for name, way, degrees in (("finger3-1", fingers, 62.0), ("finger3-2", fingers, 140.0), ("finger1-1", thumb, 40.0)):
        turn = clips._matrix_of(sk.cross(way, palm) * np.radians(degrees))
        rotations[skeleton.index(name + side)] = hand @ turn


def _grip(skeleton, rotations, root, side, at, up, fingers, elbow):
    """The hand holds a stick at `at` that goes `up` through it."""
    held, way, thumb = hand_frame(skeleton, side)
    turn = _frame(up, np.asarray(fingers, float)) @ _frame(thumb, way).T
    hand = at - turn @ (held - skeleton.head("wrist" + side))
    _reach(skeleton, rotations, root, side, hand, elbow, turn)
    _close(skeleton, rotations, side, way, thumb)


def _stand(figure, manner, seconds, bend, turn=None):
    """Standing poses with the trunk bent and turned by functions of the phase (degrees)."""
    frames = int(seconds * WALK_FRAMES_PER_SECOND) + 1
    local, roots = clips._standing(figure, frames, manner)
    skeleton = figure.skeleton
    phases = np.linspace(0.0, 2.0 * np.pi, frames)
    for t, frame in zip(phases, local):
        lean = bend(t)
        for name, share in (("spine05", 0.45), ("spine03", 0.3), ("spine01", 0.25)):
            clips._turn(skeleton, frame, name, "x", share * lean)
            if turn is not None:
                clips._turn(skeleton, frame, name, "z", share * turn(t))
        clips._turn(skeleton, frame, "head", "x", -0.45 * lean)
    return phases, clips._globals(skeleton, local), roots


def _closed(name, rotations, roots):
    rotations[-1], roots[-1] = rotations[0], roots[0]
    return clips.Clip(name, rotations, roots)


def keep(figure, manner):
    """Behind a counter: one hand on it, the other shows and offers; a look to either side."""
    skeleton, size = figure.skeleton, figure.landmarks["crown"][2] / 1.7
    phases, rotations, roots = _stand(
        figure, manner, 6.0, lambda t: 9.0 + 3.0 * np.sin(t), lambda t: 14.0 * np.sin(t)
    )
    for t, pose, root in zip(phases, rotations, roots):
        offer = 0.5 - 0.5 * np.cos(2 * t)
        right = np.array([-0.24 - 0.10 * np.sin(t), -0.36 - 0.16 * offer, 0.97 + 0.22 * offer])
        left = np.array([0.30 + 0.04 * np.sin(t), -0.36, 0.97])
        _reach(skeleton, pose, root, "_R", right * size, (-0.7, 0.5, -0.4))
        _reach(skeleton, pose, root, "_L", left * size, (0.7, 0.5, -0.4))
    return _closed("keep", rotations, roots)


def broom_line(t, size):
    """Upper end and way down of the broomstick."""
    foot = np.array([-0.05 + 0.42 * np.sin(t), -0.72 + 0.05 * np.cos(2 * t), 0.05])
    top = np.array([-0.12 + 0.10 * np.sin(t), -0.20, 1.30])
    return top * size, _unit(foot - top)


def sweep(figure, manner):
    """Both hands on a broom that goes from side to side before the feet."""
    skeleton, size = figure.skeleton, figure.landmarks["crown"][2] / 1.7
    phases, rotations, roots = _stand(
        figure, manner, 2.4, lambda t: 16.0 + 2.0 * np.cos(2 * t), lambda t: 12.0 * np.sin(t)
    )
    for t, pose, root in zip(phases, rotations, roots):
        top, down = broom_line(t, size)
        _grip(skeleton, pose, root, "_R", top + 0.14 * size * down, -down, (0.8, -0.6, 0.0),
              (-0.8, 0.5, 0.1))
        far = 0.38 + 0.12 * np.sin(t)  # no farther than the left arm reaches across
        _grip(skeleton, pose, root, "_L", top + far * size * down, -down, (-0.8, -0.6, 0.0),
              (0.8, 0.5, -0.2))
    return _closed("sweep", rotations, roots)


def draw_water(figure, manner):
    """Leans over a well's rim and hauls a rope, hand over hand."""
    skeleton, size = figure.skeleton, figure.landmarks["crown"][2] / 1.7
    phases, rotations, roots = _stand(figure, manner, 2.8, lambda t: 40.0 + 3.0 * np.sin(t))
    up = np.array([0.0, 0.0, 1.0])
    for t, pose, root in zip(phases, rotations, roots):
        haul = 0.5 + 0.5 * np.cos(t)
        _grip(skeleton, pose, root, "_R", np.array([-0.02, -0.84, 1.00 + 0.30 * haul]) * size, up,
              (0.6, -0.8, 0.0), (-0.9, 0.3, -0.3))
        _grip(skeleton, pose, root, "_L", np.array([0.02, -0.84, 1.24 - 0.24 * haul]) * size, up,
              (-0.6, -0.8, 0.0), (0.9, 0.3, -0.3))
    return _closed("draw_water", rotations, roots)


def sit(figure, manner):
    """On a seat behind the feet; hands on the thighs, now and then a look about."""
    skeleton, size = figure.skeleton, figure.landmarks["crown"][2] / 1.7
    phases, rotations, roots = _stand(
        figure, manner, 6.0, lambda t: 7.0 + 2.0 * np.sin(t), lambda t: 5.0 * np.sin(t)
    )
    head = skeleton.head
    thigh, shin = (np.linalg.norm(head(b + "_L") - head(a + "_L"))
                   for a, b in (("upperleg02", "lowerleg01"), ("lowerleg01", "foot")))
    hip_z = SEAT_M + UNDER_HIP_M * size
    back = thigh + 0.09 * size
    left = np.array([1.0, 0.0, 0.0])
    for t, pose, root in zip(phases, rotations, roots):
        root += np.array([0.0, back, hip_z - head("upperleg02_L")[2]]) + skeleton.heads[0] - root
        for side, sign in SIDES:
            hip = pose[0] @ (head("upperleg02" + side) - skeleton.heads[0]) + root
            ankle = np.array([hip[0] + sign * 0.03 * size, hip[1] - thigh,
                              max(head("foot" + side)[2], hip_z - 0.97 * shin)])
            turns = gait._leg_rotations(skeleton, side, hip, ankle, left)
            for name, own in zip(("upperleg02", "lowerleg01"), turns):
                pose[skeleton.index(name + side)] = own
            pose[skeleton.index("foot" + side)] = sk.rotation("z", sign * 8.0)
            knee = hip + turns[0] @ (head("lowerleg01" + side) - head("upperleg02" + side))
            hand = 0.45 * hip + 0.55 * knee + np.array([sign * 0.05, 0.0, 0.15]) * size
            _, way, thumb = hand_frame(skeleton, side)
            flat = _frame((-sign, 0.35, 0.0), np.array([-sign * 0.3, -0.9, -0.25])) @ _frame(thumb, way).T
            _reach(skeleton, pose, root, side, hand, (sign * 0.8, 0.6, -0.2), flat)
    return _closed("sit", rotations, roots)


CLIPS = {"keep": keep, "sweep": sweep, "sit": sit, "draw_water": draw_water}


def work_clips(figure, person, manner):
    """The clips of whom a name stands for."""
    return [CLIPS[name](figure, manner) for name in WORK.get(person, ())]
