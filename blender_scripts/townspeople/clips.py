"""The clips walk, idle and talk as global joint rotations and root positions, frame by frame."""

from dataclasses import dataclass

import numpy as np

from townspeople import eyes, gait
from townspeople import skeleton as sk
from townspeople.body import WALK_FRAMES_PER_SECOND

IDLE_SECONDS = 4.0
CONTACT_BAND_M = 0.01  # sole points this near to the ground carry the person
STRIDE = 1.36  # double step of a walk, in leg lengths


@dataclass
class Clip:
    name: str
    rotations: np.ndarray  # (frames, joints, 3, 3) global; the last frame repeats the first
    roots: np.ndarray  # (frames, 3)


@dataclass
class Manner:
    """How a person moves."""

    arm_spread_deg: float = 0.0  # arms held off the body, for wide skirts
    stride: float = 1.0  # double step against an adult's usual one on these legs
    liveliness: float = 1.0  # of the trunk while walking
    arm_swing: float = 1.0  # of the arms while walking
    arm_forward_deg: float = 0.0  # arms held before the body, for cloaks
    stoop_deg: float = 0.0  # bend of the back


def _vector_of(matrix):
    """Rotation vector (axis times angle)."""
    angle = np.arccos(np.clip((np.trace(matrix) - 1.0) * 0.5, -1.0, 1.0))
    axis = np.array(
        [matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]]
    )
    length = np.linalg.norm(axis)
    return axis / length * angle if length > 1e-9 else np.zeros(3)


def _matrix_of(vector):
    angle = np.linalg.norm(vector)
    if angle < 1e-9:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def _closed_loop(skeleton, rotations, roots):
    """Spreads what is missing between last and first frame over the cycle."""
    frames = len(rotations)
    local = np.array([sk.local_from_global(skeleton, frame) for frame in rotations])
    for joint in range(local.shape[1]):
        gap = _vector_of(local[-1, joint].T @ local[0, joint])
        for f in range(frames):
            local[f, joint] = local[f, joint] @ _matrix_of(gap * f / (frames - 1))
    local[-1] = local[0]
    roots = roots + (roots[0] - roots[-1]) * np.linspace(0, 1, frames)[:, None]
    return local, roots


def _globals(skeleton, local):
    names = skeleton.names
    return np.array([sk.global_from_local(skeleton, dict(zip(names, frame))) for frame in local])


def walk_clip(figure, manner):
    """The source's walk with some life in the trunk and feet that roll; also its measured speed
    in m/s.
    """
    skeleton = figure.skeleton
    local, _ = _closed_loop(skeleton, figure.walk, figure.walk_root)
    phases = np.linspace(0.0, 2.0 * np.pi, len(local)) - gait.STRIKE_FRAME / 24.0 * 2.0 * np.pi
    for frame, phase in zip(local, phases):
        frame[0] = np.eye(3)
        _calm_arms(skeleton, frame, manner.arm_swing)
        _enliven(skeleton, frame, np.cos(phase), np.sin(phase), manner)
        _hold(skeleton, frame, manner, 2.0)
    turn = 4.0 * manner.liveliness * np.cos(phases)  # of the head: the eyes stay on the way
    eyes.animate(skeleton, local, np.zeros(len(local)), np.stack([-0.6 * turn, np.full(len(local), 2.0)], axis=1))
    rotations = _globals(skeleton, local)
    leg = skeleton.head("upperleg02_L")[2]
    roots = gait.step_legs(
        figure, rotations, STRIDE * manner.stride * leg, 0.72 * skeleton.head("upperleg02_L")[0]
    )
    return Clip("walk", rotations, roots), _measured_speed(figure, rotations, roots)


def _turn(skeleton, frame, name, axis, degrees):
    """Adds a turn about a world axis (before the joint's own rotation)."""
    joint = skeleton.index(name)
    frame[joint] = sk.rotation(axis, degrees) @ frame[joint]


def _calm_arms(skeleton, frame, share):
    """Scales the source's own arm swing (the rest pose is its mean)."""
    for joint, name in enumerate(skeleton.names):
        if name.startswith(("shoulder02", "upperarm02", "lowerarm01")):
            frame[joint] = _matrix_of(_vector_of(frame[joint]) * share)


def _enliven(skeleton, frame, ahead, over, manner):
    """Counter-turn of hips and chest, more arm swing, elbows that give.

    ahead: 1 where the left foot strikes, -1 where the right does. over: 1 where the left leg
    carries.
    """
    swings = manner.arm_swing * ahead
    ahead, over = ahead * manner.liveliness, over * manner.liveliness
    _turn(skeleton, frame, "root", "z", -4.0 * ahead)
    _turn(skeleton, frame, "root", "y", 1.5 * over)
    _turn(skeleton, frame, "spine05", "z", 4.0 * ahead)
    _turn(skeleton, frame, "spine05", "y", -2.0 * over)
    _turn(skeleton, frame, "spine01", "z", 5.0 * ahead)
    _turn(skeleton, frame, "neck01", "z", -4.0 * ahead)
    for side, sign in (("_L", 1.0), ("_R", -1.0)):
        swing = sign * swings  # positive x turns backward: left arm, where the left foot strikes
        _turn(skeleton, frame, "shoulder02" + side, "x", 10.0 * swing)
        _turn(skeleton, frame, "lowerarm01" + side, "x", 6.0 + 7.0 * swing)


def _hold(skeleton, frame, manner, lean_deg):
    """The person's own bearing: arms off the body, a bent back, the head still upright."""
    bend = manner.stoop_deg
    _turn(skeleton, frame, "spine05", "x", lean_deg + 0.5 * bend)
    _turn(skeleton, frame, "spine01", "x", 0.7 * bend)
    _turn(skeleton, frame, "neck01", "x", 0.4 * bend)
    _turn(skeleton, frame, "head", "x", -lean_deg - 1.1 * bend)
    for side, sign in (("_L", 1.0), ("_R", -1.0)):
        _turn(skeleton, frame, "shoulder02" + side, "x", -0.8 * bend - manner.arm_forward_deg)
        _turn(skeleton, frame, "shoulder02" + side, "y", -sign * manner.arm_spread_deg)
        _curl_fingers(skeleton, frame, side, sign)


def _curl_fingers(skeleton, frame, side, sign):
    """Fingers a little bent towards the palm, as hands hang."""
    along = skeleton.head("finger3-2" + side) - skeleton.head("finger3-1" + side)
    thumb = skeleton.head("finger1-1" + side) - skeleton.head("wrist" + side)
    palm = sk.cross(along, thumb) * sign
    axis = sk.cross(along, palm)
    axis /= np.linalg.norm(axis)
    for name, degrees in (("finger3-1", 16.0), ("finger3-2", 24.0)):
        joint = skeleton.index(name + side)
        frame[joint] = _matrix_of(axis * np.radians(degrees)) @ frame[joint]


def _soles(figure):
    """Rest positions and weights of the shoes' lowest vertices."""
    shoes = figure.parts["shoes"]
    low = shoes.vertices[:, 2] < shoes.vertices[:, 2].min() + 0.02
    return shoes.vertices[low], shoes.weights[low]


def _sole_tracks(figure, rotations, roots):
    points, weights = _soles(figure)
    return np.array(
        [
            sk.skinned(points, weights, sk.transforms(figure.skeleton, r, p))
            for r, p in zip(rotations, roots)
        ]
    )


def _measured_speed(figure, rotations, roots):
    """Backward speed of the sole points that touch the ground."""
    tracks = _sole_tracks(figure, rotations, roots)
    steps = []
    for now, after in zip(tracks, tracks[1:]):
        touching = np.maximum(now[:, 2], after[:, 2]) < CONTACT_BAND_M
        if touching.any():
            steps.append(np.median(after[touching, 1] - now[touching, 1]))
    return float(np.median(steps) * WALK_FRAMES_PER_SECOND)


def _standing(figure, frames, manner):
    """Relaxed standing: arms down, elbows a little bent, breathing, weight going from foot to
    foot.
    """
    skeleton = figure.skeleton
    turns = np.linspace(0.0, 2.0 * np.pi, frames)
    leg = skeleton.head("upperleg02_L")[2]
    roots, locals_ = [], []
    for t in turns:
        frame = np.tile(np.eye(3), (len(skeleton.names), 1, 1))
        sway, breath = 0.016 * leg / 0.82 * np.sin(t), np.sin(2 * t)
        lean = np.degrees(sway / leg)
        for side, sign in (("_L", 1.0), ("_R", -1.0)):
            _turn(skeleton, frame, "upperleg02" + side, "y", lean)
            _turn(skeleton, frame, "foot" + side, "y", -lean)
            _turn(skeleton, frame, "upperleg02" + side, "z", sign * 6.0)
            _turn(skeleton, frame, "shoulder02" + side, "y", sign * (9.0 + 0.6 * breath))
            _turn(skeleton, frame, "lowerarm01" + side, "x", 8.0 + 1.0 * breath)
            _turn(skeleton, frame, "clavicle" + side, "y", -sign * 0.8 * breath)
        _turn(skeleton, frame, "spine05", "y", -1.2 * np.sin(t))
        _turn(skeleton, frame, "spine03", "x", -0.9 * breath)
        _turn(skeleton, frame, "neck01", "x", 0.8 * breath)
        _turn(skeleton, frame, "head", "z", 5.0 * np.sin(t + 0.8))
        _turn(skeleton, frame, "head", "y", 1.5 * np.sin(t))
        _hold(skeleton, frame, manner, 0.0)
        roots.append(skeleton.heads[0] + np.array([sway, 0.0, 0.0]))
        locals_.append(frame)
    return np.array(locals_), np.array(roots)


def _clip(figure, name, local, roots):
    rotations = _globals(figure.skeleton, local)
    tracks = _sole_tracks(figure, rotations, roots)
    roots = roots - tracks[:, :, 2].min(axis=1)[:, None] * np.array([0.0, 0.0, 1.0])
    rotations[-1], roots[-1] = rotations[0], roots[0]
    return Clip(name, rotations, roots)


def idle_clip(figure, manner):
    frames = int(IDLE_SECONDS * WALK_FRAMES_PER_SECOND) + 1
    local, roots = _standing(figure, frames, manner)
    look = eyes.glances(frames, [[14, 9.0, 1.0], [31, -7.0, 3.0], [58, 4.0, 0.0], [74, -10.0, 1.0], [88, 0.0, 0.0]])
    eyes.animate(figure.skeleton, local, eyes.closing(frames, (29, 72)), look)
    return _clip(figure, "idle", local, roots)


def talk_clip(figure, manner):
    """Idle with the forearms raised, hands that underline, and nods."""
    frames = int(IDLE_SECONDS * WALK_FRAMES_PER_SECOND) + 1
    local, roots = _standing(figure, frames, manner)
    skeleton = figure.skeleton
    for t, frame in zip(np.linspace(0.0, 2.0 * np.pi, frames), local):
        beat = np.sin(3 * t) + 0.5 * np.sin(5 * t + 1.0)
        raised = {"_R": 0.75 + 0.25 * np.sin(t), "_L": 0.55 - 0.35 * np.sin(t + 0.5)}
        for side, sign in (("_L", 1.0), ("_R", -1.0)):
            up = raised[side]
            _turn(skeleton, frame, "shoulder02" + side, "x", -12.0 * up - 2.0 * beat)
            _turn(skeleton, frame, "shoulder02" + side, "y", -sign * 6.0 * up)
            _turn(skeleton, frame, "lowerarm01" + side, "x", -48.0 * up - 7.0 * beat * up)
            _turn(skeleton, frame, "lowerarm01" + side, "z", -sign * 16.0 * up)
            _turn(skeleton, frame, "lowerarm02" + side, "y", sign * 18.0 * up)
            _turn(skeleton, frame, "wrist" + side, "x", -6.0 * np.sin(3 * t + 0.7) * up)
        nod = 3.5 * np.sin(3 * t + 0.4) + 1.5 * np.sin(5 * t)
        _turn(skeleton, frame, "head", "x", nod)
        _turn(skeleton, frame, "head", "z", 5.0 * np.sin(2 * t))
        _turn(skeleton, frame, "spine01", "z", 3.0 * np.sin(t))
    look = eyes.glances(frames, [[20, 5.0, 5.0], [34, 0.0, 0.0], [62, -6.0, 2.0], [70, 0.0, 0.0]])
    eyes.animate(skeleton, local, eyes.closing(frames, (18, 61)), look)
    return _clip(figure, "talk", local, roots)
