"""Ambient occlusion of every vertex by casting rays over its hemisphere, and the colours that come of it."""

import math
from itertools import repeat

import numpy as np
from mathutils.bvhtree import BVHTree

from mesh import rows_of, unique_rows

SMALL_PARTS = ("timber", "planks", "glass", "iron", "cloth", "leaves", "bark")
REACH_M = 6.0        # farther things darken nothing
DARKEST = 0.22
START_M = 0.03       # rays start this far off the surface
PULL = 0.06          # and this share of the way to the middle of the polygon


class Corners:
    """A mesh as arrays, one row a corner."""

    def __init__(self, mesh):
        self.points = rows_of(mesh.points, 3)
        self.sizes = np.array(mesh.sizes, int)
        self.first = np.concatenate([[0], np.cumsum(self.sizes)[:-1]]).astype(int)
        self.face = np.repeat(np.arange(len(self.sizes)), self.sizes)
        p = self.points
        nxt = np.arange(len(p)) + 1
        last = self.first + self.sizes - 1
        nxt[last] = self.first
        cross = np.cross(p - p[self.first][self.face], p[nxt] - p[self.first][self.face])
        normal = self._by_face(cross)
        length = np.linalg.norm(normal, axis=1)
        self.area = length / 2
        self.face_normal = normal / np.maximum(1e-12, length)[:, None]
        self.normals = self.face_normal[self.face].copy()
        for index, values in mesh.normals.items():
            f = self.first[index]
            n = np.array(values, float)
            self.normals[f:f + len(n)] = n / np.maximum(1e-9, np.linalg.norm(n, axis=1))[:, None]
        self.middle = self._by_face(p) / self.sizes[:, None]
        self.coarse = np.array([material in SMALL_PARTS for material in mesh.materials], bool)
        self.colors = rows_of(mesh.colors, 3)[self.face]

    def _by_face(self, values):
        """Sums over the corners of each polygon."""
        return np.stack([np.bincount(self.face, column, len(self.sizes)) for column in values.T], axis=1)


def make_tree(solids):
    """A search tree over several solids, each (points a corner, corners a polygon)."""
    points = np.concatenate([p for p, _ in solids])
    sizes = np.concatenate([sizes for _, sizes in solids])
    ends = np.cumsum(sizes)
    return BVHTree.FromPolygons(list(map(tuple, points.tolist())), list(map(range, (ends - sizes).tolist(), ends.tolist())))


def _hemisphere(count):
    """Cosine-weighted directions about +z (Fibonacci spiral)."""
    k = np.arange(count) + 0.5
    r = np.sqrt(k / count)
    t = k * math.pi * (3 - math.sqrt(5))
    return np.stack([r * np.cos(t), r * np.sin(t), np.sqrt(1 - k / count)], axis=1)


def _cells(part, coarse):
    """Corners that share one set of rays: the same place and normal, or, on small parts, nearly so."""
    cell = np.where(coarse[part.face], 0.22, 0.02)[:, None]
    key = np.round(np.concatenate([part.points / cell, part.normals * 5, coarse[part.face][:, None]], axis=1))
    return unique_rows(key.astype(np.int64))


def occlusion(part, tree, samples):
    """Open share of the sky dome at every corner, 0 to 1; corners inside other solids take their neighbours'.

    The corners of small parts share rays and have fewer of them.
    """
    chosen, inverse = _cells(part, part.coarse)
    light, buried = np.ones(len(chosen)), np.zeros(len(chosen), bool)
    few = part.coarse[part.face[chosen]]
    for rows, count in ((np.nonzero(few)[0], max(4, samples // 2)), (np.nonzero(~few)[0], samples)):
        for first in range(0, len(rows), 4096):
            some = rows[first:first + 4096]
            light[some], buried[some] = _cast(part, chosen[some], tree, count)
    return _fill(part, light[inverse], buried[inverse])


def _cast(part, corners, tree, samples):
    """Open share and whether it lies inside a solid, for some corners."""
    p, n = part.points[corners], part.normals[corners]
    start = p + n * START_M + (part.middle[part.face[corners]] - p) * PULL
    helper = np.where(np.abs(n[:, 2:3]) < 0.9, np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]]))
    t = np.cross(helper, n)
    t /= np.maximum(1e-9, np.linalg.norm(t, axis=1))[:, None]
    b = np.cross(n, t)
    dome = _hemisphere(samples)
    turn = np.abs(np.round(p * 50)) @ np.array([12.9898, 78.233, 37.719]) % (2 * math.pi)
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y = dome[:, 0] * c - dome[:, 1] * s, dome[:, 0] * s + dome[:, 1] * c
    ways = (x[..., None] * t[:, None] + y[..., None] * b[:, None] + dome[None, :, 2:3] * n[:, None]).tolist()
    light, buried = np.ones(len(p)), np.zeros(len(p), bool)
    cast, share, most = tree.ray_cast, 1.0 / REACH_M ** 2, 0.6 * samples
    for i, (origin, rays) in enumerate(zip(start.tolist(), ways)):
        found = list(map(cast, repeat(origin), rays, repeat(REACH_M)))
        squares = [distance * distance for _, _, _, distance in found if distance is not None]
        light[i] = 1 - (len(squares) - sum(squares) * share) / samples
        buried[i] = len(squares) > most and _is_inside(found, rays, most)
    return light, buried


def _is_inside(found, rays, most):
    """Whether more than `most` rays hit something from behind."""
    behind, others = 0, len(rays) - most
    for (_, normal, _, _), ray in zip(found, rays):
        if normal is not None and normal[0] * ray[0] + normal[1] * ray[1] + normal[2] * ray[2] > 0:
            behind += 1
            if behind > most:
                return True
        else:
            others -= 1
            if others <= 0:
                return False
    return False


def _fill(part, light, buried):
    """Corners inside other solids take the mean of the open corners of their polygon."""
    total = np.bincount(part.face, np.where(buried, 0, light), len(part.sizes))
    count = np.bincount(part.face, ~buried, len(part.sizes))
    mean = np.where(count > 0, total / np.maximum(count, 1), 0.3)
    return np.where(buried, mean[part.face] * 0.93, light)


def value_noise(x, y, z, cell):
    """Smooth noise from 0 to 1 in space."""
    p = np.stack([x, y, z], axis=-1) / cell
    base = np.floor(p).astype(np.int64)
    f = p - base
    f = f * f * (3 - 2 * f)
    total = np.zeros(p.shape[:-1])
    for dx in (0, 1):
        for dy in (0, 1):
            for dz in (0, 1):
                h = (base[..., 0] + dx) * 73856093 ^ (base[..., 1] + dy) * 19349663 ^ (base[..., 2] + dz) * 83492791
                h = (h ^ (h >> 13)) * 1274126177 & 0xFFFFFF
                w = (f[..., 0] if dx else 1 - f[..., 0]) * (f[..., 1] if dy else 1 - f[..., 1]) \
                    * (f[..., 2] if dz else 1 - f[..., 2])
                total += w * (h / float(0xFFFFFF))
    return total


def vertex_colors(part, light, weather):
    """Linear RGB of every corner: tint, times light (shadows a little warm), times large soft stains."""
    open_sky = DARKEST + (1 - DARKEST) * np.clip(light, 0, 1) ** 1.25
    warm = np.stack([open_sky ** 0.92, open_sky, open_sky ** 1.08], axis=1)
    p = part.points
    stain = 1.0
    if weather > 0:
        noise = 0.6 * value_noise(*p.T, 5.3) + 0.4 * value_noise(*(p + 100).T, 1.9)
        stain = (1 - weather + 2 * weather * noise)[:, None]
    return np.clip(part.colors * warm * stain, 0, 1)
