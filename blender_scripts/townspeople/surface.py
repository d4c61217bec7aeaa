"""A polygon surface as plain arrays, and the few operations that everything else is made of.

Axes: x to the person's left, -y forward, z up; metres. Weights have one column a joint.
"""

import itertools
from dataclasses import dataclass, field

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree


@dataclass
class Surface:
    """Polygons over shared vertices; corner_uv runs parallel to the corners of `faces`."""

    vertices: np.ndarray  # (n, 3)
    faces: list  # of tuples of vertex indices, anticlockwise from outside
    weights: np.ndarray  # (n, joints), rows sum to 1
    corner_uv: np.ndarray  # (corners, 2); u around, v from 0 (top) to 1 (bottom)
    cells: list  # the texture cell of each face
    shade: np.ndarray = field(
        default=None
    )  # (n,), baked ambient light, 1 where nothing hides the sky


def with_parts(surface, **changes):
    """A copy with some members replaced."""
    members = dict(
        vertices=surface.vertices,
        faces=surface.faces,
        weights=surface.weights,
        corner_uv=surface.corner_uv,
        cells=surface.cells,
        shade=surface.shade,
    )
    members.update(changes)
    return Surface(**members)


def corner_starts(faces):
    """Index of the first corner of each face."""
    return np.concatenate([[0], np.cumsum([len(face) for face in faces])]).astype(int)


def corners_of(faces):
    """The vertex of each corner of all faces, and its face."""
    sizes = [len(face) for face in faces]
    vertices = np.fromiter(itertools.chain.from_iterable(faces), int, sum(sizes))
    return vertices, np.repeat(np.arange(len(faces)), sizes)


def _sums(groups, rows, count):
    """Sums of the rows of each of `count` groups."""
    return np.stack([np.bincount(groups, column, count) for column in rows.T], axis=1)


def face_means(values, faces):
    """The mean over each face's corners of what its vertices have (a number or a row each)."""
    corners, face_of_corner = corners_of(faces)
    rows = values[corners].reshape(len(corners), -1)
    sizes = np.bincount(face_of_corner, minlength=len(faces))
    means = _sums(face_of_corner, rows, len(faces)) / sizes[:, None]
    return means.reshape(len(faces), *values.shape[1:])


def face_least(values, faces):
    """The least of what each face's vertices have; of truths: whether all are true."""
    return np.minimum.reduceat(values[corners_of(faces)[0]], corner_starts(faces)[:-1])


def keep_faces(surface, keep):
    """The part whose face flags are true, without loose vertices."""
    starts = corner_starts(surface.faces)
    kept = [index for index, flag in enumerate(keep) if flag]
    faces = [surface.faces[index] for index in kept]
    corners = np.repeat(np.asarray(keep, bool), np.diff(starts))
    used = np.unique(corners_of(faces)[0])
    renumber = np.full(len(surface.vertices), -1)
    renumber[used] = np.arange(len(used))
    renumber = renumber.tolist()
    return with_parts(
        surface,
        vertices=surface.vertices[used],
        weights=surface.weights[used],
        faces=[tuple([renumber[v] for v in face]) for face in faces],
        corner_uv=surface.corner_uv[corners],
        cells=[surface.cells[index] for index in kept],
        shade=None if surface.shade is None else surface.shade[used],
    )


def face_centres(surface):
    return face_means(surface.vertices, surface.faces)


def triangle_count(surface):
    return sum(len(face) - 2 for face in surface.faces)


def vertex_normals(surface):
    """Area-weighted unit normals (Newell's sum of cross products)."""
    corners, face_of_corner = corners_of(surface.faces)
    starts = corner_starts(surface.faces)
    after = np.arange(len(corners)) + 1
    after[starts[1:] - 1] = starts[:-1]
    points = surface.vertices[corners]
    normal = _sums(face_of_corner, np.cross(points, points[after]), len(surface.faces))
    normals = _sums(corners, normal[face_of_corner], len(surface.vertices))
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.maximum(lengths, 1e-12)


def neighbour_lists(surface):
    neighbours = [set() for _ in surface.vertices]
    for face in surface.faces:
        for a, b in zip(face, face[1:] + face[:1]):
            neighbours[a].add(b)
            neighbours[b].add(a)
    return neighbours


def boundary_loops(surface):
    """Closed chains of vertex indices along edges with one face, longest first."""
    half_edges = {}
    for face in surface.faces:
        for a, b in zip(face, face[1:] + face[:1]):
            half_edges[(a, b)] = True
    follow = {b: a for a, b in half_edges if (b, a) not in half_edges}
    loops = []
    while follow:
        start = min(follow)
        loop, current = [start], follow.pop(start)
        while current != start and current in follow:
            loop.append(current)
            current = follow.pop(current)
        loops.append(loop)
    return sorted(loops, key=len, reverse=True)


def smoothed(surface, rounds, hold_boundary=True):
    """Laplacian smoothing of positions (not of weights)."""
    points = surface.vertices.copy()
    lists = neighbour_lists(surface)
    held = {v for loop in boundary_loops(surface) for v in loop} if hold_boundary else set()
    rows = np.concatenate([np.full(len(near), v) for v, near in enumerate(lists)]).astype(int)
    columns = np.concatenate([sorted(near) for near in lists]).astype(int)
    counts = np.maximum(np.bincount(rows, minlength=len(points)), 1)[:, None]
    free = np.array([v not in held for v in range(len(points))])[:, None]
    for _ in range(rounds):
        sums = np.zeros_like(points)
        np.add.at(sums, rows, points[columns])
        points = np.where(free, 0.5 * points + 0.5 * sums / counts, points)
    return with_parts(surface, vertices=points)


def refined(surface, chosen, roundness=0.75):
    """The chosen faces cut into four each, their new corners raised to where the surface's normals bend it (Phong tessellation,
    Boubekeur and Alexa 2008); faces beside them only get the corners.
    """
    normals, points = vertex_normals(surface), surface.vertices
    edges, added, weights = {}, [], []

    def corner(of):
        """Number of the new vertex amid these, raised by what their tangent planes say."""
        middle = points[of].mean(axis=0)
        over = ((middle - points[of]) * normals[of]).sum(axis=1, keepdims=True) * normals[of]
        added.append(middle - roundness * over.mean(axis=0))
        weights.append(surface.weights[of].mean(axis=0))
        return len(points) + len(added) - 1

    for face, cut in zip(surface.faces, chosen):
        for edge in zip(face, face[1:] + face[:1]) if cut else ():
            if tuple(sorted(edge)) not in edges:
                edges[tuple(sorted(edge))] = corner(list(edge))
    starts, faces, uvs, cells = corner_starts(surface.faces), [], [], []
    for face, cut, start, cell in zip(surface.faces, chosen, starts, surface.cells):
        uv = surface.corner_uv[start:start + len(face)]
        middles = [edges.get(tuple(sorted(edge))) for edge in zip(face, face[1:] + face[:1])]
        halves = 0.5 * (uv + np.roll(uv, -1, axis=0))
        if cut:
            centre = corner(list(face))
            for k in range(len(face)):
                faces.append((face[k], middles[k], centre, middles[k - 1]))
                uvs += [uv[k], halves[k], uv.mean(axis=0), halves[k - 1]]
                cells.append(cell)
            continue
        ring = [(v, t) for k in range(len(face)) for v, t in ((face[k], uv[k]), (middles[k], halves[k])) if v is not None]
        faces.append(tuple(v for v, _ in ring))
        uvs += [t for _, t in ring]
        cells.append(cell)
    return with_parts(surface, vertices=np.concatenate([points, added]), faces=faces, corner_uv=np.array(uvs), cells=cells,
                      weights=np.concatenate([surface.weights, weights]))


def offset(surface, distance_m):
    """Every vertex moved along its normal; `distance_m` a number or one a vertex."""
    distance = np.broadcast_to(np.asarray(distance_m, float), (len(surface.vertices),))
    return with_parts(
        surface, vertices=surface.vertices + vertex_normals(surface) * distance[:, None]
    )


def joined(surfaces):
    """One surface of several."""
    start, faces = 0, []
    for part in surfaces:
        faces += [tuple([v + start for v in face]) for face in part.faces] if start else part.faces
        start += len(part.vertices)
    return with_parts(
        surfaces[0],
        faces=faces,
        vertices=np.concatenate([part.vertices for part in surfaces]),
        weights=np.concatenate([part.weights for part in surfaces]),
        corner_uv=np.concatenate([part.corner_uv for part in surfaces]),
        cells=[cell for part in surfaces for cell in part.cells],
        shade=(
            None
            if any(part.shade is None for part in surfaces)
            else np.concatenate([part.shade for part in surfaces])
        ),
    )


def smoothstep(low, high, value):
    t = np.clip((np.asarray(value, float) - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def normalised(weights):
    return weights / np.maximum(weights.sum(axis=1, keepdims=True), 1e-12)


def nearest_weights(points, source_vertices, source_weights, count=6):
    """Weights of the nearest source vertices, blended by inverse squared distance."""
    count = min(count, len(source_vertices))
    result = np.empty((len(points), source_weights.shape[1]))
    for start in range(0, len(points), 512):
        part = points[start : start + 512]
        squares = ((part[:, None, :] - source_vertices[None]) ** 2).sum(axis=2)
        near = np.argpartition(squares, count - 1, axis=1)[:, :count]
        share = 1.0 / (np.take_along_axis(squares, near, axis=1) + 1e-6)
        result[start : start + 512] = (source_weights[near] * share[..., None]).sum(axis=1)
    return normalised(result)


def hull_radii(points_xy, angles):
    """Distance from the origin to the convex hull of the points in each direction.

    Angle 0 looks forward (-y), a quarter turn looks to the left (+x).
    """
    fine = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
    directions = np.stack([np.sin(fine), -np.cos(fine)], axis=1)
    support = np.maximum((points_xy @ directions.T).max(axis=0), 1e-3)
    cosines = np.cos(angles[:, None] - fine[None])
    ratio = np.where(cosines > 0.05, support[None] / np.maximum(cosines, 0.05), np.inf)
    return ratio.min(axis=1)


def tree_of(surfaces):
    """A BVHTree over several surfaces, for rays."""
    whole = joined(surfaces) if len(surfaces) > 1 else surfaces[0]
    return BVHTree.FromPolygons(whole.vertices.tolist(), whole.faces)


def outermost(tree, centre, direction, reach_m=2.0):
    """Distance from `centre` to the outermost surface in a direction, or None."""
    start = Vector(centre) + Vector(direction) * reach_m
    hit = tree.ray_cast(start, -Vector(direction), reach_m)
    return None if hit[0] is None else reach_m - hit[3]


def grid(points, weights, cell, u_columns, v_rows=None, closed=True, pole=False):
    """A quad grid of `points` (rows, columns, 3), `weights` (rows, columns, joints).

    Rows run top to bottom, columns anticlockwise seen from above, so that the faces look outward.
    `closed` joins the last column to the first; `pole` makes the first row one point.
    """
    rows, columns = points.shape[:2]
    v_rows = np.linspace(0.0, 1.0, rows) if v_rows is None else np.asarray(v_rows)
    faces, corner_uv = [], []
    for r in range(rows - 1):
        for c in range(columns if closed else columns - 1):
            d = (c + 1) % columns
            corners = [(r, c), (r + 1, c), (r + 1, d), (r, d)]
            if pole and r == 0:
                corners = [(0, 0)] + corners[1:3]
            faces.append(tuple(i * columns + j for i, j in corners))
            corner_uv += [
                (u_columns[c] if i == 0 and pole else u_columns[j], v_rows[i]) for i, j in corners
            ]
    surface = Surface(
        points.reshape(-1, 3),
        faces,
        weights.reshape(rows * columns, -1),
        np.array(corner_uv),
        [cell] * len(faces),
    )
    return keep_faces(surface, [True] * len(faces)) if pole else surface


def mirrored_u(angles):
    """Texture u of directions about the body: 0 in front, 1 behind, the same on both sides."""
    return np.abs(np.mod(np.asarray(angles) + np.pi, 2.0 * np.pi) - np.pi) / np.pi


def lined(surface, columns, rows, closed, thickness_m, cell):
    """A grid with an inner layer and closed rims, so that it has two sides."""
    inner = offset(surface, -thickness_m)
    flipped = with_parts(
        inner,
        faces=[face[:1] + face[:0:-1] for face in inner.faces],
        cells=[cell] * len(inner.faces),
        corner_uv=_reversed_corners(inner),
    )
    both = joined([surface, flipped])
    count = rows * columns
    rim = [[(rows - 1) * columns + c for c in range(columns)]]
    if not closed:
        rim[0] = (
            [r * columns for r in range(rows)]
            + rim[0][1:]
            + [r * columns + columns - 1 for r in range(rows - 2, -1, -1)]
        )
    faces, corner_uv = list(both.faces), [both.corner_uv]
    for a, b in zip(rim[0], rim[0][1:] + (rim[0][:1] if closed else [])):
        faces.append((a, a + count, b + count, b))
        corner_uv.append(np.array([(0.5, 0.97)] * 4))
    added = len(faces) - len(both.faces)
    return with_parts(
        both, faces=faces, corner_uv=np.concatenate(corner_uv), cells=both.cells + [cell] * added
    )


def _reversed_corners(surface):
    """Texture coordinates of the faces turned over about their first corner (the same diagonals
    stay).
    """
    starts = corner_starts(surface.faces)
    order = np.concatenate(
        [
            np.append(starts[i], np.arange(starts[i + 1] - 1, starts[i], -1))
            for i in range(len(surface.faces))
        ]
    )
    return surface.corner_uv[order]
