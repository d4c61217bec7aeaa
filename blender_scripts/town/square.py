"""What stands about in the town: well, market stalls, carts, benches, barrels, crates, sacks, graves."""

import math
import random

from masonry import LIMESTONE
from mesh import Frame, Mesh, beam, box, extrude, lathe, panel, polygon, shade, srgb
from openings import leaf_tuft

WOOD = [srgb("8a6a48"), srgb("7a5a3c"), srgb("9a7a55"), srgb("6b5138")]
STRIPES = [("b33a2e", "efe6d2"), ("2f5d4a", "efe6d2"), ("33548a", "f0e8d6"), ("c98a2b", "f2ead8"), ("7c2f4a", "eadfca"),
           ("5b6f2f", "f0e8d6"), ("b5532f", "e9dcc0")]
FRUIT = [srgb("c23a28"), srgb("d9a02f"), srgb("7f9a36"), srgb("b86a2c"), srgb("8a3f5a"), srgb("e0c25a")]


def barrel(mesh, x, y, z, rng, scale=1.0):
    wood = rng.choice(WOOD)
    r, h = 0.3 * scale, 0.85 * scale
    profile = [(r * 0.82, 0.0), (r * 0.97, h * 0.28), (r, h * 0.5), (r * 0.97, h * 0.72), (r * 0.82, h)]
    lathe(mesh, "planks", (x, y, z), profile, 10, wood)
    for t, k in ((0.14, 0.92), (0.32, 1.0), (0.68, 1.0), (0.86, 0.92)):
        lathe(mesh, "iron", (x, y, z + h * t - 0.025), [(r * k + 0.008, 0.0), (r * k + 0.01, 0.05)], 10, (0.06, 0.055, 0.05),
              caps=False)


def crate(mesh, x, y, z, size, rng, goods=True):
    w, d, h = size
    wood = shade(rng.choice(WOOD), 1.15)
    part = Mesh()
    box(part, "planks", (-w / 2, -d / 2, 0), (w / 2, d / 2, h), wood, skip="zZ")
    lid = Frame((-w / 2, -d / 2, h - 0.015), (1, 0, 0), (0, 1, 0))
    polygon(part, "planks", lid, [(0, 0), (w, 0), (w, d), (0, d)], shade(wood, 0.5))
    if goods:
        heap(part, -w / 2 + 0.06, w / 2 - 0.06, -d / 2 + 0.06, d / 2 - 0.06, h - 0.05, rng)
    mesh.add(part.moved(x, y, z, rng.uniform(-0.3, 0.3)))


def heap(mesh, x0, x1, y0, y1, z, rng):
    """Fruit or bread in rows."""
    color, r = rng.choice(FRUIT), rng.uniform(0.055, 0.08)
    nx, ny = max(1, int((x1 - x0) / (2.3 * r))), max(1, int((y1 - y0) / (2.3 * r)))
    for i in range(nx):
        for j in range(ny):
            cx = x0 + (x1 - x0) * (i + 0.5) / nx + rng.uniform(-0.01, 0.01)
            cy = y0 + (y1 - y0) * (j + 0.5) / ny
            ball = [(r * 0.82, r * 0.35), (r, r * 0.9), (r * 0.84, r * 1.48), (r * 0.45, r * 1.8), (0.0, r * 1.88)]
            lathe(mesh, "cloth", (cx, cy, z), ball, 8, shade(color, rng.uniform(0.8, 1.1)), caps=False, ball=True)


def sack(mesh, x, y, z, rng):
    cloth = shade(srgb("c9b48a"), rng.uniform(0.8, 1.05))
    r, h = rng.uniform(0.22, 0.28), rng.uniform(0.5, 0.65)
    first, slump = len(mesh.points), 9 * x + 5 * y
    lathe(mesh, "cloth", (x, y, z), [(r * 0.95, 0.0), (r * 1.06, h * 0.1), (r * 1.0, h * 0.46), (r * 0.84, h * 0.7), (r * 0.34, h * 0.84),
                                     (r * 0.68, h)], 9, cloth, ball=True)
    for k in range(first, len(mesh.points)):
        px, py, pz = mesh.points[k]
        angle = math.atan2(py - y, px - x)
        swell = 1 + 0.11 * math.cos(2 * angle + slump) + 0.08 * math.cos(3 * angle + 2 * slump + 5 * (pz - z))
        lean = 0.16 * (pz - z) ** 2 / h
        mesh.points[k] = (x + (px - x) * swell + lean * math.cos(slump), y + (py - y) * swell + lean * math.sin(slump), pz)
    top = 0.16 * (0.84 * h) ** 2 / h
    lathe(mesh, "cloth", (x + top * math.cos(slump), y + top * math.sin(slump), z + h * 0.81), [(r * 0.4, 0.0), (r * 0.4, h * 0.05)], 8,
          shade(cloth, 0.45), caps=False)


def make_stall(rng):
    """A market stall, its counter towards -y; about 3 m wide and 2.2 m deep."""
    mesh = Mesh()
    w, d, high, low = 3.0, 1.9, 2.95, 2.5
    wood = rng.choice(WOOD)
    for x in (-w / 2, w / 2):
        for y, top in ((-d / 2, low), (d / 2, high)):
            box(mesh, "timber", (x - 0.05, y - 0.05, -0.3), (x + 0.05, y + 0.05, top), wood, skip="zZ")
    awning(mesh, w, d, high, low, [srgb(c) for c in rng.choice(STRIPES)])
    box(mesh, "planks", (-w / 2 + 0.05, -d / 2 - 0.1, 0.82), (w / 2 - 0.05, -0.1, 0.9), shade(wood, 1.1))
    panel(mesh, "planks", Frame((-w / 2 + 0.05, -d / 2 - 0.02, 0), (1, 0, 0)), 0, w - 0.1, -0.2, 0.82, shade(wood, 0.95))
    panel(mesh, "planks", Frame((w / 2 - 0.05, -0.2, 0), (-1, 0, 0)), 0, w - 0.1, -0.2, 0.82, shade(wood, 0.9))
    for x, frame_u in ((w / 2 - 0.05, (0, 1, 0)), (-w / 2 + 0.05, (0, -1, 0))):
        y = -d / 2 - 0.02 if frame_u[1] > 0 else -0.2
        panel(mesh, "planks", Frame((x, y, 0), frame_u), 0, d / 2 - 0.18, -0.2, 0.82, shade(wood, 0.9))
    for i in range(4):
        x = -w / 2 + 0.42 + i * 0.72
        tray = Mesh()
        box(tray, "planks", (-0.3, -0.28, 0), (0.3, 0.28, 0.14), shade(wood, 1.25), skip="zZ")
        polygon(tray, "planks", Frame((-0.3, -0.28, 0.1), (1, 0, 0), (0, 1, 0)), [(0, 0), (0.6, 0), (0.6, 0.56), (0, 0.56)],
                shade(wood, 0.6))
        heap(tray, -0.26, 0.26, -0.24, 0.24, 0.1, rng)
        mesh.add(tray.moved(x, -d / 2 + 0.36, 0.9))
    crate(mesh, -w / 2 + 0.5, d / 2 - 0.2, 0, (0.6, 0.5, 0.45), rng)
    crate(mesh, -w / 2 + 0.55, d / 2 - 0.2, 0.45, (0.55, 0.45, 0.4), rng)
    barrel(mesh, w / 2 - 0.4, d / 2 - 0.15, 0, rng)
    for x in (0.62, 0.86):  # the keeper comes in and stands left of them
        sack(mesh, x + 0.1 * rng.uniform(-0.2, 0.6), d / 2 - 0.1, 0, rng)
    return mesh


def awning(mesh, w, d, high, low, colors):
    """A striped cloth that sags a little, with a scalloped edge."""
    stripes, over = 10, 0.35
    y0, y1 = -d / 2 - over, d / 2 + 0.1
    z0 = low - over * (high - low) / d

    def sag(x, t):
        return -0.07 * math.sin(math.pi * t) - 0.03 * math.sin(math.pi * (x + w / 2) / w)

    for i in range(stripes):
        a, b = -w / 2 - 0.12 + (w + 0.24) * i / stripes, -w / 2 - 0.12 + (w + 0.24) * (i + 1) / stripes
        color = colors[i % 2]
        for k in range(3):
            s, t = k / 3, (k + 1) / 3
            ys, yt = y0 + (y1 - y0) * s, y0 + (y1 - y0) * t
            zs, zt = z0 + (high - z0) * s, z0 + (high - z0) * t
            top = [(a, ys, zs + sag(a, s)), (b, ys, zs + sag(b, s)), (b, yt, zt + sag(b, t)), (a, yt, zt + sag(a, t))]
            uvs = [(a, ys), (b, ys), (b, yt), (a, yt)]
            mesh.face("cloth", top, uvs, color)
            mesh.face("cloth", [(p[0], p[1], p[2] - 0.02) for p in top[::-1]], uvs[::-1], shade(color, 0.85))
        m = (a + b) / 2
        edge = [(a, y0, z0 - 0.14), (m, y0 - 0.02, z0 - 0.24), (b, y0, z0 - 0.14), (b, y0, z0 + sag(b, 0)), (a, y0, z0 + sag(a, 0))]
        uvs = [(p[0], p[2]) for p in edge]
        mesh.face("cloth", edge, uvs, color)
        mesh.face("cloth", [(p[0], p[1] + 0.015, p[2]) for p in edge[::-1]], uvs[::-1], shade(color, 0.85))


def make_well(rng):
    """A round stone well with a shingled roof on two posts, a winch and a bucket."""
    mesh = Mesh()
    stone = srgb("cdbfa6")
    lathe(mesh, "stone", (0, 0, 0), [(1.25, -0.3), (1.25, 0.72), (1.38, 0.74), (1.38, 0.9), (0.98, 0.9), (0.98, 0.1)], 16, stone,
          smooth=False, caps=False)
    lathe(mesh, "stone", (0, 0, 0), [(1.75, -0.3), (1.75, 0.09), (1.2, 0.09)], 16, shade(stone, 0.9), smooth=False, caps=False)
    water = [(math.cos(2 * math.pi * k / 16) * 1.0, math.sin(2 * math.pi * k / 16) * 1.0, 0.25) for k in range(16)]
    mesh.face("glass", water, [(p[0] * 0.02, p[1] * 0.02) for p in water], (0.4, 0.5, 0.5))
    wood = srgb("6b4a30")
    for x in (-1.15, 1.15):
        box(mesh, "timber", (x - 0.09, -0.09, 0.85), (x + 0.09, 0.09, 2.95), wood)
        for s in (-1, 1):
            beam(mesh, Frame((x - 0.05, 0, 0), (0, -1, 0)), (0, 2.25), (s * 0.75, 2.8), 0.1, 0.05, wood, rng, base=-0.05)
            beam(mesh, Frame((x + 0.05, 0, 0), (0, 1, 0)), (0, 2.25), (s * 0.75, 2.8), 0.1, 0.05, wood, rng, base=-0.05)
    for s in (-1, 1):
        eave, ridge = (s * 1.25, 2.62), (0.0, 3.75)
        top = [(-1.6, eave[0], eave[1]), (1.6, eave[0], eave[1]), (1.6, 0, ridge[1]), (-1.6, 0, ridge[1])]
        run = math.hypot(1.25, 1.13)
        uvs = [(0, 0), (3.2, 0), (3.2, run), (0, run)]
        down = [(p[0], p[1], p[2] - 0.09) for p in top[::-1]]
        if s == 1:
            top, down, uvs = top[::-1], down[::-1], uvs[::-1]
        mesh.face("roof_tile", top, uvs, (0.8, 0.74, 0.7))
        mesh.face("planks", down, uvs[::-1], shade(wood, 1.2))
        rim = [(-1.6, eave[0], eave[1] - 0.09), (1.6, eave[0], eave[1] - 0.09), (1.6, eave[0], eave[1]), (-1.6, eave[0], eave[1])]
        mesh.face("planks", rim if s == -1 else rim[::-1], [(0, 0), (3.2, 0), (3.2, 0.1), (0, 0.1)], wood)
        for x, order in ((-1.6, 1), (1.6, -1)):
            verge = [(x, 0, ridge[1] - 0.09), (x, eave[0], eave[1] - 0.09), (x, eave[0], eave[1]), (x, 0, ridge[1])]
            flip = order * (1 if s == -1 else -1)
            mesh.face("planks", verge[::flip], [(0, 0), (run, 0), (run, 0.1), (0, 0.1)], wood)
    for x, order in ((-1.45, -1), (1.45, 1)):
        tri = [(x, -1.1, 2.72), (x, 1.1, 2.72), (x, 0, 3.62)]
        mesh.face("planks", tri[::order], [(0, 0), (2.2, 0), (1.1, 1)][::order], shade(wood, 1.1))
    _roller(mesh, wood)
    lathe(mesh, "planks", (0, 0, 1.15), [(0.14, 0.0), (0.18, 0.34)], 9, srgb("8a6a48"))
    box(mesh, "cloth", (-0.015, -0.015, 1.5), (0.015, 0.015, 1.95), srgb("b9a57c"), skip="zZ")
    return mesh


def _roller(mesh, wood):
    sides = 8
    for i in range(sides):
        a, b = 2 * math.pi * i / sides, 2 * math.pi * (i + 1) / sides
        points = [(-1.1, math.cos(a) * 0.12, 1.95 + math.sin(a) * 0.12), (-1.1, math.cos(b) * 0.12, 1.95 + math.sin(b) * 0.12),
                  (1.1, math.cos(b) * 0.12, 1.95 + math.sin(b) * 0.12), (1.1, math.cos(a) * 0.12, 1.95 + math.sin(a) * 0.12)]
        mesh.face("timber", points, [(0, 0), (0, 0.1), (2.2, 0.1), (2.2, 0)], wood)


def make_bench(rng):
    """A plank bench on two stone blocks, 1.8 m long, its back towards +y."""
    mesh = Mesh()
    wood = rng.choice(WOOD)
    for x in (-0.65, 0.65):
        box(mesh, "stone", (x - 0.12, -0.2, -0.3), (x + 0.12, 0.2, 0.4), LIMESTONE, skip="z")
    for y in (-0.2, 0.02):
        box(mesh, "planks", (-0.9, y, 0.4), (0.9, y + 0.19, 0.46), wood)
    return mesh


def make_cart(rng, horse=False):
    """A two-wheeled cart with hay, its shafts towards -x: a hand cart's on the ground, or level at both sides of a horse."""
    mesh = Mesh()
    wood = rng.choice(WOOD)
    tilt, wheel, shafts, apart = (0.0, 0.62, 2.9, 0.48) if horse else (0.16, 0.5, 2.3, 0.38)
    body = Mesh()
    box(body, "planks", (-1.0, -0.5, 0.0), (1.0, 0.5, 0.07), wood)
    for y0, y1 in ((-0.55, -0.5), (0.5, 0.55)):
        box(body, "planks", (-1.0, y0, 0.0), (1.0, y1, 0.42), shade(wood, 0.92))
    for x0, x1 in ((-1.05, -1.0), (1.0, 1.05)):
        box(body, "planks", (x0, -0.55, 0.0), (x1, 0.55, 0.36), shade(wood, 0.92))
    for y in (-apart - 0.04, apart - 0.04):
        box(body, "timber", (-shafts, y, -0.02), (-0.9, y + 0.08, 0.06), wood)
    for _ in range(46 * 13):
        rng.random()    # what stands beside carts is drawn after them
    hay(body, 0.98, 0.48, 0.3, 0.68, random.Random("hay %d" % horse))
    body.points = [(p[0], p[1], p[2] + wheel + 0.12 + tilt * p[0]) for p in body.points]
    mesh.add(body)
    for y in (-0.68, 0.6):
        _wheel(mesh, 0.1, y, wheel, wood)
    box(mesh, "timber", (0.06, -0.75, wheel - 0.04), (0.14, 0.75, wheel + 0.04), shade(wood, 0.8))
    return mesh


def make_trough(rng):
    """A wooden trough with hay, along y."""
    mesh = Mesh()
    box(mesh, "planks", (-0.24, -0.6, -0.3), (0.24, 0.6, 0.52), srgb("6b5138"), skip="zZ")
    heap_of_hay = Mesh()
    hay(heap_of_hay, 0.24, 0.6, 0.4, 0.6, rng)
    mesh.add(heap_of_hay)
    return mesh


def hay(mesh, half_x, half_y, low, high, rng):
    """An uneven heap on a rectangle, with stalks that stick out of it."""
    straw, across, along = srgb("a8904f"), 7, 7
    spots = {}
    for i in range(across + 1):
        for k in range(along + 1):
            u, v = 2 * i / across - 1, 2 * k / along - 1
            rise = (1 - u ** 4) * (1 - v ** 4)
            spots[i, k] = (u * half_x, v * half_y, low + (high - low) * rise * rng.uniform(0.75, 1.1))
    for i in range(across):
        for k in range(along):
            points = [spots[i, k], spots[i + 1, k], spots[i + 1, k + 1], spots[i, k + 1]]
            mesh.face("plaster", points, [(p[0], p[1]) for p in points], shade(straw, rng.uniform(0.75, 1.0)),
                      [(0.5 * p[0] / half_x, 0.5 * p[1] / half_y, 0.8) for p in points])
    for _ in range(round(130 * half_x * half_y / 0.47)):
        x, y, z = spots[rng.randrange(1, across), rng.randrange(1, along)]
        x, y, z = x + rng.uniform(-0.12, 0.12) * half_x, y + rng.uniform(-0.12, 0.12) * half_y, z - 0.03
        yaw, rise, length = rng.uniform(0, 2 * math.pi), rng.uniform(-0.1, 0.8), rng.uniform(0.14, 0.34)
        way = (math.cos(yaw) * math.cos(rise), math.sin(yaw) * math.cos(rise), math.sin(rise))
        side = (-0.008 * math.sin(yaw), 0.008 * math.cos(yaw))
        tip = (x + way[0] * length, y + way[1] * length, z + way[2] * length + 0.02)
        blade = [(x - side[0], y - side[1], z), (x + side[0], y + side[1], z), (tip[0] + side[0] / 2, tip[1] + side[1] / 2, tip[2]),
                 (tip[0] - side[0] / 2, tip[1] - side[1] / 2, tip[2])]
        mesh.face("plaster", blade, [(0, 0), (0.02, 0), (0.02, length), (0, length)], shade(straw, rng.uniform(0.8, 1.25)), [(0, 0, 1)] * 4)


def _wheel(mesh, x, y, r, wood):
    sides, width = 14, 0.08
    front = Frame((x, y, r), (1, 0, 0))
    for i in range(sides):
        a, b = 2 * math.pi * i / sides, 2 * math.pi * (i + 1) / sides
        quad = [(math.cos(a) * r * 0.84, math.sin(a) * r * 0.84), (math.cos(a) * r, math.sin(a) * r),
                (math.cos(b) * r, math.sin(b) * r), (math.cos(b) * r * 0.84, math.sin(b) * r * 0.84)]
        extrude(mesh, "timber", front, quad, -width, 0.0, wood, back=True, flanks=(1, 3))
    for k in range(6):
        a = math.pi * k / 3
        c, s = math.cos(a), math.sin(a)
        quad = [(c * 0.05 + s * 0.025, s * 0.05 - c * 0.025), (c * r * 0.86 + s * 0.025, s * r * 0.86 - c * 0.025),
                (c * r * 0.86 - s * 0.025, s * r * 0.86 + c * 0.025), (c * 0.05 - s * 0.025, s * 0.05 + c * 0.025)]
        extrude(mesh, "timber", front, quad, -0.06, -0.02, shade(wood, 0.9), back=True, flanks=(0, 2))
    hub = [(math.cos(2 * math.pi * k / 8) * 0.09, math.sin(2 * math.pi * k / 8) * 0.09) for k in range(8)]
    extrude(mesh, "timber", front, hub, -width - 0.04, 0.04, shade(wood, 0.85), back=True)


def make_pile(rng):
    """Barrels, crates and sacks against a wall (towards +y)."""
    mesh = Mesh()
    x = -0.6
    for _ in range(rng.randrange(2, 4)):
        kind = rng.randrange(3)
        if kind == 0:
            barrel(mesh, x, 0, 0, rng, rng.uniform(0.85, 1.1))
        elif kind == 1:
            crate(mesh, x, 0, 0, (0.58, 0.5, 0.5), rng, rng.random() < 0.6)
            if rng.random() < 0.5:
                crate(mesh, x + 0.04, 0.02, 0.5, (0.5, 0.45, 0.42), rng)
        else:
            sack(mesh, x, 0.02, 0, rng)
        x += 0.64
    return mesh


def make_grave(rng):
    """A weathered headstone or a stone cross, facing -y."""
    mesh = Mesh()
    stone = shade(srgb("b8b2a2"), rng.uniform(0.75, 1.0))
    front = Frame((0, -0.08, 0), (1, 0, 0))
    h = rng.uniform(0.7, 1.1)
    if rng.random() < 0.6:
        shape = [(-0.3, -0.3), (0.3, -0.3), (0.3, h * 0.72), (0.18, h * 0.93), (0.0, h), (-0.18, h * 0.93), (-0.3, h * 0.72)]
        extrude(mesh, "stone", front, shape, -0.16, 0.0, stone, back=True)
    else:
        for quad in ([(-0.08, -0.3), (0.08, -0.3), (0.08, h), (-0.08, h)],
                     [(-0.3, h * 0.6), (-0.081, h * 0.6), (-0.081, h * 0.77), (-0.3, h * 0.77)],
                     [(0.081, h * 0.6), (0.3, h * 0.6), (0.3, h * 0.77), (0.081, h * 0.77)]):
            extrude(mesh, "stone", front, quad, -0.16, 0.0, stone, back=True)
    return mesh

