"""Ambient occlusion a vertex, by rays over the hemisphere, with the ground as an occluder."""

import numpy as np

from townspeople import surface as sf

RAYS = 28
REACH_M = 0.45  # what is farther away hides nothing
LIFT_M = 0.006  # rays start so far off the surface
DARKEST = 0.42


def _hemisphere(count):
    """Cosine-weighted directions about +z (a Fibonacci spiral)."""
    i = np.arange(count) + 0.5
    radius, angle = np.sqrt(i / count), i * np.pi * (3.0 - np.sqrt(5.0))
    return np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1.0 - i / count)], axis=1
    )


def _frames(normals):
    helper = np.where(np.abs(normals[:, 2:3]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    tangents = np.cross(helper, normals)
    tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-9)
    return tangents, np.cross(normals, tangents)


def with_shade(surface, lightest_for, beside=()):
    """The surface with `shade` filled in: DARKEST where everything is hidden, 1 in the open.

    lightest_for: {texture cell: least shade}, for parts that would look too dark. beside: other
    surfaces that hide something of this one.
    """
    tree = sf.tree_of([surface, *beside])
    normals = sf.vertex_normals(surface)
    tangents, bitangents = _frames(normals)
    local, starts, cast = _hemisphere(RAYS), surface.vertices + normals * LIFT_M, tree.ray_cast
    hits = []
    for part in np.split(np.arange(len(starts)), range(1024, len(starts), 1024)):
        frame = np.stack([tangents[part], bitangents[part], normals[part]], axis=1)[:, :, None]
        rays = local[:, :1] * frame[:, 0] + local[:, 1:2] * frame[:, 1] + local[:, 2:] * frame[:, 2]
        found = [[cast(start, ray, REACH_M)[3] for ray in own] for start, own in zip(starts[part].tolist(), rays.tolist())]
        distance = np.array(found, float)  # None becomes NaN
        with np.errstate(divide="ignore"):
            fall = np.where(rays[..., 2] < -0.05, np.maximum(starts[part, 2:], 0.0) / -rays[..., 2], np.inf)
        hits.append(np.where(np.isnan(distance), fall, distance))
    distance = np.concatenate(hits)
    hidden = np.where(distance <= REACH_M, 1.0 - 0.6 * distance / REACH_M, 0.0).sum(axis=1)
    open_share = 1.0 - hidden / RAYS
    shade = DARKEST + (1.0 - DARKEST) * sf.smoothstep(0.0, 0.9, open_share)
    corners, face_of_corner = sf.corners_of(surface.faces)
    least = np.array([lightest_for.get(cell, 0.0) for cell in surface.cells])
    np.maximum.at(shade, corners, least[face_of_corner])
    return sf.with_parts(surface, shade=shade)
