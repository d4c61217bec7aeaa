"""Trees and lamp posts: a few meshes each, used many times."""

import math

from mesh import Mesh, lathe, shade, srgb

TRUNK_RADIUS_M = 0.28
BARK_M = 0.5  # side of its picture
LAMP_RADIUS_M = 0.14


def _trunk(mesh, rings, sides, color):
    """An upright stem through rings of (centre, radius), whose bark runs on from one to the next and all round."""
    around, along = round(2 * math.pi * rings[-2][1] / BARK_M) * BARK_M, 0.0
    for (low, r0), (high, r1) in zip(rings, rings[1:]):
        length = math.dist(low, high)
        for i in range(sides):
            points, uvs, normals = [], [], []
            for k, c, r, s in ((i, low, r0, 0), (i + 1, low, r0, 0), (i + 1, high, r1, length), (i, high, r1, length)):
                d = (math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides), 0.0)
                points.append((c[0] + r * d[0], c[1] + r * d[1], c[2]))
                uvs.append((around * k / sides, along + s))
                normals.append(d)
            mesh.face("bark", points, uvs, color, normals)
        along += length


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
    """A broad-leaved tree: forked trunk, clumps of foliage, twigs that break the outline.

    detail: 1 to be seen from nearby, less for gardens and the far side of the wall.
    """
    mesh = Mesh()
    bark = srgb("c9bba8")
    fork = height * 0.36
    lean = (rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15))
    top = (lean[0], lean[1], fork)
    _trunk(mesh, [((0, 0, -0.6), 0.42), ((0, 0, 0.0), 0.33), ((0, 0, 0.35), 0.27), ((0, 0, fork * 0.6), 0.23), (top, 0.2)], 9, bark)
    clumps = []
    arms = 6 if detail > 0.8 else 4
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
    clumps = [Clump(center, radius, [rng.uniform(0, 2 * math.pi) for _ in range(6)]) for center, radius in clumps]
    for clump in clumps:
        others = [other for other in clumps if other is not clump]
        _foliage(mesh, clump, others, middle, green, detail)
        _twigs(mesh, clump, others, middle, green, rng, int(28 * min(1, 1.3 * detail)))
    return mesh


class Clump:
    """A lumpy ball of foliage, a little flat."""

    def __init__(self, center, radius, phases):
        self.center, self.radius, self.phases = center, radius, phases

    def spot(self, d, share=1.0):
        """The place on its surface in a direction, or that share of the way to it."""
        a, b, c, e, f, g = self.phases
        lumps = (math.sin(3 * d[0] + a) * math.sin(3 * d[1] + b) + math.sin(3 * d[2] + c) * math.sin(3 * d[0] + e)
                 + 0.6 * math.sin(7 * d[1] + f) * math.sin(7 * d[2] + 5 * d[0] + g))
        r = self.radius * (1 + 0.13 * lumps) * share
        return tuple(self.center[m] + d[m] * r * (1.0, 1.0, 0.82)[m] for m in range(3))

    def holds(self, p, share):
        """Whether a place lies within that share of it."""
        off = (p[0] - self.center[0], p[1] - self.center[1], (p[2] - self.center[2]) / 0.82)
        surface = self.spot(_unit(off))
        out = (surface[0] - self.center[0], surface[1] - self.center[1], (surface[2] - self.center[2]) / 0.82)
        return sum(c * c for c in off) < share * share * sum(c * c for c in out)

    def normal(self, p, middle):
        """Soft: half its own, half the whole crown's."""
        away = _unit(tuple(p[m] - self.center[m] for m in range(3)))
        broad = _unit(tuple(p[m] - middle[m] for m in range(3)))
        return _unit(tuple(away[m] + broad[m] for m in range(3)))


def _foliage(mesh, clump, others, middle, green, detail):
    """The surface of a clump, but for what lies within others."""
    sides, bands = (9, 5) if detail > 0.3 else (6, 4)

    def spot(k, i):
        t, a = math.pi * k / bands, 2 * math.pi * (i + 0.5 * (k % 2)) / sides
        return clump.spot((math.sin(t) * math.cos(a), math.sin(t) * math.sin(a), -math.cos(t)))

    for k in range(bands):
        shades = shade(green, 0.68 + 0.27 * k / bands)
        for i in range(sides):
            points = [spot(k, i), spot(k, i + 1), spot(k + 1, i + 1), spot(k + 1, i)]
            if k == 0:
                points = [points[0], points[2], points[3]]
            elif k == bands - 1:
                points = points[:3]
            if any(all(other.holds(p, 0.93) for p in points) for other in others):
                continue
            # Leaves as wide on every side: seen along the axis that the face looks along most.
            flat = max(range(3), key=lambda m: abs(sum(p[m] for p in points) / len(points) - clump.center[m]))
            u, v = [m for m in range(3) if m != flat]
            mesh.face("leaves", points, [(p[u], p[v]) for p in points], shades, [clump.normal(p, middle) for p in points])


def _twigs(mesh, clump, others, middle, green, rng, count):
    """Cards of leaves, cut out, that cover a clump and break its outline."""
    tries = 0
    while count > 0 and tries < 600:
        tries += 1
        a, up = rng.uniform(0, 2 * math.pi), rng.uniform(-1.0, 1.0)
        d = (math.sqrt(1 - up * up) * math.cos(a), math.sqrt(1 - up * up) * math.sin(a), up)
        p = clump.spot(d, rng.uniform(0.95, 1.03))
        if any(other.holds(p, 0.97) for other in others):
            continue
        count -= 1
        faces = _unit(tuple(d[m] + rng.uniform(-0.7, 0.7) for m in range(3)))
        side = _unit(_cross(faces, (rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))))
        fall = _cross(faces, side)
        half = clump.radius * rng.uniform(0.3, 0.42)
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        points = [tuple(p[m] + half * (x * side[m] + y * fall[m]) for m in range(3)) for x, y in corners]
        column, row = rng.randrange(2), rng.randrange(2)
        uvs = [((column + (x + 1) / 2) / 2, (row + (y + 1) / 2) / 2) for x, y in corners]
        light = 0.72 + 0.3 * max(0.0, up) + 0.06 * rng.uniform(-1, 1)
        mesh.face("twigs", points, uvs, shade(green, light), [clump.normal(q, middle) for q in points])


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
    """Ivy over a stretch of a wall along a line: twigs that hang down its left face, densest on top.

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
        half, turn, which, tint = 1.45 * rng.uniform(0.1, 0.19), 3.4 * rng.uniform(-0.9, 0.9), rng.random(), rng.uniform(0.6, 1.1)
        if which >= 0.5:  # of these places every other is enough
            continue
        p = (line[0][0] + way[0] * length * t + out[0] * off, line[0][1] + way[1] * length * t + out[1] * off, max(z, low(t) + half))
        lies = 2.0 if off < 0 else 0.15 + 0.1 * turn
        faces = _unit((out[0] + way[0] * 0.08 * turn, out[1] + way[1] * 0.08 * turn, lies))
        across = _unit(_cross((0, 0, 1), faces))
        rise = _cross(faces, across)
        side = tuple(math.cos(turn) * across[m] + math.sin(turn) * rise[m] for m in range(3))
        up = _cross(faces, side)
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        points = [tuple(p[m] + half * (u * side[m] + v * up[m]) for m in range(3)) for u, v in corners]
        column, row = int(4 * which), int(8 * which) % 2
        uvs = [((column + (u + 1) / 2) / 2, (row + (v + 1) / 2) / 2) for u, v in corners]
        light = _unit((out[0] * 0.8, out[1] * 0.8, 0.6))
        mesh.face("twigs", points, uvs, shade(srgb("6f8a3c"), tint), [light] * 4)
