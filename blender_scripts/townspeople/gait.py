"""Legs of the walk: feet that roll over the ground without sliding, solved back to hips and knees.

The source's walk drags its feet (the swinging foot stays as low as the standing one). So the
trunk, the arms, the timing and the pelvis come from there, and the legs are stepped anew: while a
foot stands, its lowest sole point moves backwards evenly; the rest of the leg follows by two-bone
inverse kinematics.
"""

from dataclasses import dataclass, field

import numpy as np

from townspeople import skeleton as sk

STANCE = 0.62  # share of the cycle that a foot is on the ground
SUBSTEPS = 240  # a cycle, for the rolling
STRIKE_FRAME = 4.0  # of 24: where the source's left foot is farthest forward
# Foot pitch, degrees (toe up is negative), over the cycle of one foot from heel strike.
PITCH = [
    [0.0, -19.0],
    [0.10, -1.0],
    [0.16, 0.0],
    [0.36, 0.0],
    [0.48, 11.0],
    [0.62, 36.0],
    [0.71, 42.0],
    [0.84, 4.0],
    [0.93, -16.0],
    [1.0, -19.0],
]
SWING_LIFT = 0.055  # of the leg's length
MAX_BOB = 0.030  # half the pelvis' rise and fall at most, of the leg's length
BEHIND = 0.035  # so far the steps' middle lies behind the hips, of the leg's length
STRAIGHTEST = 0.997  # a leg never stretches beyond this share of its length


@dataclass
class Step:
    """How the feet go; a walk unless said otherwise."""

    stance: float = STANCE
    pitch: list = field(default_factory=lambda: PITCH)
    lift: float = SWING_LIFT
    flight: float = 0.0  # of a run: half the pelvis' rise and fall, of the leg's length; 0: as the legs let it


@dataclass
class FootTrack:
    """One foot's cycle, sampled at SUBSTEPS + 1 phases from heel strike; y is forward-negative."""

    y: np.ndarray
    z: np.ndarray
    pitch_deg: np.ndarray


def _smooth_pitch(pitch):
    phases = np.linspace(0.0, 1.0, SUBSTEPS + 1)
    values = np.interp(phases, [p[0] for p in pitch], [p[1] for p in pitch])
    kernel = np.hanning(17) / np.hanning(17).sum()
    return np.convolve(np.concatenate([values[-9:-1], values, values[1:9]]), kernel, "valid")


def sole_points(figure, side):
    """The shoe's lower vertices, from the ankle, at rest."""
    shoes, column = figure.parts["shoes"], figure.skeleton.index("foot" + side)
    own = shoes.weights[:, column] > 0.5
    points = shoes.vertices[own]
    return points[points[:, 2] < shoes.vertices[:, 2].min() + 0.03] - figure.skeleton.head(
        "foot" + side
    )


def foot_track(figure, stride_m, how=Step()):
    """Rolls a foot through its stance and swings it forward again; both feet step alike."""
    sole = sole_points(figure, "_L")
    leg = figure.skeleton.head("upperleg02_L")[2]
    pitch = _smooth_pitch(how.pitch)
    turned = np.array([sole @ sk.rotation("x", degrees).T for degrees in pitch])
    low = turned[:, :, 2].argmin(axis=1)
    lift_off = int(round(how.stance * SUBSTEPS))
    y, z = np.zeros(SUBSTEPS + 1), -turned[:, :, 2].min(axis=1)
    step = stride_m / SUBSTEPS
    for i in range(lift_off):
        y[i + 1] = y[i] + step - (turned[i + 1, low[i], 1] - turned[i, low[i], 1])
    s = np.linspace(0.0, 1.0, SUBSTEPS + 1 - lift_off)
    span = len(s) - 1
    y[lift_off:] = _hermite(
        s, y[lift_off], y[0], (y[lift_off] - y[lift_off - 1]) * span, (y[1] - y[0]) * span
    )
    lift = how.lift * leg * np.sin(np.pi * s**0.8) ** 2
    z[lift_off:] = z[lift_off:] + lift
    return FootTrack(y, z, pitch)


def _hermite(s, start, end, start_slope, end_slope):
    return (
        (2 * s**3 - 3 * s**2 + 1) * start
        + (s**3 - 2 * s**2 + s) * start_slope
        + (-2 * s**3 + 3 * s**2) * end
        + (s**3 - s**2) * end_slope
    )


def _frame_of(way, side):
    """Columns: the limb's direction and two normals; `side` is roughly the person's left."""
    way = way / np.linalg.norm(way)
    left = side - way * (side @ way)
    left = left / np.linalg.norm(left)
    return np.stack([way, left, sk.cross(way, left)], axis=1)


def _leg_rotations(skeleton, side, hip, ankle, left):
    """Global rotations of thigh and shin that put the ankle in its place, knee forward."""
    rest = [skeleton.head(name + side) for name in ("upperleg02", "lowerleg01", "foot")]
    thigh, shin = np.linalg.norm(rest[1] - rest[0]), np.linalg.norm(rest[2] - rest[1])
    line = ankle - hip
    distance = min(np.linalg.norm(line), STRAIGHTEST * (thigh + shin))
    line = line / np.linalg.norm(line)
    forward = sk.cross(line, left)
    forward = forward / np.linalg.norm(forward)
    if forward[1] > 0:
        forward = -forward
    along = (thigh**2 - shin**2 + distance**2) / (2 * distance)
    knee = hip + line * along + forward * np.sqrt(max(thigh**2 - along**2, 0.0))
    turns = []
    for (a, b), (p, q) in (((rest[0], rest[1]), (hip, knee)), ((rest[1], rest[2]), (knee, ankle))):
        turns.append(_frame_of(q - p, left) @ _frame_of(b - a, np.array([1.0, 0.0, 0.0])).T)
    return turns


def _pelvis_height(limit, cycles, max_bob_m):
    """The highest even rise and fall, twice a cycle, that stays below what the legs can reach."""
    best = None
    for bob in np.linspace(0.3, 1.0, 8) * max_bob_m:
        for phase in np.linspace(0.0, 0.5, 25, endpoint=False):
            wave = bob * np.cos(4.0 * np.pi * (cycles - phase))
            middle = (limit - wave).min()
            if best is None or middle > best[0]:
                best = (middle, middle + wave)
    return best[1]


def _flying_height(limit, cycles, how, leg_m):
    """Lowest while a foot stands, highest while none does."""
    wave = how.flight * leg_m * np.cos(4.0 * np.pi * (cycles - 0.5 * how.stance + 0.25))
    return (limit - wave).min() + wave


def step_legs(figure, rotations, stride_m, half_width_m, toe_out_deg=5.0, how=Step()):
    """Replaces the legs in global rotations (frames, joints, 3, 3); returns the root positions."""
    skeleton = figure.skeleton
    track = foot_track(figure, stride_m, how)
    frames = len(rotations) - 1
    root = skeleton.heads[0]
    leg = sum(
        np.linalg.norm(skeleton.head(b) - skeleton.head(a))
        for a, b in (("upperleg02_L", "lowerleg01_L"), ("lowerleg01_L", "foot_L"))
    )
    centre = 0.5 * (track.y[0] + track.y[int(how.stance * SUBSTEPS)]) - BEHIND * leg
    hip_y = skeleton.head("upperleg02_L")[1] - root[1]
    cycles = (np.arange(frames + 1) / frames * 24.0 - STRIKE_FRAME) / 24.0
    ankles, pitches, hips, limits = {}, {}, {}, []
    for side, sign, shift in (("_L", 1.0, 0.0), ("_R", -1.0, 0.5)):
        at = np.mod(cycles + shift, 1.0) * SUBSTEPS
        samples = np.arange(SUBSTEPS + 1)
        y = np.interp(at, samples, track.y) - centre + root[1] + hip_y
        ankles[side] = np.stack(
            [np.full(frames + 1, sign * half_width_m), y, np.interp(at, samples, track.z)], axis=1
        )
        pitches[side] = np.interp(at, samples, track.pitch_deg)
        hips[side] = np.array(
            [turn[0] @ (skeleton.head("upperleg02" + side) - root) for turn in rotations]
        )
        flat = ankles[side][:, :2] - hips[side][:, :2] - root[:2]
        reach = np.sqrt(np.maximum((STRAIGHTEST * leg) ** 2 - (flat**2).sum(axis=1), 0.0))
        limits.append(ankles[side][:, 2] + reach - hips[side][:, 2])
    limit = np.min(limits, axis=0)
    height = _flying_height(limit, cycles, how, leg) if how.flight > 0 else _pelvis_height(limit, cycles, MAX_BOB * leg)
    roots = np.stack([np.zeros(frames + 1), np.full(frames + 1, root[1]), height], axis=1)
    for f in range(frames + 1):
        left = rotations[f, 0] @ np.array([1.0, 0.0, 0.0])
        for side, sign in (("_L", 1.0), ("_R", -1.0)):
            turns = _leg_rotations(skeleton, side, hips[side][f] + roots[f], ankles[side][f], left)
            for name, turn in zip(("upperleg02", "lowerleg01"), turns):
                rotations[f, skeleton.index(name + side)] = turn
            foot = sk.rotation("z", sign * toe_out_deg) @ sk.rotation("x", pitches[side][f])
            rotations[f, skeleton.index("foot" + side)] = foot
    return roots
