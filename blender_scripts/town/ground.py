"""The ground: carriageways, square, pavements with kerbs, lawns, gardens with their paths and the land outside.

One constrained triangulation carries the kerb lines, the edges of lawns and the feet of the walls, so that nothing
overlaps and the baked light has vertices where it changes.
"""

import math
import random

import numpy as np
from mathutils import Vector, geometry

import plan
from gardens import EARTH, UNDER_WALLS_M as UNDER_GARDEN_WALLS_M
from layout import Field, contour, simplify
from mesh import Mesh, shade, srgb

UNDER_WALLS_M = 0.5     # the walkable ground goes on this far under the walls
KERB_STONE_M = 0.2
MATERIAL = {"carriageway": "cobble", "square": "setts", "pavement": "paving", "grass": "grass", "kerb": "stone",
            "garden": "grass", "path": "plaster"}
TINT = {"carriageway": (0.95, 0.94, 0.92), "square": (1.0, 0.98, 0.95), "pavement": (0.96, 0.94, 0.9),
        "grass": (0.97, 0.95, 0.88), "kerb": (0.78, 0.76, 0.73), "garden": (0.97, 0.95, 0.88), "path": EARTH}


def _lines(streets, public, gardens):
    """Lines that the triangulation has to keep."""
    carriage = Field.of(lambda p: plan.carriage_distance(p, streets))
    grass = Field.of(plan.grass_distance)
    square = Field.of(plan.square_distance)
    fields = [(carriage, 0.0, 0.02), (carriage, KERB_STONE_M, 0.03), (grass, 0.0, 0.04), (square, 0.0, 0.04),
              (public, 0.0, 0.05), (public, -0.7, 0.06), (public, UNDER_WALLS_M, 0.06),
              (gardens.room, -UNDER_GARDEN_WALLS_M, 0.06), (gardens.path, 0.0, 0.06)]
    kept = []
    for field, level, tolerance in fields:
        for line in contour(field.values, field.xs, field.ys, level):
            line = simplify(line, tolerance)
            kept.append(_divided(line, 2.2))
    return kept, carriage


def _divided(line, longest):
    out = [line[0]]
    for a, b in zip(line[:-1], line[1:]):
        count = max(1, math.ceil(np.linalg.norm(b - a) / longest))
        out.extend(a + (b - a) * i / count for i in range(1, count + 1))
    return np.array(out)


def _scattered(public, rng):
    """Inner points: dense where people walk, wide in the gardens."""
    fine = np.array([(x + 0.8 * (j % 2) + rng.uniform(-0.2, 0.2), y + rng.uniform(-0.2, 0.2))
                     for j, y in enumerate(np.arange(-91, 91, 1.6)) for x in np.arange(-95, 95, 1.75)])
    d = public(fine)
    fine = fine[d < -1.0]
    coarse = np.array([(x + rng.uniform(-1, 1), y + rng.uniform(-1, 1))
                       for y in np.arange(-95, 96, 6.0) for x in np.arange(-99, 100, 6.0)])
    return np.vstack([fine, coarse[public(coarse) > 2.0]])


def make_ground(streets, public, gardens, rng):
    """Meshes by kind: carriageway, square, pavement (with kerbs and garden paths), grass, and garden where nobody walks."""
    lines, carriage_field = _lines(streets, public, gardens)
    points, edges = [], []
    for line in lines:
        first = len(points)
        points.extend(map(tuple, line))
        edges.extend((first + i, first + i + 1) for i in range(len(line) - 1))
    points.extend(map(tuple, _scattered(public, rng)))
    verts, _, faces, *_ = geometry.delaunay_2d_cdt([Vector(p) for p in points], edges, [], 0, 1e-4)
    xy = np.array([tuple(v) for v in verts])
    tri = np.array([tuple(f) for f in faces])
    middle = xy[tri].mean(axis=1)
    a, b, c = xy[tri[:, 0]], xy[tri[:, 1]], xy[tri[:, 2]]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    tri = np.where((area < 0)[:, None], tri[:, ::-1], tri)
    kinds = _classify(middle, streets, public, gardens)
    kinds[np.abs(area) < 1e-5] = "none"
    meshes = {}
    for kind in ("carriageway", "square", "pavement", "grass", "garden", "kerb", "path"):
        mesh = meshes.setdefault("pavement" if kind in ("kerb", "path") else kind, Mesh())
        chosen = tri[kinds == kind]
        height = plan.ground_height(xy[:, 0], xy[:, 1]) + (0.0 if kind in ("carriageway", "square") else plan.KERB_M)
        spots = [(p[0], p[1], z) for p, z in zip(xy.tolist(), height.tolist())]
        for t in chosen.tolist():
            corners = [spots[i] for i in t]
            mesh.face(MATERIAL[kind], corners, [(p[0], p[1]) for p in corners], TINT[kind])
    for line in contour(carriage_field.values, carriage_field.xs, carriage_field.ys, 0.0):
        _kerb(meshes["pavement"], _divided(simplify(line, 0.02), 2.2))
    return meshes


def _classify(middle, streets, public, gardens):
    d_public = public(middle)
    d_carriage = plan.carriage_distance(middle, streets)
    outside = plan.distance_to_polygon(middle, plan.WALL_RING)
    kinds = np.full(len(middle), "pavement", dtype=object)
    kinds[d_carriage < KERB_STONE_M] = "kerb"
    kinds[plan.grass_distance(middle) < 0] = "grass"
    carriage = d_carriage < 0
    kinds[carriage] = "carriageway"
    kinds[carriage & (plan.square_distance(middle) < 0)] = "square"
    behind = d_public > UNDER_WALLS_M
    kinds[behind] = "garden"
    walked = behind & (gardens.room(middle) > -UNDER_GARDEN_WALLS_M)
    kinds[walked] = "grass"
    kinds[walked & (gardens.path(middle) < 0)] = "path"
    kinds[outside > 13.0] = "none"
    return kinds


def _kerb(mesh, line):
    along = 0.0
    for a, b in zip(line[:-1], line[1:]):
        length = float(np.linalg.norm(b - a))
        if length < 1e-3:
            continue
        za, zb = float(plan.ground_height(*a)), float(plan.ground_height(*b))
        points = [(b[0], b[1], zb - 0.02), (a[0], a[1], za - 0.02), (a[0], a[1], za + plan.KERB_M),
                  (b[0], b[1], zb + plan.KERB_M)]
        mesh.face("stone", points, [(along + length, 0), (along, 0), (along, 0.1), (along + length, 0.1)], TINT["kerb"])
        along += length


def far_land(rng):
    """Meadows and wooded hills round the town, never walked on."""
    mesh = Mesh()
    radii = [74, 92, 104, 125, 160, 215, 290, 390, 520]
    count = 72
    waves = [(rng.uniform(0, 6.3), rng.randrange(2, 9), rng.uniform(0.4, 1.0)) for _ in range(6)]

    def height(r, t):
        x, y = r * math.cos(t), r * math.sin(t)
        base = float(plan.ground_height(x, y)) - 0.5
        hill = sum(w * math.sin(k * t + p + r * 0.004 * k) for p, k, w in waves) / 3 + 0.75
        return base + max(0.0, hill) * 46 * max(0.0, (r - 130) / 390) ** 1.3

    rings = [[(r * math.cos(2 * math.pi * i / count), r * math.sin(2 * math.pi * i / count),
               height(r, 2 * math.pi * i / count)) for i in range(count)] for r in radii]
    for k in range(len(radii) - 1):
        for i in range(count):
            j = (i + 1) % count
            points = [rings[k][i], rings[k + 1][i], rings[k + 1][j], rings[k][j]]
            far = k / (len(radii) - 2)
            color = (0.84 - 0.3 * far, 0.84 - 0.28 * far, 0.76 - 0.3 * far)
            mesh.face("grass", points, [(p[0] * 0.2, p[1] * 0.2) for p in points], color)
    for _ in range(260):
        t, r = rng.uniform(0, 2 * math.pi), rng.choice((rng.uniform(150, 200), rng.uniform(190, 330), rng.uniform(240, 450)))
        if math.sin(3 * t + r * 0.02) + math.sin(7 * t - r * 0.011) > -0.2:
            _copse(mesh, (r * math.cos(t), r * math.sin(t), height(r, t)), rng.uniform(3.0, 5.0) * (0.8 + r / 220), rng)
    return mesh


BOUGHS = 0.16   # of the leaves' size: from afar one sees boughs, and leaves would be a grey noise


def _copse(mesh, center, radius, rng):
    """Distant trees: a few crowns that overlap, each a lumpy dome whose light turns softly, darker towards the ground."""
    green = shade(srgb("9fa465"), rng.uniform(0.75, 1.0))
    own = random.Random(rng.uniform(0, 6))
    for k in range(own.choice((2, 3, 3))):
        turn = own.uniform(0, 2 * math.pi)
        away = 0.0 if k == 0 else radius * own.uniform(0.5, 0.8)
        x, y = center[0] + away * math.cos(turn), center[1] + away * math.sin(turn)
        _crown(mesh, (x, y, center[2]), radius * own.uniform(0.55, 0.8), shade(green, own.uniform(0.85, 1.1)), own)


def _crown(mesh, center, radius, color, rng):
    sides, bands = 7, ((0.8, -0.2, 0.7), (1.12, 0.5, 0.88), (0.78, 1.25, 1.02), (0.0, 1.62, 1.12))
    rings = []
    for width, height, light in bands:
        ring = []
        for i in range(sides):
            t, r = 2 * math.pi * (i + rng.uniform(-0.2, 0.2)) / sides, radius * width * rng.uniform(0.76, 1.2)
            d = (r * math.cos(t), r * math.sin(t), radius * (height + (rng.uniform(-0.18, 0.18) if 0 < height else 0.0)))
            ring.append((tuple(center[m] + d[m] for m in range(3)), (d[0], d[1], d[2] - 0.3 * radius)))
        rings.append((ring, light))
    for (low, dark), (high, bright) in zip(rings, rings[1:]):
        for i in range(sides):
            j = (i + 1) % sides
            corners = [low[i], low[j], high[j], high[i]] if high is not rings[-1][0] else [low[i], low[j], high[0]]
            girth = 2 * math.pi * radius / sides
            left, right, up = i * girth * BOUGHS, (i + 1) * girth * BOUGHS, radius * BOUGHS
            uvs = [(left, 0), (right, 0), (right, up), (left, up)][:len(corners)]
            mesh.face("leaves", [p for p, _ in corners], uvs, shade(color, (dark + bright) / 2), [n for _, n in corners])
