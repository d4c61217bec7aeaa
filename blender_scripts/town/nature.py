"""Trees and lamp posts: a few meshes each, used many times."""

import math

from mesh import Mesh, lathe, shade, srgb

TRUNK_RADIUS_M = 0.28
LAMP_RADIUS_M = 0.14


def _limb(mesh, start, end, r0, r1, sides, color):
    """A round branch."""
    axis = [end[i] - start[i] for i in range(3)]
    length = math.sqrt(sum(c * c for c in axis))
    axis = [c / length for c in axis]
    helper = (0, 0, 1) if abs(axis[2]) < 0.9 else (1, 0, 0)
    u = _unit(_cross(helper, axis))
    v = _cross(axis, u)
    for i in range(sides):
        points, uvs, normals = [], [], []
        for k, (c, r, s) in ((i, (start, r0, 0)), (i + 1, (start, r0, 0)), (i + 1, (end, r1, length)), (i, (end, r1, length))):
            t = 2 * math.pi * k / sides
            d = tuple(math.cos(t) * u[m] + math.sin(t) * v[m] for m in range(3))
            points.append(tuple(c[m] + r * d[m] for m in range(3)))
            uvs.append((k * 2 * r0 * math.pi / sides, s))
            normals.append(d)
        mesh.face("bark", points, uvs, color, normals)


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(a):
    n = math.sqrt(sum(c * c for c in a)) or 1.0
    return tuple(c / n for c in a)


def make_tree(rng, height, crown, tint, detail=1.0):
    """A broad-leaved tree: forked trunk, clumps of foliage, loose leaf sprays that break the outline.

    detail: 1 to be seen from nearby, less for gardens and the far side of the wall.
    """
    mesh = Mesh()
    bark = srgb("c9bba8")
    fork = height * 0.36
    lean = (rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15))
    mesh_base = [(0.42, -0.6), (0.33, 0.0), (0.27, 0.35), (0.23, fork * 0.6)]
    lathe(mesh, "bark", (0, 0, 0), mesh_base, 9, bark, caps=False)
    top = (lean[0], lean[1], fork)
    _limb(mesh, (0, 0, fork * 0.6 - 0.12), top, 0.226, 0.2, 9, bark)
    clumps = []
    arms = 6 if detail > 0.6 else 4
    for i in range(arms):
        yaw = 2 * math.pi * (i + rng.uniform(-0.25, 0.25)) / arms
        out = crown * rng.uniform(0.5, 0.72)
        end = (lean[0] + math.cos(yaw) * out, lean[1] + math.sin(yaw) * out, fork + height * rng.uniform(0.16, 0.34))
        _limb(mesh, top, end, 0.12, 0.05, 5, bark)
        clumps.append((end, crown * rng.uniform(0.42, 0.52)))
    peak = (lean[0], lean[1], height * 0.86)
    _limb(mesh, top, peak, 0.15, 0.04, 5, bark)
    clumps += [((lean[0], lean[1], height * 0.84), crown * 0.5), ((lean[0] + 0.5, lean[1] - 0.3, height * 0.66), crown * 0.66)]
    for i in range(4 if detail > 0.3 else 0):
        yaw = 2 * math.pi * (i + 0.5 + rng.uniform(-0.2, 0.2)) / 4
        clumps.append(((lean[0] + math.cos(yaw) * crown * 0.45, lean[1] + math.sin(yaw) * crown * 0.45, height * 0.74),
                       crown * rng.uniform(0.4, 0.48)))
    middle = (lean[0], lean[1], height * 0.62)
    green = srgb(tint)
    for center, radius in clumps:
        _clump(mesh, center, radius, middle, height, green, rng, detail)
    return mesh


def _clump(mesh, center, radius, middle, height, green, rng, detail):
    """A lumpy ball of foliage, and leaf sprays around it."""
    sides, bands = (8, 5) if detail > 0.6 else (6, 4)
    offset = [[1 + rng.uniform(-0.2, 0.2) for _ in range(sides)] for _ in range(bands + 1)]

    def spot(k, i):
        t = math.pi * k / bands
        r = radius * offset[k][i % sides] * (1.0 if 0 < k < bands else 0.9)
        a = 2 * math.pi * (i + 0.5 * (k % 2)) / sides
        return (center[0] + math.sin(t) * math.cos(a) * r, center[1] + math.sin(t) * math.sin(a) * r,
                center[2] - math.cos(t) * r * 0.82)

    def soft(p):
        away = _unit(tuple(p[m] - center[m] for m in range(3)))
        broad = _unit(tuple(p[m] - middle[m] for m in range(3)))
        return _unit(tuple(0.6 * away[m] + 0.6 * broad[m] for m in range(3)))

    for k in range(bands):
        for i in range(sides):
            points = [spot(k, i), spot(k, i + 1), spot(k + 1, i + 1), spot(k + 1, i)]
            wide, tall = radius * 0.78, radius * 0.55
            uvs = [(i * wide, k * tall), ((i + 1) * wide, k * tall), ((i + 1) * wide, (k + 1) * tall), (i * wide, (k + 1) * tall)]
            if k == 0:
                points, uvs = [points[0], points[2], points[3]], [uvs[0], uvs[2], uvs[3]]
            elif k == bands - 1:
                points, uvs = points[:3], uvs[:3]
            inner = 0.62 + 0.3 * k / bands
            mesh.face("leaves", points, uvs, shade(green, inner * rng.uniform(0.9, 1.05)), [soft(p) for p in points])
    for _ in range(int(46 * detail)):
        a, b = rng.uniform(0, 2 * math.pi), math.acos(rng.uniform(-0.75, 1.0))
        d = (math.sin(b) * math.cos(a), math.sin(b) * math.sin(a), math.cos(b))
        p = tuple(center[m] + d[m] * radius * (0.94 if m < 2 else 0.8) for m in range(3))
        side = _unit(_cross(d, (rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))))
        fall = _cross(d, side)
        long, wide = rng.uniform(0.2, 0.34), rng.uniform(0.08, 0.13)
        tip = [0.55 * d[m] + 0.8 * fall[m] for m in range(3)]
        points = [p, tuple(p[m] + tip[m] * long * 0.5 + side[m] * wide for m in range(3)),
                  tuple(p[m] + tip[m] * long for m in range(3)),
                  tuple(p[m] + tip[m] * long * 0.5 - side[m] * wide for m in range(3))]
        shift = (rng.random() * 2, rng.random() * 2)
        uvs = [(shift[0], shift[1]), (shift[0] + wide, shift[1] + long / 2), (shift[0], shift[1] + long),
               (shift[0] - wide, shift[1] + long / 2)]
        light = 0.7 + 0.35 * (p[2] / height)
        mesh.face("leaves", points, uvs, shade(green, light * rng.uniform(0.9, 1.15)), [soft(p)] * 4)


def make_lamp():
    """A cast-iron lamp post with a four-sided lantern."""
    mesh = Mesh()
    iron = (0.035, 0.04, 0.038)
    profile = [(0.17, -0.2), (0.17, 0.12), (0.12, 0.2), (0.13, 0.45), (0.075, 0.6), (0.06, 1.0), (0.045, 2.6), (0.07, 2.66),
               (0.04, 2.74), (0.035, 3.05), (0.09, 3.12), (0.15, 3.16)]
    lathe(mesh, "iron", (0, 0, 0), profile, 8, iron, caps=False)
    low, high, z0, z1 = 0.14, 0.22, 3.16, 3.62
    glow = (1.0, 0.86, 0.55)
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    for a, b in zip(ring, ring[1:] + ring[:1]):
        points = [(a[0] * low, a[1] * low, z0), (b[0] * low, b[1] * low, z0), (b[0] * high, b[1] * high, z1),
                  (a[0] * high, a[1] * high, z1)]
        mesh.face("cloth", points, [(0, 0), (0.28, 0), (0.4, 0.46), (0, 0.46)], glow)
        mesh.face("iron", [(a[0] * 0.27, a[1] * 0.27, z1), (b[0] * 0.27, b[1] * 0.27, z1), (0, 0, z1 + 0.26)],
                  [(0, 0), (0.5, 0), (0.25, 0.3)], iron)
        _limb_iron(mesh, (a[0] * low, a[1] * low, z0), (a[0] * high, a[1] * high, z1), iron)
    mesh.face("iron", [(c[0] * 0.27, c[1] * 0.27, z1) for c in ring][::-1], [(0, 0), (1, 0), (1, 1), (0, 1)], iron)
    lathe(mesh, "iron", (0, 0, z1 + 0.22), [(0.05, 0.0), (0.06, 0.06), (0.0, 0.2)], 6, iron)
    return mesh


def _limb_iron(mesh, a, b, color):
    before = len(mesh.materials)
    _limb(mesh, a, b, 0.022, 0.022, 4, color)
    mesh.materials[before:] = ["iron"] * (len(mesh.materials) - before)


def add_ivy(mesh, line, low, high, rng):
    """Ivy over a stretch of a wall along a line: leaves that hang down its left face, densest on top.

    low and high: functions of the place along the line, 0 to 1, that give the ground and the top of the wall.
    """
    length = math.dist(line[0], line[1])
    way = ((line[1][0] - line[0][0]) / length, (line[1][1] - line[0][1]) / length)
    out = (-way[1], way[0])
    reach, center = min(length / 2, rng.uniform(0.9, 2.0)), rng.uniform(0.3, 0.7)
    for _ in range(int(70 * reach)):
        t = center + rng.gauss(0, 0.45) * reach / length
        if not 0.02 < t < 0.98:
            continue
        fall = abs(rng.gauss(0, 0.42)) * max(0.15, 1 - abs(t - center) * length / reach / 1.3)
        z = max(low(t) + 0.15, high(t) + 0.2 - 1.9 * fall)
        off = rng.uniform(-0.42, 0.06) if z > high(t) + 0.1 else rng.uniform(0.02, 0.09)
        x, y = line[0][0] + way[0] * length * t + out[0] * off, line[0][1] + way[1] * length * t + out[1] * off
        size, tilt = rng.uniform(0.1, 0.19), rng.uniform(-0.9, 0.9)
        a = (way[0] * math.cos(tilt), way[1] * math.cos(tilt), math.sin(tilt))
        b = (-way[0] * math.sin(tilt) + out[0] * 0.25, -way[1] * math.sin(tilt) + out[1] * 0.25, math.cos(tilt))
        points = [(x - b[0] * size, y - b[1] * size, z - b[2] * size), (x + a[0] * size * 0.8, y + a[1] * size * 0.8, z + a[2] * size * 0.8),
                  (x + b[0] * size * 0.8, y + b[1] * size * 0.8, z + b[2] * size * 0.8),
                  (x - a[0] * size * 0.8, y - a[1] * size * 0.8, z - a[2] * size * 0.8)]
        shift = rng.random() * 3
        up = _unit((out[0] * 0.8, out[1] * 0.8, 0.6))
        mesh.face("leaves", points, [(shift, 0), (shift + 0.06, 0.06), (shift, 0.12), (shift - 0.06, 0.06)],
                  shade(srgb("6f8a3c"), rng.uniform(0.6, 1.1)), [up] * 4)
