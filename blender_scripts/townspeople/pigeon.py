"""A pigeon: joints, a skinned surface, and its clips walk, idle (it pecks) and fly. It faces -y; metres.

At rest its wings are spread, as it flies; on the ground they lie folded along its flanks.
"""

import numpy as np

from townspeople import skeleton as sk
from townspeople.dog import Pose, Tubes, _between, make_clip

WALK_S, IDLE_S, FLY_S = 0.5, 5.0, 0.25
STEP_DEG = 26.0

JOINTS = [
    ("root", "", (0.0, 0.0, 0.125)), ("chest", "root", (0.0, -0.04, 0.135)),
    ("neck", "chest", (0.0, -0.085, 0.165)), ("head", "neck", (0.0, -0.105, 0.215)),
    ("tail", "root", (0.0, 0.10, 0.125)),
]
for _side, _x in (("_L", 1.0), ("_R", -1.0)):
    JOINTS += [
        ("wing" + _side, "chest", (0.054 * _x, -0.055, 0.138)),
        ("hand" + _side, "wing" + _side, (0.150 * _x, -0.055, 0.142)),
        ("leg" + _side, "root", (0.026 * _x, 0.005, 0.090)),
        ("shank" + _side, "leg" + _side, (0.026 * _x, 0.008, 0.060)),
        ("foot" + _side, "shank" + _side, (0.026 * _x, 0.005, 0.016)),
    ]


def pigeon_skeleton():
    return sk.of_joints(JOINTS)


def _wing(t, x, inner, outer):
    """A blade of two faces from the shoulder to the tip, bent at the wrist."""
    # Along the span: front edge, back edge, height, weights.
    cuts = [
        (0.036, -0.066, 0.030, 0.136, _between("chest", inner, 0.5)),
        (0.085, -0.076, 0.036, 0.144, {inner: 1.0}),
        (0.145, -0.080, 0.036, 0.147, _between(inner, outer, 0.5)),
        (0.205, -0.072, 0.030, 0.144, {outer: 1.0}),
        (0.265, -0.056, 0.014, 0.140, {outer: 1.0}),
        (0.318, -0.030, -0.014, 0.137, {outer: 1.0}),
    ]
    thick = 0.006
    for low in (False, True):
        first = len(t.points)
        for span, front, back, height, weights in cuts:
            for part, arch in ((0.0, 0.0), (0.4, 0.008), (0.75, 0.004), (1.0, 0.0)):
                y = front + (back - front) * part
                z = height + arch - (thick if low else 0.0) * np.sin(np.pi * min(1.0, part + 0.15))
                t.points.append((span * x, y, z))
                t.weights.append(weights)
        for k in range(len(cuts) - 1):
            for p in range(3):
                a = first + 4 * k + p
                face = (a, a + 1, a + 5, a + 4)
                # The upper side looks up on either wing.
                if (x > 0) != low:
                    face = face[::-1]
                t.faces.append(face[::-1])
                dark = k >= 4 or (k == 3 and p == 2)
                t.colors.append("dark" if dark and not low else "bar" if p == 2 or (k == 3 and p == 1) else "wing")


def pigeon_surface():
    """Body, neck, head, beak, eyes, tail, wings, legs."""
    t = Tubes([], [], [], [], 8)
    root, chest, neck, head = {"root": 1.0}, {"chest": 1.0}, {"neck": 1.0}, {"head": 1.0}
    t.add([((0, 0.125, 0.128), 0.012, 0.010, root), ((0, 0.085, 0.124), 0.036, 0.030, root),
           ((0, 0.03, 0.122), 0.054, 0.048, root), ((0, -0.03, 0.128), 0.060, 0.056, _between("root", "chest", 0.6)),
           ((0, -0.075, 0.142), 0.052, 0.052, chest), ((0, -0.105, 0.160), 0.034, 0.036, _between("chest", "neck", 0.4)),
           ((0, -0.118, 0.172), 0.012, 0.014, _between("chest", "neck", 0.5))], "coat")
    t.add([((0, -0.070, 0.150), 0.040, 0.040, chest), ((0, -0.090, 0.180), 0.033, 0.034, _between("chest", "neck", 0.6)),
           ((0, -0.102, 0.205), 0.025, 0.026, neck), ((0, -0.110, 0.226), 0.023, 0.024, _between("neck", "head", 0.6)),
           ((0, -0.118, 0.240), 0.020, 0.020, head), ((0, -0.124, 0.250), 0.008, 0.008, head)], "neck")
    t.add([((0, -0.088, 0.236), 0.010, 0.010, head), ((0, -0.100, 0.238), 0.021, 0.020, head),
           ((0, -0.120, 0.239), 0.022, 0.021, head), ((0, -0.137, 0.235), 0.014, 0.013, head),
           ((0, -0.143, 0.233), 0.007, 0.007, head)], "neck")
    t.add([((0, -0.138, 0.235), 0.006, 0.006, head), ((0, -0.152, 0.231), 0.005, 0.004, head),
           ((0, -0.163, 0.226), 0.001, 0.001, head)], "beak")
    tail = {"tail": 1.0}
    t.add([((0, 0.075, 0.127), 0.030, 0.012, root), ((0, 0.12, 0.125), 0.036, 0.008, tail),
           ((0, 0.17, 0.122), 0.044, 0.006, tail)], "coat")
    t.add([((0, 0.168, 0.122), 0.044, 0.006, tail), ((0, 0.198, 0.120), 0.048, 0.004, tail)], "dark")
    for side, x in (("_L", 1.0), ("_R", -1.0)):
        t.add([((0.018 * x, -0.122, 0.243), 0.002, 0.002, head), ((0.0215 * x, -0.124, 0.243), 0.0045, 0.0045, head),
               ((0.0235 * x, -0.124, 0.243), 0.001, 0.001, head)], "eye", (0.0, 1.0, 0.0))
        _wing(t, x, "wing" + side, "hand" + side)
        leg, shank, foot = {"leg" + side: 1.0}, {"shank" + side: 1.0}, {"foot" + side: 1.0}
        t.add([((0.024 * x, 0.008, 0.105), 0.018, 0.020, _between("root", "leg" + side, 0.6)),
               ((0.026 * x, 0.006, 0.062), 0.008, 0.009, leg)], "coat")
        t.add([((0.026 * x, 0.007, 0.066), 0.004, 0.004, leg), ((0.026 * x, 0.007, 0.055), 0.004, 0.004, shank),
               ((0.026 * x, 0.005, 0.014), 0.0035, 0.0035, _between("shank" + side, "foot" + side, 0.5))], "beak")
        t.add([((0.026 * x, 0.022, 0.005), 0.003, 0.003, foot), ((0.026 * x, 0.0, 0.006), 0.008, 0.004, foot),
               ((0.026 * x, -0.030, 0.003), 0.012, 0.002, foot)], "beak")
    return t


def _fold(pose):
    """Wings along the flanks, their upper sides outward."""
    for side, x in (("_L", 1.0), ("_R", -1.0)):
        pose.turn("wing" + side, "z", 88.0 * x)
        pose.turn("wing" + side, "y", 50.0 * x)
        pose.turn("wing" + side, "x", 3.0)
        pose.turn("hand" + side, "z", 6.0 * x)


def walk_clip(skeleton):
    """The head stays where it is and is thrown ahead with each step; also the speed of the feet that stand, in m/s."""

    def pose_at(t, pose):
        _fold(pose)
        thrown = np.sin(2 * t)
        pose.turn("neck", "x", -9.0 * thrown)
        pose.turn("head", "x", 9.0 * thrown)
        pose.turn("root", "y", 2.5 * np.sin(t))
        pose.root[2] += 0.002 * np.cos(2 * t)
        for side, ahead in (("_L", 0.0), ("_R", 0.5)):
            own = (t - 2.0 * np.pi * ahead) % (2.0 * np.pi)
            swing = 1.0 - 2.0 * own / np.pi if own < np.pi else np.cos(own)
            lift = max(0.0, -np.sin(own))
            pose.turn("leg" + side, "x", -STEP_DEG * swing - 34.0 * lift)
            pose.turn("shank" + side, "x", 62.0 * lift)
            pose.turn("foot" + side, "x", STEP_DEG * swing - 30.0 * lift)

    stride_m = 2.0 * 0.085 * np.sin(np.radians(STEP_DEG))
    return make_clip(skeleton, "walk", WALK_S, pose_at), float(stride_m / (0.5 * WALK_S))


def idle_clip(skeleton):
    """It looks about, and pecks three times."""

    def pose_at(t, pose):
        _fold(pose)
        down = 0.0
        for at in (1.0, 1.7, 3.9):
            down += np.exp(-((t - at) / 0.22) ** 2)
        pose.turn("root", "x", 26.0 * down)
        pose.turn("neck", "x", 62.0 * down)
        pose.turn("head", "x", 14.0 * down)
        pose.turn("leg_L", "x", -26.0 * down)
        pose.turn("leg_R", "x", -26.0 * down)
        look = np.sin(t) * (1.0 - min(1.0, down))
        pose.turn("neck", "z", 14.0 * look)
        pose.turn("head", "z", 22.0 * np.sin(2 * t) * (1.0 - min(1.0, down)))

    return make_clip(skeleton, "idle", IDLE_S, pose_at)


def fly_clip(skeleton):
    def pose_at(t, pose):
        pose.root[2] -= 0.006 * np.sin(t)
        pose.turn("neck", "x", 22.0)
        pose.turn("head", "x", -14.0)
        pose.turn("tail", "x", 4.0 * np.sin(t))
        for side, x in (("_L", 1.0), ("_R", -1.0)):
            beat = np.sin(t)
            pose.turn("wing" + side, "y", x * (-16.0 - 44.0 * beat))
            pose.turn("hand" + side, "y", x * (6.0 - 34.0 * np.sin(t - 0.9)))
            pose.turn("wing" + side, "z", x * 8.0 * np.cos(t))
            pose.turn("leg" + side, "x", 40.0)
            pose.turn("shank" + side, "x", 44.0)
            pose.turn("foot" + side, "x", 40.0)

    return make_clip(skeleton, "fly", FLY_S, pose_at)
