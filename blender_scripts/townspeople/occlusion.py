"""Ambient occlusion a vertex, by rays over the hemisphere, with the ground as an occluder."""

import numpy as np
from mathutils import Vector

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
    hidden = np.zeros(len(surface.vertices))
    local = _hemisphere(RAYS)
    for v, start in enumerate(surface.vertices + normals * LIFT_M):
        rays = (
            local[:, :1] * tangents[v] + local[:, 1:2] * bitangents[v] + local[:, 2:] * normals[v]
        )
        origin = Vector(start)
        for ray in rays:
            distance = tree.ray_cast(origin, Vector(ray), REACH_M)[3]
            if distance is None and ray[2] < -0.05:
                fall = max(start[2], 0.0) / -ray[2]
                distance = fall if fall < REACH_M else None
            if distance is not None:
                hidden[v] += 1.0 - 0.6 * distance / REACH_M
    open_share = 1.0 - hidden / RAYS
    shade = DARKEST + (1.0 - DARKEST) * sf.smoothstep(0.0, 0.9, open_share)
    for face, cell in zip(surface.faces, surface.cells):
        if cell in lightest_for:
            shade[list(face)] = np.maximum(shade[list(face)], lightest_for[cell])
    return sf.with_parts(surface, shade=shade)
