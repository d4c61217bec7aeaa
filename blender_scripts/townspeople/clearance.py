"""Keeps an outer garment outside of what lies beneath it, at rest and in the sampled poses of
the clips.
"""

import numpy as np
from mathutils import Vector

from townspeople import skeleton as sk
from townspeople import surface as sf

SEARCH_M = 0.12  # penetrations deeper than this are taken for something else
ROUNDS_AT_REST = 3
SMOOTHINGS = 8


def pushed_out(points, tree, gap_m, search_m=SEARCH_M):
    """Points moved out of the tree's surface until `gap_m` in front of it."""
    result = points.copy()
    for _ in range(ROUNDS_AT_REST):
        for i, point in enumerate(result):
            location, normal, _, distance = tree.find_nearest(Vector(point), search_m)
            if location is None:
                continue
            height = (Vector(point) - location).dot(normal)
            if height < gap_m and (height < 0 or distance < gap_m):
                result[i] = point + np.array(normal) * (gap_m - height) * 0.8
    return result


def drawn_in(points, tree, gap_m, search_m=0.04):
    """Points moved behind the tree's surface until `gap_m` beneath it."""
    result = points.copy()
    for i, point in enumerate(result):
        location, normal, _, _ = tree.find_nearest(Vector(point), search_m)
        if location is not None:
            height = (Vector(point) - location).dot(normal)
            result[i] = point - np.array(normal) * max(height + gap_m, 0.0)
    return result


def _needs(points, outward, tree, gap_m):
    """How far each point would have to move outwards (0: stays)."""
    needs = np.zeros(len(points))
    for i, (point, way) in enumerate(zip(map(Vector, points.tolist()), outward.tolist())):
        location, normal, _, _ = tree.find_nearest(point, SEARCH_M)
        if location is None or normal.dot(Vector(way)) < 0.25:
            continue
        needs[i] = max(gap_m - (point - location).dot(normal), 0.0)
    return needs


def _spread(needs, closed):
    """Neighbours move along, so that no dents show: the largest need near by, then smoothed."""

    def shifted(values, axis, step):
        moved = np.roll(values, step, axis)
        if axis == 0 or not closed:
            edge = [slice(None), slice(None)]
            edge[axis] = 0 if step > 0 else -1
            moved[tuple(edge)] = values[tuple(edge)]
        return moved

    around = [shifted(needs, axis, step) for axis in (0, 1) for step in (-1, 1)]
    needs = np.maximum.reduce([needs] + around)
    for _ in range(SMOOTHINGS):
        around = [shifted(needs, axis, step) for axis in (0, 1) for step in (-1, 1)]
        needs = 0.4 * needs + 0.15 * sum(around)
    return needs


def cleared(points, weights, outward, inner, poses, gap_m, limit_m, closed=True):
    """A grid of points (rows, columns, 3) pushed `outward` until no pose shows what is in `inner`.

    poses: list of (joints, 4, 4) skinning matrices.
    """
    shape = points.shape[:2]
    flat, ways = points.reshape(-1, 3), outward.reshape(-1, 3)
    flat_weights = sk.at_most_four(weights.reshape(-1, weights.shape[-1]))
    needs = np.zeros(len(flat))
    for matrices in poses:
        posed = sf.with_parts(inner, vertices=sk.skinned(inner.vertices, inner.weights, matrices))
        turned = matrices.copy()
        turned[:, :3, 3] = 0.0
        needs = np.maximum(
            needs,
            _needs(
                sk.skinned(flat, flat_weights, matrices),
                sk.skinned(ways, flat_weights, turned),
                sf.tree_of([posed]),
                gap_m,
            ),
        )
    needs = np.minimum(_spread(needs.reshape(shape), closed), limit_m)
    return points + outward * needs[..., None]
