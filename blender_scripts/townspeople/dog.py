"""A dog on four legs: joints, a skinned surface of tubes, and its clips. It faces -y; metres.

Poses are global rotations of the joints, as in skeleton.py.
"""

from dataclasses import dataclass

import numpy as np

from townspeople import skeleton as sk
from townspeople.clips import Clip

FRAMES_PER_SECOND = 24.0
WALK_S, IDLE_S, LIE_S = 0.625, 4.0, 4.0
SWING_DEG = 21.0
SIDES = 10  # of a tube

# Name, parent, head.
JOINTS = [
    ("root", "", (0.0, 0.02, 0.41)), ("hips", "root", (0.0, 0.16, 0.42)),
    ("chest", "root", (0.0, -0.12, 0.40)), ("neck", "chest", (0.0, -0.25, 0.44)),
    ("head", "neck", (0.0, -0.35, 0.53)), ("tail", "hips", (0.0, 0.27, 0.45)),
    ("tail_tip", "tail", (0.0, 0.36, 0.50)),
]
for _side, _x in (("_L", 1.0), ("_R", -1.0)):
    JOINTS += [
        ("fore_upper" + _side, "chest", (0.072 * _x, -0.20, 0.36)),
        ("fore_lower" + _side, "fore_upper" + _side, (0.072 * _x, -0.185, 0.21)),
        ("fore_foot" + _side, "fore_lower" + _side, (0.072 * _x, -0.19, 0.05)),
        ("hind_upper" + _side, "hips", (0.075 * _x, 0.20, 0.38)),
        ("hind_lower" + _side, "hind_upper" + _side, (0.075 * _x, 0.15, 0.24)),
        ("hind_hock" + _side, "hind_lower" + _side, (0.075 * _x, 0.245, 0.145)),
        ("hind_foot" + _side, "hind_hock" + _side, (0.075 * _x, 0.23, 0.04)),
    ]


@dataclass
class Tubes:
    """A growing skinned surface: corners, polygons, one colour a polygon, weights."""

    points: list
    faces: list
    colors: list
    weights: list  # {joint: share} a point
    sides: int = SIDES

    def add(self, rings, color, turn=(1.0, 0.0, 0.0)):
        """A closed tube of (centre, half width, half height, {joint: share}), its rings across
        the way from ring to ring. color: one, or [from the top, so many segments, below].
        """
        first, count = len(self.points), len(rings)
        top, segments, below = (color, count, color) if isinstance(color, str) else color
        centres = np.array([ring[0] for ring in rings], float)
        for k, (centre, wide, high, weights) in enumerate(rings):
            way = centres[min(k + 1, count - 1)] - centres[max(k - 1, 0)]
            way = way / np.linalg.norm(way)
            side = np.array(turn) - way * (way @ np.array(turn))
            side = side / np.linalg.norm(side)
            up = np.cross(way, side)
            for s in range(self.sides):
                a = 2.0 * np.pi * s / self.sides
                point = centres[k] + side * wide * np.cos(a) + up * high * np.sin(a)
                self.points.append(tuple(point))
                self.weights.append(weights)
        for k in range(count - 1):
            for s in range(self.sides):
                a, b = first + k * self.sides + s, first + k * self.sides + (s + 1) % self.sides
                self._face((a, b, b + self.sides, a + self.sides), top if k < segments else below)
        self._face(tuple(range(first + self.sides - 1, first - 1, -1)), top)
        last = first + (count - 1) * self.sides
        self._face(tuple(range(last, last + self.sides)), below)

    def _face(self, corners, color):
        self.faces.append(corners)
        self.colors.append(color)


def dog_skeleton():
    return sk.of_joints(JOINTS)


def _between(a, b, share):
    return {a: 1.0 - share, b: share}


def dog_surface(coat, belly, dark):
    """Body, neck, head with muzzle, ears and eyes, tail, four legs."""
    t = Tubes([], [], [], [])
    t.add([((0, 0.285, 0.42), 0.02, 0.03, {"hips": 1.0}), ((0, 0.25, 0.425), 0.075, 0.085, {"hips": 1.0}),
           ((0, 0.16, 0.42), 0.088, 0.095, {"hips": 1.0}),
           ((0, 0.04, 0.415), 0.082, 0.088, _between("hips", "root", 0.7)),
           ((0, -0.08, 0.40), 0.095, 0.112, _between("root", "chest", 0.6)),
           ((0, -0.17, 0.395), 0.102, 0.125, {"chest": 1.0}),
           ((0, -0.25, 0.41), 0.085, 0.105, {"chest": 1.0}),
           ((0, -0.295, 0.425), 0.045, 0.06, {"chest": 1.0})], coat)
    t.add([((0, -0.20, 0.43), 0.075, 0.085, {"chest": 1.0}),
           ((0, -0.27, 0.48), 0.062, 0.072, _between("chest", "neck", 0.6)),
           ((0, -0.33, 0.53), 0.056, 0.062, {"neck": 1.0}),
           ((0, -0.37, 0.56), 0.050, 0.05, _between("neck", "head", 0.6))], coat)
    head = {"head": 1.0}
    t.add([((0, -0.32, 0.56), 0.035, 0.035, head), ((0, -0.345, 0.563), 0.060, 0.056, head),
           ((0, -0.40, 0.56), 0.062, 0.056, head), ((0, -0.435, 0.548), 0.046, 0.042, head),
           ((0, -0.455, 0.538), 0.032, 0.032, head), ((0, -0.515, 0.528), 0.027, 0.026, head),
           ((0, -0.53, 0.527), 0.016, 0.016, head)], [coat, 4, belly])
    t.add([((0, -0.522, 0.540), 0.008, 0.006, head), ((0, -0.534, 0.538), 0.014, 0.011, head),
           ((0, -0.542, 0.535), 0.007, 0.006, head)], dark)
    for x in (1.0, -1.0):
        t.add([((0.034 * x, -0.372, 0.600), 0.024, 0.012, head), ((0.056 * x, -0.366, 0.605), 0.026, 0.012, head),
               ((0.074 * x, -0.372, 0.570), 0.024, 0.008, head), ((0.078 * x, -0.380, 0.530), 0.008, 0.004, head)],
              dark, (0.0, 1.0, 0.0))
        t.add([((0.030 * x, -0.441, 0.574), 0.004, 0.004, head), ((0.036 * x, -0.448, 0.575), 0.009, 0.009, head),
               ((0.039 * x, -0.452, 0.576), 0.003, 0.003, head)], dark)
    t.add([((0, 0.26, 0.455), 0.028, 0.028, {"hips": 1.0}), ((0, 0.31, 0.47), 0.024, 0.024, {"tail": 1.0}),
           ((0, 0.36, 0.50), 0.022, 0.022, _between("tail", "tail_tip", 0.5)),
           ((0, 0.40, 0.55), 0.018, 0.018, {"tail_tip": 1.0}), ((0, 0.41, 0.60), 0.006, 0.006, {"tail_tip": 1.0})], coat)
    for side, x in (("_L", 1.0), ("_R", -1.0)):
        upper, lower, foot = ("fore_" + part + side for part in ("upper", "lower", "foot"))
        t.add([((0.058 * x, -0.195, 0.42), 0.035, 0.055, _between("chest", upper, 0.5)),
               ((0.070 * x, -0.20, 0.34), 0.040, 0.055, {upper: 1.0}),
               ((0.072 * x, -0.185, 0.23), 0.029, 0.036, _between(upper, lower, 0.5)),
               ((0.072 * x, -0.188, 0.13), 0.022, 0.024, {lower: 1.0}),
               ((0.072 * x, -0.190, 0.055), 0.021, 0.023, _between(lower, foot, 0.6)),
               ((0.072 * x, -0.205, 0.03), 0.027, 0.034, {foot: 1.0}),
               ((0.072 * x, -0.212, 0.002), 0.027, 0.036, {foot: 1.0})], [coat, 3, belly])
        upper, lower, hock, foot = ("hind_" + part + side for part in ("upper", "lower", "hock", "foot"))
        t.add([((0.055 * x, 0.20, 0.45), 0.035, 0.06, _between("hips", upper, 0.4)),
               ((0.072 * x, 0.20, 0.37), 0.046, 0.082, {upper: 1.0}),
               ((0.076 * x, 0.17, 0.28), 0.038, 0.060, {upper: 1.0}),
               ((0.075 * x, 0.175, 0.22), 0.029, 0.040, _between(upper, lower, 0.7)),
               ((0.075 * x, 0.225, 0.165), 0.021, 0.026, _between(lower, hock, 0.4)),
               ((0.075 * x, 0.242, 0.12), 0.018, 0.022, {hock: 1.0}),
               ((0.075 * x, 0.232, 0.055), 0.020, 0.023, _between(hock, foot, 0.6)),
               ((0.075 * x, 0.217, 0.03), 0.026, 0.034, {foot: 1.0}),
               ((0.075 * x, 0.210, 0.002), 0.026, 0.036, {foot: 1.0})], [coat, 5, belly])
    return t


class Pose:
    """Local turns about the world's axes, and where the root is."""

    def __init__(self, skeleton):
        self.skeleton = skeleton
        self.local = {}
        self.root = skeleton.heads[0].copy()

    def turn(self, joint, axis, degrees):
        self.local[joint] = sk.rotation(axis, degrees) @ self.local.get(joint, np.eye(3))

    def rotations(self):
        return sk.global_from_local(self.skeleton, self.local)


def make_clip(skeleton, name, seconds, pose_at):
    frames = int(round(seconds * FRAMES_PER_SECOND)) + 1
    poses = []
    for phase in np.linspace(0.0, 2.0 * np.pi, frames):
        pose = Pose(skeleton)
        pose_at(phase, pose)
        poses.append(pose)
    rotations = np.array([pose.rotations() for pose in poses])
    roots = np.array([pose.root for pose in poses])
    rotations[-1], roots[-1] = rotations[0], roots[0]
    return Clip(name, rotations, roots)


# When in the cycle each leg is farthest ahead: left hind, left fore, right hind, right fore.
STEPS = (("hind", "_L", 0.0), ("fore", "_L", 0.25), ("hind", "_R", 0.5), ("fore", "_R", 0.75))


def walk_clip(skeleton):
    """Four beats; also the speed of the feet that stand, in m/s."""

    def pose_at(t, pose):
        pose.root[2] += 0.007 * np.sin(2 * t)
        pose.turn("hips", "y", 2.0 * np.sin(t))
        pose.turn("chest", "y", -2.0 * np.sin(t))
        pose.turn("neck", "x", 3.0 * np.sin(2 * t + 0.6))
        pose.turn("tail", "y", 9.0 * np.sin(t))
        for leg, side, ahead in STEPS:
            own = (t - 2.0 * np.pi * ahead) % (2.0 * np.pi)
            # Backward at one pace while it stands, forward while it is lifted.
            swing = 1.0 - 2.0 * own / np.pi if own < np.pi else np.cos(own)
            lift = max(0.0, -np.sin(own))
            pose.turn(leg + "_upper" + side, "x", -SWING_DEG * swing)
            if leg == "fore":
                pose.turn("fore_lower" + side, "x", 48.0 * lift)
                pose.turn("fore_foot" + side, "x", 25.0 * lift + 0.5 * SWING_DEG * swing)
            else:
                pose.turn("hind_lower" + side, "x", 34.0 * lift)
                pose.turn("hind_hock" + side, "x", -38.0 * lift)
                pose.turn("hind_foot" + side, "x", 0.8 * SWING_DEG * swing)

    leg_m = 0.36
    stride_m = 2.0 * leg_m * np.sin(np.radians(SWING_DEG))
    return make_clip(skeleton, "walk", WALK_S, pose_at), float(stride_m / (0.5 * WALK_S))


def _wag(t, pose, wide):
    pose.turn("tail", "z", wide * np.sin(6 * t))
    pose.turn("tail_tip", "z", 0.6 * wide * np.sin(6 * t - 0.8))


def idle_clip(skeleton):
    def pose_at(t, pose):
        pose.turn("chest", "x", 0.8 * np.sin(3 * t))
        pose.turn("neck", "z", 16.0 * np.sin(t))
        pose.turn("head", "z", 12.0 * np.sin(t + 0.4))
        pose.turn("head", "x", 5.0 * np.sin(2 * t))
        _wag(t, pose, 16.0)

    return make_clip(skeleton, "idle", IDLE_S, pose_at)


def lie_clip(skeleton):
    """On the ground, forelegs ahead, head up."""

    def pose_at(t, pose):
        pose.root[2] -= 0.27
        pose.turn("neck", "x", -6.0 + 2.0 * np.sin(t))
        pose.turn("neck", "z", 20.0 * np.sin(t))
        pose.turn("head", "z", 10.0 * np.sin(t + 0.5))
        pose.turn("chest", "x", 1.0 * np.sin(3 * t))
        pose.turn("tail", "x", -32.0)
        _wag(t, pose, 9.0)
        for side, sign in (("_L", 1.0), ("_R", -1.0)):
            pose.turn("fore_upper" + side, "x", 55.0)
            pose.turn("fore_lower" + side, "x", -143.0)
            pose.turn("fore_foot" + side, "x", 88.0)
            pose.turn("hind_upper" + side, "y", sign * 14.0)
            pose.turn("hind_upper" + side, "x", -74.0)
            pose.turn("hind_lower" + side, "x", 109.0)
            pose.turn("hind_hock" + side, "x", -121.0)
            pose.turn("hind_foot" + side, "x", 86.0)

    return make_clip(skeleton, "lie", LIE_S, pose_at)
