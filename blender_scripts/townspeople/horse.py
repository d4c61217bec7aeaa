"""A draught horse in its harness: joints, a skinned surface of tubes, and its clips. It faces -y; metres."""

import numpy as np

from townspeople import skeleton as sk
from townspeople.dog import Tubes, _between, make_clip

WALK_S, IDLE_S = 1.25, 8.0
SWING_DEG = 17.0
SIDES = 14  # of a tube

JOINTS = [
    ("root", "", (0.0, 0.05, 1.15)), ("hips", "root", (0.0, 0.45, 1.22)),
    ("chest", "root", (0.0, -0.30, 1.12)), ("neck", "chest", (0.0, -0.52, 1.25)),
    ("crest", "neck", (0.0, -0.80, 1.52)), ("head", "crest", (0.0, -1.00, 1.79)),
    ("ear_L", "head", (0.055, -0.99, 1.86)), ("ear_R", "head", (-0.055, -0.99, 1.86)),
    ("tail", "hips", (0.0, 0.84, 1.33)), ("tail_tip", "tail", (0.0, 0.93, 0.98)),
]
for _side, _x in (("_L", 1.0), ("_R", -1.0)):
    JOINTS += [
        ("fore_upper" + _side, "chest", (0.165 * _x, -0.46, 0.96)),
        ("fore_lower" + _side, "fore_upper" + _side, (0.165 * _x, -0.475, 0.53)),
        ("fore_foot" + _side, "fore_lower" + _side, (0.165 * _x, -0.468, 0.17)),
        ("hind_upper" + _side, "hips", (0.17 * _x, 0.54, 1.08)),
        ("hind_lower" + _side, "hind_upper" + _side, (0.185 * _x, 0.50, 0.86)),
        ("hind_hock" + _side, "hind_lower" + _side, (0.18 * _x, 0.69, 0.57)),
        ("hind_foot" + _side, "hind_hock" + _side, (0.18 * _x, 0.64, 0.17)),
    ]


def horse_skeleton():
    return sk.of_joints(JOINTS)


def horse_surface():
    t = Tubes([], [], [], [], SIDES)
    _trunk(t)
    _head(t)
    _hair(t)
    for side, x in (("_L", 1.0), ("_R", -1.0)):
        _legs(t, side, x)
    _harness(t)
    return t


def _trunk(t):
    hips, chest = {"hips": 1.0}, {"chest": 1.0}
    t.add([((0, 0.885, 1.17), 0.05, 0.06, hips), ((0, 0.85, 1.18), 0.17, 0.17, hips), ((0, 0.76, 1.19), 0.25, 0.26, hips),
           ((0, 0.62, 1.20), 0.285, 0.325, hips), ((0, 0.46, 1.19), 0.300, 0.345, hips),
           ((0, 0.28, 1.145), 0.305, 0.345, _between("hips", "root", 0.5)), ((0, 0.06, 1.10), 0.325, 0.355, {"root": 1.0}),
           ((0, -0.16, 1.10), 0.315, 0.375, _between("root", "chest", 0.5)), ((0, -0.34, 1.135), 0.275, 0.395, chest),
           ((0, -0.50, 1.14), 0.245, 0.365, chest), ((0, -0.63, 1.13), 0.205, 0.285, chest),
           ((0, -0.70, 1.12), 0.13, 0.18, chest), ((0, -0.73, 1.12), 0.04, 0.06, chest)], "coat")
    t.add([((0, -0.30, 1.14), 0.16, 0.33, chest), ((0, -0.44, 1.24), 0.165, 0.315, chest),
           ((0, -0.57, 1.36), 0.140, 0.270, _between("chest", "neck", 0.5)), ((0, -0.71, 1.49), 0.115, 0.225, {"neck": 1.0}),
           ((0, -0.83, 1.62), 0.096, 0.185, _between("neck", "crest", 0.5)),
           ((0, -0.92, 1.73), 0.084, 0.155, {"crest": 1.0}), ((0, -0.975, 1.80), 0.076, 0.125, _between("crest", "head", 0.5)),
           ((0, -1.01, 1.85), 0.055, 0.075, {"head": 1.0})], "coat")


def _head(t):
    head = {"head": 1.0}
    t.add([((0, -0.965, 1.865), 0.030, 0.035, head), ((0, -0.985, 1.835), 0.075, 0.085, head),
           ((0, -1.035, 1.765), 0.098, 0.128, head), ((0, -1.095, 1.690), 0.102, 0.142, head),
           ((0, -1.160, 1.605), 0.088, 0.122, head), ((0, -1.225, 1.525), 0.070, 0.096, head),
           ((0, -1.290, 1.445), 0.060, 0.080, head), ((0, -1.345, 1.375), 0.064, 0.080, head),
           ((0, -1.385, 1.325), 0.058, 0.068, head), ((0, -1.408, 1.298), 0.036, 0.042, head),
           ((0, -1.414, 1.290), 0.012, 0.015, head)], ["coat", 6, "muzzle"])
    t.add([((0, -1.128, 1.850), 0.006, 0.004, head), ((0, -1.202, 1.779), 0.026, 0.009, head), ((0, -1.254, 1.685), 0.020, 0.009, head),
           ((0, -1.299, 1.587), 0.016, 0.008, head), ((0, -1.345, 1.503), 0.005, 0.005, head)], "blaze")
    for side, x in (("_L", 1.0), ("_R", -1.0)):
        ear = {"ear" + side: 1.0}
        t.add([((0.050 * x, -0.985, 1.845), 0.020, 0.016, head), ((0.060 * x, -0.985, 1.895), 0.030, 0.017, ear),
               ((0.066 * x, -0.990, 1.945), 0.022, 0.012, ear), ((0.066 * x, -0.995, 1.995), 0.004, 0.004, ear)], "coat")
        t.add([((0.083 * x, -1.082, 1.752), 0.006, 0.006, head), ((0.0955 * x, -1.086, 1.752), 0.021, 0.019, head),
               ((0.103 * x, -1.088, 1.752), 0.008, 0.008, head)], "dark", (0.0, 1.0, 0.0))
        t.add([((0.046 * x, -1.378, 1.355), 0.010, 0.006, head), ((0.055 * x, -1.385, 1.355), 0.018, 0.011, head),
               ((0.060 * x, -1.388, 1.355), 0.006, 0.004, head)], "dark", (0.0, 0.6, -0.8))


def _hair(t):
    """Mane to the right, forelock, tail."""
    crest = [(-0.34, 1.53, 1.30, "chest"), (-0.46, 1.58, 1.28, "chest"), (-0.58, 1.645, 1.36, "neck"), (-0.70, 1.725, 1.44, "neck"),
             (-0.80, 1.805, 1.52, "crest"), (-0.89, 1.865, 1.60, "crest"), (-0.955, 1.895, 1.70, "head")]
    rows = []
    for y, top, foot, joint in crest:
        middle, half = 0.5 * (top + foot), 0.5 * (top - foot)
        rows.append(((-0.045 - 0.13 * half, y + 0.10 * half, middle), 0.035 + 0.05 * half, half, {joint: 1.0}))
    t.add(rows, "hair")
    head = {"head": 1.0}
    t.add([((0, -0.965, 1.895), 0.035, 0.020, head), ((0, -1.040, 1.895), 0.045, 0.026, head), ((0.01, -1.100, 1.835), 0.042, 0.022, head),
           ((0.015, -1.150, 1.770), 0.028, 0.016, head), ((0.018, -1.180, 1.720), 0.006, 0.004, head)], "hair")
    tail, tip = {"tail": 1.0}, {"tail_tip": 1.0}
    t.add([((0, 0.80, 1.375), 0.040, 0.040, {"hips": 1.0}), ((0, 0.875, 1.345), 0.055, 0.055, tail),
           ((0, 0.930, 1.23), 0.072, 0.070, tail), ((0, 0.950, 1.05), 0.088, 0.080, _between("tail", "tail_tip", 0.5)),
           ((0, 0.950, 0.82), 0.084, 0.076, tip), ((0, 0.935, 0.60), 0.056, 0.050, tip), ((0, 0.925, 0.46), 0.012, 0.012, tip)], "hair")


def _legs(t, side, x):
    upper, lower, foot = ("fore_" + part + side for part in ("upper", "lower", "foot"))
    t.add([((0.130 * x, -0.40, 1.22), 0.09, 0.16, {"chest": 1.0}), ((0.155 * x, -0.44, 1.05), 0.108, 0.165, _between("chest", upper, 0.4)),
           ((0.165 * x, -0.455, 0.90), 0.090, 0.128, {upper: 1.0}), ((0.166 * x, -0.460, 0.76), 0.071, 0.092, {upper: 1.0}),
           ((0.166 * x, -0.468, 0.62), 0.056, 0.066, {upper: 1.0}), ((0.166 * x, -0.476, 0.53), 0.058, 0.064, _between(upper, lower, 0.5)),
           ((0.166 * x, -0.470, 0.45), 0.046, 0.051, {lower: 1.0}), ((0.166 * x, -0.466, 0.32), 0.041, 0.046, {lower: 1.0}),
           ((0.166 * x, -0.458, 0.22), 0.053, 0.062, _between(lower, foot, 0.4)), ((0.166 * x, -0.470, 0.13), 0.066, 0.082, {foot: 1.0}),
           ((0.166 * x, -0.482, 0.075), 0.074, 0.092, {foot: 1.0})], ["coat", 7, "sock"])
    t.add([((0.166 * x, -0.485, 0.10), 0.058, 0.066, {foot: 1.0}), ((0.166 * x, -0.500, 0.055), 0.070, 0.080, {foot: 1.0}),
           ((0.166 * x, -0.510, 0.0), 0.080, 0.092, {foot: 1.0})], "hoof")
    upper, lower, hock, foot = ("hind_" + part + side for part in ("upper", "lower", "hock", "foot"))
    t.add([((0.130 * x, 0.56, 1.30), 0.11, 0.20, {"hips": 1.0}), ((0.155 * x, 0.56, 1.12), 0.145, 0.255, _between("hips", upper, 0.4)),
           ((0.178 * x, 0.54, 0.96), 0.130, 0.225, {upper: 1.0}), ((0.186 * x, 0.545, 0.84), 0.098, 0.165, _between(upper, lower, 0.6)),
           ((0.184 * x, 0.605, 0.71), 0.066, 0.108, {lower: 1.0}), ((0.181 * x, 0.665, 0.62), 0.053, 0.084, {lower: 1.0}),
           ((0.180 * x, 0.690, 0.55), 0.052, 0.074, _between(lower, hock, 0.5)), ((0.180 * x, 0.675, 0.46), 0.046, 0.060, {hock: 1.0}),
           ((0.180 * x, 0.655, 0.33), 0.043, 0.050, {hock: 1.0}), ((0.180 * x, 0.645, 0.22), 0.055, 0.064, _between(hock, foot, 0.4)),
           ((0.180 * x, 0.632, 0.13), 0.068, 0.084, {foot: 1.0}), ((0.180 * x, 0.620, 0.075), 0.075, 0.093, {foot: 1.0})], ["coat", 8, "sock"])
    t.add([((0.180 * x, 0.618, 0.10), 0.058, 0.066, {foot: 1.0}), ((0.180 * x, 0.602, 0.055), 0.070, 0.080, {foot: 1.0}),
           ((0.180 * x, 0.592, 0.0), 0.080, 0.090, {foot: 1.0})], "hoof")


def _harness(t):
    """Collar, girth with its saddle, bridle."""
    chest, head = {"chest": 1.0}, {"head": 1.0}
    up = np.array([0.0, 0.24, 0.62]) / np.hypot(0.24, 0.62)
    loop = np.linspace(0.0, 2.0 * np.pi, 17)
    t.add([(np.array([0.0, -0.555, 1.275]) + up * 0.345 * np.cos(a) + np.array([0.232 * np.sin(a), 0.0, 0.0]), 0.062, 0.040, chest)
           for a in loop], "leather", tuple(np.cross(up, [1.0, 0.0, 0.0])))
    t.add([((0, -0.115, 1.10), 0.26, 0.32, chest), ((0, -0.125, 1.10), 0.330, 0.392, _between("root", "chest", 0.5)),
           ((0, -0.215, 1.11), 0.322, 0.400, _between("root", "chest", 0.6)), ((0, -0.225, 1.11), 0.26, 0.32, chest)], "leather")
    for y, z, wide, high in ((-1.268, 1.472, 0.066, 0.088), (-1.062, 1.732, 0.104, 0.141)):
        way = np.array([0.0, -0.63, -0.777]) * 0.012
        t.add([((0, y, z), wide - 0.02, high - 0.02, head), ((0, y + way[1] * 0.2, z + way[2] * 0.2), wide + 0.006, high + 0.006, head),
               ((0, y + way[1], z + way[2]), wide + 0.005, high + 0.005, head),
               ((0, y + way[1] * 1.2, z + way[2] * 1.2), wide - 0.02, high - 0.02, head)], "leather")


# When in the cycle each leg is farthest ahead: left hind, left fore, right hind, right fore.
STEPS = (("hind", "_L", 0.0), ("fore", "_L", 0.25), ("hind", "_R", 0.5), ("fore", "_R", 0.75))


def walk_clip(skeleton):
    """Four beats; also the speed of the feet that stand, in m/s."""

    def pose_at(t, pose):
        pose.turn("hips", "y", 1.6 * np.sin(t))
        pose.turn("neck", "x", 3.0 * np.sin(2 * t + 0.6))
        pose.turn("tail", "y", 6.0 * np.sin(t))
        upright = 1.0
        for leg, side, ahead in STEPS:
            own = (t - 2.0 * np.pi * ahead) % (2.0 * np.pi)
            # Backward at one pace while it stands, forward while it is lifted.
            swing = 1.0 - 2.0 * own / np.pi if own < np.pi else np.cos(own)
            lift = max(0.0, -np.sin(own))
            pose.turn(leg + "_upper" + side, "x", -SWING_DEG * swing - (12.0 if leg == "fore" else 0.0) * lift)
            if leg == "fore":
                pose.turn("fore_lower" + side, "x", 55.0 * lift)
                pose.turn("fore_foot" + side, "x", 30.0 * lift)
            else:
                pose.turn("hind_lower" + side, "x", 26.0 * lift)
                pose.turn("hind_hock" + side, "x", -34.0 * lift)
                pose.turn("hind_foot" + side, "x", 40.0 * lift)
            if own < np.pi:  # the hoof lies flat
                pose.turn(leg + "_foot" + side, "x", SWING_DEG * swing)
                upright = min(upright, abs(swing))
        pose.root[2] -= leg_m * (1.0 - np.cos(np.radians(SWING_DEG * upright)))  # who stands most upright carries

    leg_m = 0.96
    stride_m = 2.0 * leg_m * np.sin(np.radians(SWING_DEG))
    return make_clip(skeleton, "walk", WALK_S, pose_at), float(stride_m / (0.5 * WALK_S))


def idle_clip(skeleton):
    """It rests a hind leg, looks about, flicks its ears, switches its tail."""

    def pose_at(t, pose):
        breath, nod = np.sin(4 * t), np.exp(-((t - 3.6) / 0.5) ** 2)
        pose.turn("chest", "x", 0.25 * breath)
        pose.turn("neck", "x", 10.0 + 2.0 * np.sin(t) + 6.0 * nod)
        pose.turn("crest", "x", 5.0 + 3.0 * nod)
        pose.turn("neck", "z", 7.0 * np.sin(t + 0.5))
        pose.turn("head", "z", 6.0 * np.sin(t + 0.2))
        pose.turn("head", "x", -4.0)
        for side, at in (("_L", 1.5), ("_R", 4.4)):
            pose.turn("ear" + side, "z", 30.0 * np.exp(-((t - at) / 0.12) ** 2) * (1.0 if side == "_L" else -1.0))
        switch = sum(np.exp(-((t - at) / 0.35) ** 2) for at in (1.2, 2.0, 5.0))
        pose.turn("tail", "y", 3.0 * np.sin(t) + 20.0 * switch * np.sin(8 * t))
        pose.turn("tail_tip", "y", 16.0 * switch * np.sin(8 * t - 0.9))
        pose.turn("hips", "y", -1.5)
        pose.turn("hind_upper_R", "x", -9.0)
        pose.turn("hind_lower_R", "x", 20.0)
        pose.turn("hind_hock_R", "x", -22.0)
        pose.turn("hind_foot_R", "x", 36.0)

    return make_clip(skeleton, "idle", IDLE_S, pose_at)
