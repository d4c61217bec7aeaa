"""The town wall with its towers and gates, garden walls and the low wall of the churchyard."""

import math

import numpy as np

import plan
from framing import tone
from masonry import LIMESTONE, SANDSTONE, SLATE, arched_wall, pyramid
from mesh import Frame, Mesh, beam, box, lathe, panel, shade, srgb
from openings import window

HEIGHT, THICK = 5.6, 1.1
GATE_WIDTH, GATE_DEPTH, GATE_OPENING = 9.6, 6.5, 4.8
WALL_COLOR = srgb("d9ccb4")
BEVEL_M = 0.09   # below a coping: a level underside would be a dark line thinner than a pixel, and look dashed


def outward(index):
    """Unit vector along the street through a gate, out of the town."""
    ring = plan.WALL_RING
    a, b = np.array(ring[index - 1]), np.array(ring[(index + 1) % len(ring)])
    along = (b - a) / np.linalg.norm(b - a)
    return np.array([along[1], -along[0]])


def gate_axis(index, streets):
    """Where a gate's street crosses the ring, and the street's direction out of the town."""
    spot = np.array(plan.WALL_RING[index])
    best = None
    for street in streets:
        d = np.linalg.norm(street.axis - spot, axis=1)
        k = int(np.argmin(d))
        if best is None or d[k] < best[0]:
            way = street.axis[min(k + 1, len(street.axis) - 1)] - street.axis[k - 1]
            best = (d[k], street.axis[k], way / np.linalg.norm(way))
    _, point, way = best
    return point, way if way @ outward(index) > 0 else -way


def make_gate(index, streets, rng):
    """A gate tower across its street; returns the mesh, the exit's place and the way into the town."""
    point, way = gate_axis(index, streets)
    mesh = Mesh()
    w, d, top = GATE_WIDTH, GATE_DEPTH, 9.5
    opening = [(w / 2, GATE_OPENING, 3.2, 1.9)]
    front = Frame((-w / 2, -d / 2, 0), (1, 0, 0))          # faces the town
    back = Frame((w / 2, d / 2, 0), (-1, 0, 0))
    for wall in (front, back):
        arched_wall(mesh, wall, opening, w, top, 0.9, SANDSTONE, rng, trim=LIMESTONE)
        for u in (2.2, w - 2.2):
            window(mesh, wall, u, 6.4, 0.8, 1.3, srgb("4a3a2c"), rng, base=0.02)
    for wall in (Frame((w / 2, -d / 2, 0), (0, 1, 0)), Frame((-w / 2, d / 2, 0), (0, -1, 0))):
        panel(mesh, "stone", wall, 0, d, -1.5, top, SANDSTONE, step=1.8)
    for x, u in ((-GATE_OPENING / 2, 1), (GATE_OPENING / 2, -1)):
        inner = Frame((x, -d / 2 + 0.9, 0), (0, 1, 0)) if u == 1 else Frame((x, d / 2 - 0.9, 0), (0, -1, 0))
        panel(mesh, "stone", inner, 0, d - 1.8, -1.5, 5.3, shade(SANDSTONE, 0.95), step=1.4)
    panel(mesh, "planks", Frame((-GATE_OPENING / 2, d / 2 - 0.9, 5.3), (1, 0, 0), (0, -1, 0)), 0, GATE_OPENING, 0, d - 1.8,
          srgb("5c4632"), step=1.4)
    _gate_top(mesh, w, d, top, rng)
    z = float(plan.ground_height(*point))
    yaw = math.atan2(way[1], way[0]) - math.pi / 2          # local +y runs out of the town
    exit_at = point + way * (d / 2 + 0.6)
    return mesh.moved(point[0], point[1], z, yaw), exit_at, -way


def _gate_top(mesh, w, d, top, rng):
    """A framed storey and a hipped roof."""
    colors = {"plaster": srgb("efe2c4"), "timber": srgb("4a3122"), "frame": srgb("efeade"), "shift": 0.7}
    out, tall = 0.35, 2.6
    x, y = w / 2 + out, d / 2 + out
    corners = [(-x, -y), (x, -y), (x, y), (-x, y)]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        length = math.dist(a, b)
        wall = Frame((a[0], a[1], top), ((b[0] - a[0]) / length, (b[1] - a[1]) / length, 0))
        panel(mesh, "plaster", wall, 0, length, 0, tall, colors["plaster"])
        count = round(length / 1.3)
        for v in (0.11, 0.95, tall - 0.1):
            beam(mesh, wall, (0, v), (length, v), 0.2, 0.035, tone(colors["timber"], rng), rng)
        for i in range(count + 1):
            u = min(max(length * i / count, 0.09), length - 0.09)
            beam(mesh, wall, (u, 0.2), (u, tall - 0.2), 0.17, 0.03, tone(colors["timber"], rng), rng)
        for i in range(count):
            u0, u1 = length * i / count + 0.09, length * (i + 1) / count - 0.09
            if i % 3 == 1:
                window(mesh, wall, (u0 + u1) / 2, 1.05, min(0.8, u1 - u0), 1.1, colors["frame"], rng)
            elif i in (0, count - 1):
                beam(mesh, wall, (u0, 0.2), (u1, 0.9) if i else (u1, tall - 0.2), 0.13, 0.025, tone(colors["timber"], rng), rng)
    mesh.face("timber", [(p[0], p[1], top) for p in corners][::-1], [(p[0], p[1]) for p in corners], shade(colors["timber"], 0.8))
    eave = [(px * 1.09, py * 1.12, top + tall - 0.15) for px, py in corners]
    ridge = [(-(x - y) - 0.3, 0, top + tall + y * 1.9), ((x - y) + 0.3, 0, top + tall + y * 1.9)]
    tint = (0.85, 0.8, 0.78)
    slant = math.hypot(y, ridge[0][2] - eave[0][2])
    for a, b, tops in ((eave[0], eave[1], ridge[::-1]), (eave[1], eave[2], ridge[1:]), (eave[2], eave[3], ridge),
                       (eave[3], eave[0], ridge[:1])):
        length = math.dist(a, b)
        uvs = [(0, 0), (length, 0)] + ([(length - y, slant), (y, slant)] if len(tops) == 2 else [(length / 2, slant)])
        mesh.face("roof_tile", [a, b, *tops], uvs, tint)
        mesh.face("timber", [(a[0], a[1], a[2] - 0.15), (b[0], b[1], b[2] - 0.15), b, a],
                  [(0, 0), (length, 0), (length, 0.15), (0, 0.15)], colors["timber"])
    mesh.face("planks", [(p[0], p[1], p[2] - 0.15) for p in eave][::-1], [(p[0], p[1]) for p in eave], shade(colors["timber"], 0.9))
    for p in ridge:
        lathe(mesh, "iron", p, [(0.06, -0.1), (0.12, 0.35), (0.03, 0.6), (0.0, 1.3)], 6, (0.05, 0.045, 0.04))


def run_ends(index, streets):
    """Where a stretch of the town wall begins and ends: at corners of the ring, or beside a gate's tower."""
    ring = plan.WALL_RING
    nxt = (index + 1) % len(ring)
    ends = []
    for i, other in ((index, nxt), (nxt, index)):
        if i in plan.WALL_GATES:
            point, way = gate_axis(i, streets)
            side = np.array([-way[1], way[0]])
            toward = np.array(ring[other]) - point
            ends.append(point + side * math.copysign(GATE_WIDTH / 2 - 0.3, side @ toward))
        else:
            ends.append(np.array(ring[i], float))
    return ends


def make_wall_run(index, streets):
    """The town wall between two corners of the ring, shortened where a gate stands."""
    a, b = run_ends(index, streets)
    length = float(np.linalg.norm(b - a))
    way = (b - a) / length
    mesh = Mesh()
    z = float(min(plan.ground_height(*a), plan.ground_height(*b)))
    rise = float(max(plan.ground_height(*a), plan.ground_height(*b))) - z
    top = HEIGHT + rise
    # Local x runs along the wall with the town to the left.
    for wall, width in ((Frame((0, -THICK / 2, 0), (1, 0, 0)), length), (Frame((length, THICK / 2, 0), (-1, 0, 0)), length),
                        (Frame((0, THICK / 2, 0), (0, -1, 0)), THICK), (Frame((length, -THICK / 2, 0), (0, 1, 0)), THICK)):
        panel(mesh, "stone", wall, 0, width, -1.5, top, WALL_COLOR, step=3.0)
    panel(mesh, "stone", Frame((0, -THICK / 2, top), (1, 0, 0), (0, 1, 0)), 0, length, 0, THICK, WALL_COLOR, step=6)
    count = max(1, int(length / 2.3))
    for i in range(count):
        x = length * (i + 0.5) / count
        box(mesh, "stone", (x - 0.62, -THICK / 2, top), (x + 0.62, -THICK / 2 + 0.45, top + 0.95), WALL_COLOR, skip="z")
    return mesh.moved(a[0], a[1], z, math.atan2(way[1], way[0]))


def make_tower(index, rng):
    """A round tower with a conical roof on a corner of the ring."""
    x, y = plan.WALL_RING[index]
    z = float(plan.ground_height(x, y))
    mesh = Mesh()
    tall = rng.uniform(8.0, 10.0)
    profile = [(2.9, -1.5), (2.75, 2.0), (2.7, 5.0), (2.7, tall - 0.8), (2.95, tall - 0.4), (2.95, tall)]
    lathe(mesh, "stone", (0, 0, 0), profile, 14, WALL_COLOR, caps=False)
    ring = [(math.cos(2 * math.pi * k / 14) * 3.3, math.sin(2 * math.pi * k / 14) * 3.3, tall - 0.1) for k in range(14)]
    pyramid(mesh, "roof_tile", ring, (0, 0, tall + 5.2), (0.85, 0.78, 0.76), 3)
    mesh.face("planks", ring[::-1], [(p[0], p[1]) for p in ring], srgb("5c4632"))
    return mesh.moved(x, y, z)


def make_line_wall(line, height, thickness, color, near=0.05):
    """A mitred wall with a coping along a line, which lies `near` to its left; its top follows the ground."""
    mesh = Mesh()
    line = line[np.concatenate([[True], np.linalg.norm(np.diff(line, axis=0), axis=1) > 0.02])]
    low = [_offset(line, distance) for distance in (near, near + thickness)]
    cap = [_offset(line, distance) for distance in (near - 0.06, near + thickness + 0.06)]
    ground = [float(plan.pavement_height(*p)) for p in line]
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    for i in range(len(line) - 1):
        j, dark = i + 1, shade(color, 0.92)
        for side, (a, b) in ((0, (j, i)), (1, (i, j))):
            bottom, foot, eave, top = ((ground[a] + up, ground[b] + up) for up in (-1.2, height - BEVEL_M, height, height + 0.13))
            _strip(mesh, low[side][a], low[side][b], bottom, foot, (along[a], along[b]), color)
            bevel = [(*low[side][a], foot[0]), (*low[side][b], foot[1]), (*cap[side][b], eave[1]), (*cap[side][a], eave[0])]
            mesh.face("stone", bevel, [(along[a], 0), (along[b], 0), (along[b], BEVEL_M), (along[a], BEVEL_M)], color)
            _strip(mesh, cap[side][a], cap[side][b], eave, top, (along[a], along[b]), dark)
        points = [(*cap[side][k], ground[k] + height + 0.13) for side, k in ((1, i), (1, j), (0, j), (0, i))]
        width = thickness + 0.12
        mesh.face("stone", points, [(along[i], 0), (along[j], 0), (along[j], width), (along[i], width)], dark)
    for k, (p, q) in ((0, (0, 1)), (len(line) - 1, (1, 0))):
        _strip(mesh, low[p][k], low[q][k], (ground[k] - 1.2,) * 2, (ground[k] + height,) * 2, (0, thickness), color)
        _strip(mesh, cap[p][k], cap[q][k], (ground[k] + height,) * 2, (ground[k] + height + 0.13,) * 2, (0, thickness), color)
    return mesh


def _offset(line, distance):
    """The line moved to its right, with mitred corners."""
    way = np.diff(line, axis=0)
    way /= np.linalg.norm(way, axis=1)[:, None]
    right = np.stack([way[:, 1], -way[:, 0]], axis=1)
    before, after = np.vstack([right[:1], right]), np.vstack([right, right[-1:]])
    both = before + after
    both /= np.maximum(0.5, np.sum(both * after, axis=1))[:, None]
    return (line + distance * both).tolist()


def _strip(mesh, a, b, low, high, along, color):
    """An upright quadrilateral, from a to b seen from outside, cut into cells for the baked light."""
    columns = max(1, math.ceil(math.dist(a, b) / 1.6))
    rows = max(1, math.ceil((high[0] - low[0]) / 1.6))

    def spot(i, k):
        s, t = i / columns, k / rows
        z = (low[0] + (low[1] - low[0]) * s) * (1 - t) + (high[0] + (high[1] - high[0]) * s) * t
        return (a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s, z), (along[0] + (along[1] - along[0]) * s, z)

    for i in range(columns):
        for k in range(rows):
            corners = [spot(i, k), spot(i + 1, k), spot(i + 1, k + 1), spot(i, k + 1)]
            uvs = [c[1] for c in corners]
            if along[1] < along[0]:
                uvs = [(-u, v) for u, v in uvs]
            mesh.face("stone", [c[0] for c in corners], uvs, color)


def opened_wall(pieces, ends, height, color):
    """A garden wall with ways through it: what is left of it, and a post at each end."""
    mesh = Mesh()
    for piece in pieces:
        mesh.add(make_line_wall(piece, height, 0.4, color))
    for x, y, yaw in ends:
        mesh.add(_post(2.0).moved(x, y, float(plan.pavement_height(x, y)), yaw))
    return mesh


def _post(height):
    """A square gate post with a cap."""
    mesh = Mesh()
    box(mesh, "stone", (-0.32, -0.32, -0.5), (0.32, 0.32, height), LIMESTONE, skip="z")
    ring = [(-0.4, -0.4, height), (0.4, -0.4, height), (0.4, 0.4, height), (-0.4, 0.4, height)]
    pyramid(mesh, "stone", ring, (0, 0, height + 0.35), SLATE, 1)
    mesh.face("stone", ring[::-1], [(0, 0), (1, 0), (1, 1), (0, 1)], LIMESTONE)
    return mesh


def churchyard_wall():
    """The low wall between the church's plaza and its lawn, open before the portal and the paths."""
    mesh = Mesh()
    x = 30.9
    for y0, y1 in ((12.6, 20.4), (23.2, 26.2), (36.8, 39.6), (42.8, 49.4)):
        mesh.add(make_line_wall(np.array([(x, y0), (x, y1)]), 0.85, 0.45, srgb("d5c8b0")))
    for y in (20.4, 23.2, 26.2, 36.8, 39.6, 42.8):
        mesh.add(_post(1.25).moved(x + 0.25, y, float(plan.pavement_height(x, y))))
    return mesh
