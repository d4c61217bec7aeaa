"""Polygons gathered in lists, and the small solids that the town is put together from.

A Mesh is a soup of flat polygons, anticlockwise seen from outside, with texture coordinates, a linear colour and a
material name each. Lengths in metres. Texture coordinates are metres divided by the size of the material's tile.
"""

import itertools
import math

import numpy as np

# How many metres one repetition of a material's texture spans.
TILE_M = {
    "plaster": 4.0, "timber": 1.6, "roof_tile": 3.2, "stone": 3.0, "cobble": 3.6, "paving": 4.0, "setts": 4.0,
    "grass": 5.0, "bark": 1.5, "leaves": 1.6, "twigs": 1.0, "glass": 0.72, "iron": 1.0, "planks": 1.2, "cloth": 1.0,
}


def srgb(text):
    """Linear RGB of a colour written as in a style sheet, such as '8a5a3c'."""
    values = [int(text[i:i + 2], 16) / 255 for i in (0, 2, 4)]
    return tuple(v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values)


def rows_of(tuples, count):
    """An array of tuples of `count` numbers each, twice as fast as np.array makes it."""
    return np.fromiter(itertools.chain.from_iterable(tuples), float, count * len(tuples)).reshape(-1, count)


def unique_rows(whole):
    """The first of each sort of rows of whole numbers, the sorts in order, and by row the number of its sort.

    np.unique with an axis finds the same, but compares rows as bytes.
    """
    number, sorts = np.zeros(len(whole), np.int64), 1
    for column in (whole - whole.min(axis=0, initial=0)).T:
        span = int(column.max(initial=0)) + 1
        if sorts * span >= 1 << 62:
            _, number = np.unique(number, return_inverse=True)
            sorts = int(number.max()) + 1
        number, sorts = number * span + column, sorts * span
    _, chosen, inverse = np.unique(number, return_index=True, return_inverse=True)
    return chosen, inverse


def shade(color, factor):
    """The colour times a factor, kept within what a vertex colour can hold."""
    return tuple(min(1.0, max(0.0, c * factor)) for c in color)


class Mesh:
    """A growing soup of polygons."""

    def __init__(self):
        self.points = []     # one (x, y, z) a corner
        self.uvs = []        # one (u, v) a corner
        self.sizes = []      # corners a polygon
        self.materials = []  # material name a polygon
        self.colors = []     # linear RGB a polygon
        self.normals = {}    # polygon index -> one normal a corner, where not flat
        self.turning = []    # (shared mesh's name, what it turns by, (x, y, z), yaw): parts of it that turn

    def face(self, material, points, uvs, color, normals=None):
        """One polygon; texture coordinates in metres."""
        tile = TILE_M[material]
        if normals is not None:
            self.normals[len(self.sizes)] = normals
        self.points.extend(points)
        self.uvs.extend((u / tile, v / tile) for u, v in uvs)
        self.sizes.append(len(points))
        self.materials.append(material)
        self.colors.append(color)

    def add(self, other):
        """All polygons of another mesh."""
        first = len(self.sizes)
        for index, normals in other.normals.items():
            self.normals[first + index] = normals
        self.points.extend(other.points)
        self.uvs.extend(other.uvs)
        self.sizes.extend(other.sizes)
        self.materials.extend(other.materials)
        self.colors.extend(other.colors)
        self.turning.extend(other.turning)

    def moved(self, x, y, z, yaw=0.0, shear_x=0.0, shear_y=0.0):
        """A copy, sheared by height, turned about z and moved; the shears are slopes (leaning walls)."""
        copy = Mesh()
        p = rows_of(self.points, 3)
        p[:, 0] += shear_x * p[:, 2]
        p[:, 1] += shear_y * p[:, 2]
        c, s = math.cos(yaw), math.sin(yaw)
        turned = np.stack([c * p[:, 0] - s * p[:, 1] + x, s * p[:, 0] + c * p[:, 1] + y, p[:, 2] + z], axis=1)
        copy.points = list(map(tuple, turned.tolist()))
        copy.uvs, copy.sizes = list(self.uvs), list(self.sizes)
        copy.materials, copy.colors = list(self.materials), list(self.colors)
        for index, normals in self.normals.items():
            copy.normals[index] = [(c * n[0] - s * n[1], s * n[0] + c * n[1], n[2]) for n in normals]
        copy.turning = [(name, by, (c * px - s * py + x, s * px + c * py + y, pz + z), own + yaw)
                        for name, by, (px, py, pz), own in self.turning]
        return copy

    def triangle_count(self):
        return sum(self.sizes) - 2 * len(self.sizes)


class Frame:
    """A wall plane: u to the right and v up seen from outside, n out of the wall."""

    def __init__(self, origin, u, v=(0.0, 0.0, 1.0)):
        self.o, self.u, self.v = origin, u, v
        self.n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])

    def at(self, a, b, out=0.0):
        o, u, v, n = self.o, self.u, self.v, self.n
        return (o[0] + a * u[0] + b * v[0] + out * n[0], o[1] + a * u[1] + b * v[1] + out * n[1],
                o[2] + a * u[2] + b * v[2] + out * n[2])

    def shifted(self, a, b, out=0.0):
        return Frame(self.at(a, b, out), self.u, self.v)


def front_frame(y=0.0, x=0.0, z=0.0):
    """The wall that faces -y."""
    return Frame((x, y, z), (1.0, 0.0, 0.0))


def ticks(start, end, step, extra=()):
    """Positions from start to end, about `step` apart, that contain all `extra` ones in between."""
    stops = sorted({start, end, *[e for e in extra if start + 1e-4 < e < end - 1e-4]})
    out = [start]
    for a, b in zip(stops, stops[1:]):
        count = max(1, math.ceil((b - a) / step - 0.25))
        out.extend(a + (b - a) * i / count for i in range(1, count + 1))
    return out


def panel(mesh, material, frame, u0, u1, v0, v1, color, holes=(), step=1.4, out=0.0, uv_shift=(0.0, 0.0),
          turned=False):
    """A wall rectangle, cut into cells for the baked light, without the holes (u0, u1, v0, v1).

    turned: the texture lies on its side (boards run along u).
    """
    us = ticks(u0, u1, step, [c for h in holes for c in h[:2]])
    vs = ticks(v0, v1, step, [c for h in holes for c in h[2:]])
    for a, b in zip(us, us[1:]):
        for c, d in zip(vs, vs[1:]):
            mu, mv = (a + b) / 2, (c + d) / 2
            if any(h[0] < mu < h[1] and h[2] < mv < h[3] for h in holes):
                continue
            corners = [(a, c), (b, c), (b, d), (a, d)]
            uvs = [(p + uv_shift[0], q + uv_shift[1]) for p, q in corners]
            mesh.face(material, [frame.at(p, q, out) for p, q in corners], [(v, u) for u, v in uvs] if turned else uvs, color)


def polygon(mesh, material, frame, corners, color, out=0.0, uv_shift=(0.0, 0.0)):
    """A flat polygon given in wall coordinates, anticlockwise seen from outside."""
    mesh.face(material, [frame.at(a, b, out) for a, b in corners],
              [(a + uv_shift[0], b + uv_shift[1]) for a, b in corners], color)


def _upright(uvs):
    return [(0.03 + 0.2 * (v - 0.03), u) for u, v in uvs]


def beam(mesh, frame, a, b, width, proud, color, rng, material="timber", ends=False, base=0.0, step=2.6,
         flanks=True):
    """A timber on a wall from a to b (wall coordinates of its axis): its face and flanks, no back.

    Flanks that only somebody above could see are left out where the wall itself stands above eye height.
    """
    du, dv = b[0] - a[0], b[1] - a[1]
    length = math.hypot(du, dv)
    if length < 0.02:
        return
    du, dv = du / length, dv / length
    su, sv = -dv * width / 2, du * width / 2
    shift, across, along = rng.random() * 7.0, rng.random() * 7.0, list
    if material == "planks":        # a single board: its grain runs along v, and no joint crosses it
        across, along = 0.03, _upright
    high_up = frame.o[2] > 2.0 and base == 0.0 and proud < 0.06
    pieces = max(1, math.ceil(length / step - 0.2))
    for i in range(pieces):
        s, e = length * i / pieces, length * (i + 1) / pieces
        p = (a[0] + du * s, a[1] + dv * s)
        q = (a[0] + du * e, a[1] + dv * e)
        low0, low1 = (p[0] - su, p[1] - sv), (q[0] - su, q[1] - sv)
        top0, top1 = (p[0] + su, p[1] + sv), (q[0] + su, q[1] + sv)
        f = frame.at
        grain0, grain1 = shift + s, shift + e
        mesh.face(material, [f(*low0, proud), f(*low1, proud), f(*top1, proud), f(*top0, proud)],
                  along([(grain0, across), (grain1, across), (grain1, across + width), (grain0, across + width)]), color)
        flank = along([(grain0, across), (grain1, across), (grain1, across + 0.04), (grain0, across + 0.04)])
        if flanks and not (high_up and du < -0.3):
            mesh.face(material, [f(*low0, base), f(*low1, base), f(*low1, proud), f(*low0, proud)], flank, color)
        if flanks and not (high_up and du > 0.3):
            mesh.face(material, [f(*top1, base), f(*top0, base), f(*top0, proud), f(*top1, proud)], flank, color)
    if ends:
        low, top = (a[0] - su, a[1] - sv), (a[0] + su, a[1] + sv)
        mesh.face(material, [f(*top, base), f(*low, base), f(*low, proud), f(*top, proud)],
                  [(0, 0), (width, 0), (width, proud), (0, proud)], color)
        low, top = (b[0] - su, b[1] - sv), (b[0] + su, b[1] + sv)
        mesh.face(material, [f(*low, base), f(*top, base), f(*top, proud), f(*low, proud)],
                  [(0, 0), (width, 0), (width, proud), (0, proud)], color)


def box(mesh, material, low, high, color, skip="", step=9.0, shift=0.0):
    """An axis-parallel box; `skip` names the sides to leave out: x X y Y z Z (capital: the upper one)."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    sides = {
        "y": (Frame((x0, y0, z0), (1, 0, 0)), x1 - x0, z1 - z0, x0, z0),
        "Y": (Frame((x1, y1, z0), (-1, 0, 0)), x1 - x0, z1 - z0, -x1, z0),
        "X": (Frame((x1, y0, z0), (0, 1, 0)), y1 - y0, z1 - z0, y0, z0),
        "x": (Frame((x0, y1, z0), (0, -1, 0)), y1 - y0, z1 - z0, -y1, z0),
        "Z": (Frame((x0, y0, z1), (1, 0, 0), (0, 1, 0)), x1 - x0, y1 - y0, x0, y0),
        "z": (Frame((x0, y1, z0), (1, 0, 0), (0, -1, 0)), x1 - x0, y1 - y0, x0, y0),
    }
    for name, (frame, width, height, su, sv) in sides.items():
        if name not in skip:
            panel(mesh, material, frame, 0, width, 0, height, color, step=step, uv_shift=(su + shift, sv + shift),
                  turned=material == "planks" and width > 1.5 * height)


def extrude(mesh, material, frame, corners, out0, out1, color, front=True, back=False, flanks=None):
    """A prism over a polygon given in wall coordinates; `flanks` picks the edges that get a side face."""
    if front:
        polygon(mesh, material, frame, corners, color, out1)
    if back:
        polygon(mesh, material, frame, corners[::-1], color, out0)
    count = len(corners)
    along = 0.0
    for i in range(count):
        a, b = corners[i], corners[(i + 1) % count]
        length = math.hypot(b[0] - a[0], b[1] - a[1])
        if flanks is None or i in flanks:
            mesh.face(material, [frame.at(*a, out0), frame.at(*b, out0), frame.at(*b, out1), frame.at(*a, out1)],
                      [(along, out0), (along + length, out0), (along + length, out1), (along, out1)], color)
        along += length


def _slope(low, high):
    """Outwards and upwards, the normal of a turned surface between two rings (radius, z)."""
    length = math.dist(low, high) or 1.0
    return (high[1] - low[1]) / length, (low[0] - high[0]) / length


def lathe(mesh, material, center, profile, sides, color, smooth=True, turn=0.0, caps=True, ball=False):
    """A turned solid: `profile` lists (radius, z) from below upwards, about the vertical through center.

    smooth: its light turns softly about the axis; ball: from ring to ring too.
    """
    cx, cy, cz = center
    ring = [(math.cos(turn + 2 * math.pi * i / sides), math.sin(turn + 2 * math.pi * i / sides)) for i in range(sides)]
    along = 0.0
    last = len(profile) - 1
    for k, ((r0, z0), (r1, z1)) in enumerate(zip(profile, profile[1:])):
        length = math.hypot(r1 - r0, z1 - z0)
        if length < 1e-6:
            continue
        slopes = (_slope(profile[k - 1 if ball and k > 0 else k], profile[k + 1]),
                  _slope(profile[k], profile[min(k + 2, last) if ball else k + 1]))
        for i in range(sides):
            c0, c1 = ring[i], ring[(i + 1) % sides]
            girth = 2 * math.pi * max(r0, r1) / sides
            points = [(cx + r0 * c0[0], cy + r0 * c0[1], cz + z0), (cx + r0 * c1[0], cy + r0 * c1[1], cz + z0),
                      (cx + r1 * c1[0], cy + r1 * c1[1], cz + z1), (cx + r1 * c0[0], cy + r1 * c0[1], cz + z1)]
            uvs = [(i * girth, along), ((i + 1) * girth, along), ((i + 1) * girth, along + length),
                   (i * girth, along + length)]
            normals = [(out * c[0], out * c[1], up) for c, (out, up) in
                       ((c0, slopes[0]), (c1, slopes[0]), (c1, slopes[1]), (c0, slopes[1]))]
            keep = [0, 1, 2, 3]
            if r1 < 1e-6:
                keep = [0, 1, 2]
            elif r0 < 1e-6:
                keep = [0, 2, 3]
            mesh.face(material, [points[k] for k in keep], [uvs[k] for k in keep], color,
                      [normals[k] for k in keep] if smooth else None)
        along += length
    for radius, z, order in ((profile[-1][0], profile[-1][1], 1), (profile[0][0], profile[0][1], -1)):
        if caps and radius > 1e-6 and (order == 1 or z > 1e-6):
            corners = [(cx + radius * c[0], cy + radius * c[1], cz + z) for c in ring][::order]
            mesh.face(material, corners, [(p[0] - cx, p[1] - cy) for p in corners], color)
