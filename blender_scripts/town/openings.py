"""Windows, doors, shutters, flower boxes and hanging signs, all on a wall frame."""

import math

from mesh import Frame, beam, extrude, panel, polygon, shade, srgb

IRON = (0.03, 0.03, 0.032)
LEAF = [srgb("6f8f3a"), srgb("5c7f34"), srgb("86a04a")]
FLOWERS = [srgb("d8433a"), srgb("e07a9a"), srgb("f1ece0"), srgb("c2362f"), srgb("e2a33a")]


def _plate(mesh, frame, u0, u1, v0, v1, low, high, color, shift, sill):
    """A flat painted board: its face and flanks, the upper one only above a sill, the lower one only without."""
    at, uv = frame.at, [(0.04, shift), (0.11, shift), (0.11, shift + 0.5), (0.04, shift + 0.5)]
    mesh.face("planks", [at(u0, v0, high), at(u1, v0, high), at(u1, v1, high), at(u0, v1, high)], uv, color)
    level = ((u1, v1), (u0, v1)) if sill else ((u0, v0), (u1, v0))
    for (a, b), (c, d) in (((u1, v0), (u1, v1)), level, ((u0, v1), (u0, v0))):
        mesh.face("planks", [at(a, b, low), at(c, d, low), at(c, d, high), at(a, b, high)], uv, color)


def window(mesh, frame, u, v, width, height, color, rng, base=0.0, sill=True, casements=2):
    """A leaded window, centred at u, its sill at v; `base` is how far its plane lies out of the wall."""
    u0, u1, v1 = u - width / 2, u + width / 2, v + height
    _plate(mesh, frame, u0, u1, v, v1, base, base + 0.045, color, rng.random(), sill)
    rows = [(v + 0.05, v1 - 0.05)]
    if height > 1.0:
        rows = [(v + 0.05, v + height * 0.66 - 0.025), (v + height * 0.66 + 0.025, v1 - 0.05)]
    pane = (width - 0.05) / casements
    for i in range(casements):
        a, b = u0 + 0.05 + pane * i, u0 + pane * (i + 1)
        shift = (rng.randrange(24) * 0.12 - a, rng.randrange(24) * 0.18 - v)
        for c, d in rows:
            polygon(mesh, "glass", frame, [(a, c), (b, c), (b, d), (a, d)], (0.8, 0.8, 0.8), base + 0.054, shift)
    if sill:
        beam(mesh, frame, (u0 - 0.05, v - 0.02), (u1 + 0.05, v - 0.02), 0.06, base + 0.11, shade(color, 0.9), rng,
             "planks", ends=True, base=base, step=9)


def shutters(mesh, frame, u, v, width, height, color, rng, base=0.0):
    """A pair of open board shutters beside a window."""
    leaf = width / 2
    for side in (-1, 1):
        middle = u + side * (width / 2 + leaf / 2 + 0.03)
        a, b = middle - leaf / 2, middle + leaf / 2
        extrude(mesh, "planks", frame, [(a, v), (b, v), (b, v + height), (a, v + height)], base, base + 0.045, color)


def leaf_tuft(mesh, center, size, color, rng, count=5):
    """A tuft of small leaf shapes in all directions."""
    cx, cy, cz = center
    for _ in range(count):
        yaw, pitch = rng.uniform(0, 2 * math.pi), rng.uniform(0.15, 1.2)
        d = (math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch))
        s = (-math.sin(yaw), math.cos(yaw), 0.0)
        length, half = size * rng.uniform(0.7, 1.2), size * 0.32
        tip = (cx + d[0] * length, cy + d[1] * length, cz + d[2] * length)
        mid = (cx + d[0] * length * 0.5, cy + d[1] * length * 0.5, cz + d[2] * length * 0.5 + size * 0.06)
        points = [(cx, cy, cz), (mid[0] - s[0] * half, mid[1] - s[1] * half, mid[2]), tip,
                  (mid[0] + s[0] * half, mid[1] + s[1] * half, mid[2])]
        up = (d[0] * 0.4, d[1] * 0.4, 0.9)
        shift = rng.random() * 3
        mesh.face("leaves", points, [(shift, 0), (shift + 0.05, 0.05), (shift, 0.12), (shift - 0.05, 0.05)],
                  shade(color, rng.uniform(0.8, 1.15)), [up] * 4)


def flower_box(mesh, frame, u, v, width, rng):
    """A wooden box with flowers under a window; v is the window's sill."""
    wood = srgb("6b4a30")
    a, b = u - width / 2, u + width / 2
    extrude(mesh, "planks", frame, [(a, v - 0.26), (b, v - 0.26), (b, v - 0.06), (a, v - 0.06)], 0.05, 0.27, wood)
    bloom = rng.choice(FLOWERS)
    for i in range(int(width / 0.2)):
        center = frame.at(a + 0.1 + i * 0.2, v - 0.08, 0.16 + rng.uniform(-0.03, 0.05))
        leaf_tuft(mesh, center, 0.22, rng.choice(LEAF), rng, 3)
        leaf_tuft(mesh, (center[0], center[1], center[2] + 0.1), 0.13, bloom, rng, 3)


def door(mesh, frame, u, width, height, colors, rng, recess=0.2, arched=False, stone=False):
    """A door in a hole of the wall: reveals, leaf, frame, threshold and a low step. Ground at v = 0.

    Returns the hole (u0, u1, v0, v1) that the wall has to leave.
    """
    u0, u1 = u - width / 2, u + width / 2
    sill = 0.14
    rim = srgb("b9ad97") if stone else colors["timber"]
    material = "stone" if stone else "timber"
    inner = frame.shifted(0, 0, -recess)
    for corners in ([(u0, sill), (u0, height)], [(u1, height), (u1, sill)], [(u0, height), (u1, height)]):
        (a, b), (c, d) = corners
        mesh.face(material, [frame.at(a, b), frame.at(a, b, -recess), frame.at(c, d, -recess), frame.at(c, d)],
                  [(0, b), (recess, b), (recess, d), (0, d)] if a == c else [(a, 0), (a, recess), (c, recess), (c, 0)],
                  shade(rim, 0.8))
    transom = height - 0.38 if height > 2.3 else height
    if transom < height:
        window(mesh, inner, u, transom, width, height - transom, colors["frame"], rng, sill=False)
    panel(mesh, "planks", inner, u0, u1, sill, transom, colors["door"], uv_shift=(rng.random() * 3, 0))
    if arched:
        beam(mesh, inner, (u, sill), (u, transom), 0.07, 0.04, shade(colors["door"], 0.7), rng, "planks")
    for z in (0.3, 1.0, 1.85):
        beam(mesh, inner, (u0 + 0.05, z), (u1 - 0.05, z), 0.1, 0.035, shade(colors["door"], 0.82), rng, "planks")
    for z in (0.42, 1.72):
        beam(mesh, inner, (u0 + 0.04, z), (u0 + width * 0.4, z), 0.045, 0.045, IRON, rng, "iron")
    beam(mesh, inner, (u1 - 0.2, 1.0), (u1 - 0.2, 1.2), 0.04, 0.07, IRON, rng, "iron", ends=True)
    edge, proud = 0.17, 0.05
    beam(mesh, frame, (u0 - edge / 2, 0), (u0 - edge / 2, height), edge, proud, rim, rng, material)
    beam(mesh, frame, (u1 + edge / 2, 0), (u1 + edge / 2, height), edge, proud, rim, rng, material)
    beam(mesh, frame, (u0 - edge - 0.05, height + 0.09), (u1 + edge + 0.05, height + 0.09), 0.19, proud + 0.02, rim, rng,
         material, ends=True)
    step = srgb("c9bda8")
    extrude(mesh, "stone", frame, [(u0, -0.6), (u1, -0.6), (u1, sill), (u0, sill)], -recess, 0.01, step, flanks=(2,))
    extrude(mesh, "stone", frame, [(u0 - 0.2, -0.6), (u1 + 0.2, -0.6), (u1 + 0.2, 0.07), (u0 - 0.2, 0.07)], 0.0, 0.36,
            step, flanks=(1, 2, 3))
    return u0, u1, sill, height


def arch(u, spring, width, rise, steps=8, pointed=False):
    """Points of an arch from its right springing to its left one, seen from outside."""
    points = []
    for i in range(steps + 1):
        t = i / steps
        if pointed:   # two arcs about the opposite springings
            side = 1 if t <= 0.5 else -1
            k = t * 2 if t <= 0.5 else 2 - t * 2
            reach = math.pi / 3 * k
            x = side * (math.cos(reach) * width - width / 2)
            z = math.sin(reach) * width * rise / (width * math.sin(math.pi / 3))
            points.append((u + x, spring + z))
        else:
            points.append((u + math.cos(math.pi * t) * width / 2, spring + math.sin(math.pi * t) * rise))
    return points


def sign(mesh, frame, u, v, rng):
    """A painted board on an iron bracket that hangs out over the street, its lower edge at v."""
    reach = 0.95
    across = Frame(frame.at(u, v), frame.n)          # the plane of the board, seen from the left
    for bar in ([(0, 0.7), (reach, 0.7), (reach, 0.735), (0, 0.735)], [(0, 0.35), (reach * 0.6, 0.7), (reach * 0.55, 0.7), (0, 0.385)]):
        extrude(mesh, "iron", across, bar, -0.014, 0.014, IRON, back=True)
    paint = rng.choice([srgb("7c2f26"), srgb("2f4d3a"), srgb("28466b"), srgb("a9772a")])
    gold = srgb("d8b25a")
    corners = [(0.3, 0.12), (0.62, 0.0), (0.92, 0.12), (0.92, 0.6), (0.3, 0.6)]
    extrude(mesh, "planks", across, corners, -0.02, 0.02, paint, back=True)
    kind = rng.randrange(3)
    for side in (1, -1):
        plane = across if side == 1 else Frame(across.at(1.22, 0), tuple(-c for c in across.u))
        shape = [[(0.46, 0.2), (0.76, 0.2), (0.7, 0.48), (0.52, 0.48)],
                 [(0.61, 0.18), (0.76, 0.34), (0.61, 0.52), (0.46, 0.34)],
                 [(0.44, 0.3), (0.61, 0.2), (0.78, 0.3), (0.78, 0.46), (0.44, 0.46)]][kind]
        polygon(mesh, "planks", plane, shape, gold, 0.024)
    for x in (0.36, 0.86):
        extrude(mesh, "iron", across, [(x - 0.01, 0.6), (x + 0.01, 0.6), (x + 0.01, 0.7), (x - 0.01, 0.7)], -0.01, 0.01, IRON,
                back=True, flanks=(1, 3))
