"""Walks of several ages and tempers, walking with a load, and a run."""

from dataclasses import dataclass, field, replace

import numpy as np

from townspeople import clips, gait, work_clips
from townspeople.body import WALK_FRAMES_PER_SECOND

# Foot pitch of a run over the cycle of one foot from the strike, as gait.PITCH: it lands nearly flat and swings high.
RUN_PITCH = [
    [0.0, -8.0], [0.06, 0.0], [0.20, 2.0], [0.30, 28.0], [0.38, 50.0], [0.52, 66.0], [0.74, 26.0], [0.92, -9.0], [1.0, -8.0],
]
STRAIGHTER_DEG = 8.0  # than the rest pose's elbows are, in arms that hang
RUN = gait.Step(stance=0.36, pitch=RUN_PITCH, lift=0.16, flight=0.030)


@dataclass
class Gait:
    """A walk or a run, on an adult's legs."""

    name: str
    cycle_s: float  # of two steps
    stride: float  # double step, in leg lengths
    arm_deg: float  # half the upper arms' swing
    trunk: float = 1.0  # how much hips and chest turn
    bent_deg: float = 0.0  # of the elbows at least
    elbow_deg: float = 16.0  # that they bend more as the arm comes forward
    lean_deg: float = 2.0
    stoop_deg: float = 0.0
    spread_deg: float = 9.0  # of the arms, inwards from the rest pose
    bearing: bool = False  # both arms hold something before the body
    feet: gait.Step = field(default_factory=gait.Step)


GAITS = [
    Gait("walk", 1.04, 1.38, 20.0),
    Gait("walk_stroll", 1.25, 1.16, 13.0, trunk=0.8),
    Gait("walk_brisk", 0.92, 1.52, 27.0, trunk=1.2, bent_deg=4.0, elbow_deg=22.0, lean_deg=4.0),
    Gait("walk_old", 1.20, 0.86, 8.0, trunk=0.6, bent_deg=10.0, elbow_deg=8.0, lean_deg=3.0, stoop_deg=14.0),
    Gait("walk_child", 0.90, 1.34, 28.0, trunk=1.6, spread_deg=6.0),
    Gait("carry", 1.10, 1.14, 0.0, trunk=0.5, lean_deg=-2.0, bearing=True),
    Gait("run", 0.70, 2.10, 38.0, trunk=1.7, bent_deg=62.0, elbow_deg=26.0, lean_deg=9.0, feet=RUN),
]


def renamed(clip, name):
    return replace(clip, name=name)


def walk(figure, gait_of):
    """The clip, walking on the spot."""
    skeleton = figure.skeleton
    frames = int(round(gait_of.cycle_s * WALK_FRAMES_PER_SECOND))
    phases = np.linspace(0.0, 2.0 * np.pi, frames + 1) - gait.STRIKE_FRAME / 24.0 * 2.0 * np.pi
    manner = clips.Manner(stoop_deg=gait_of.stoop_deg)
    poses = []
    for phase in phases:
        frame = np.tile(np.eye(3), (len(skeleton.names), 1, 1))
        _sway(skeleton, frame, np.cos(phase) * gait_of.trunk, np.sin(phase) * gait_of.trunk)
        for side, sign in (("_L", 1.0), ("_R", -1.0)):
            _swing_arm(skeleton, frame, side, sign, sign * np.cos(phase), gait_of)
        clips._hold(skeleton, frame, manner, gait_of.lean_deg)
        poses.append(frame)
    rotations = clips._globals(skeleton, np.array(poses))
    leg = skeleton.head("upperleg02_L")[2]
    half_width = 0.72 * skeleton.head("upperleg02_L")[0]
    roots = gait.step_legs(figure, rotations, gait_of.stride * leg, half_width, how=gait_of.feet)
    if gait_of.bearing:
        _bear(figure, rotations, roots)
    rotations[-1], roots[-1] = rotations[0], roots[0]
    return clips.Clip(gait_of.name, rotations, roots)


def _sway(skeleton, frame, ahead, over):
    """Hips go with the leg ahead and drop towards the one in the air; chest and head turn against them."""
    for name, axis, degrees in (
        ("root", "z", -5.0 * ahead), ("root", "y", 2.5 * over),
        ("spine05", "z", 4.0 * ahead), ("spine05", "y", -3.0 * over),
        ("spine03", "z", 2.5 * ahead), ("spine01", "z", 4.0 * ahead), ("neck01", "z", -5.0 * ahead),
    ):
        clips._turn(skeleton, frame, name, axis, degrees)


def _swing_arm(skeleton, frame, side, sign, swing, gait_of):
    """swing: 1 where the arm is farthest back; the elbow bends as it comes forward."""
    clips._turn(skeleton, frame, "shoulder02" + side, "y", sign * gait_of.spread_deg)
    clips._turn(skeleton, frame, "shoulder02" + side, "x", gait_of.arm_deg * swing)
    bend = gait_of.bent_deg + gait_of.elbow_deg * (0.5 - 0.5 * swing)
    clips._turn(skeleton, frame, "lowerarm01" + side, "x", STRAIGHTER_DEG - bend)


def _bear(figure, rotations, roots):
    """Both hands under a load at the belly."""
    size = figure.landmarks["crown"][2] / 1.7
    for pose, root in zip(rotations, roots):
        lift = root[2] - figure.skeleton.heads[0][2]
        for side, sign in work_clips.SIDES:
            hand = np.array([sign * 0.17, -0.34, 1.02]) * size + np.array([0.0, 0.0, lift])
            work_clips._reach(figure.skeleton, pose, root, side, hand, (sign * 0.8, 0.5, -0.4))
