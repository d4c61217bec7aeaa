"""Joints, poses and skinning with world-axis rotations.

A pose is one rotation a joint, in the world axes of the rest pose ("global" rotations: 3x3
matrices that turn the rest pose's joint into the posed one), and the position of the root's head.
So bone rolls never matter until the very end, when Blender wants each rotation in its bone's own
axes.
"""

from dataclasses import dataclass

import numpy as np

# Joints that are exported; every other bone of the source rig hands its weights to the nearest of
# these above it. Finger bones of one rank move together.
KEPT = ["root", "spine05", "spine03", "spine01", "neck01", "head"] + [
    name + side
    for side in ("_L", "_R")
    for name in (
        "clavicle",
        "shoulder02",
        "upperarm02",
        "lowerarm01",
        "lowerarm02",
        "wrist",
        "finger1-1",
        "finger3-1",
        "finger3-2",
        "upperleg02",
        "lowerleg01",
        "foot",
    )
]


@dataclass
class Skeleton:
    names: list  # parents come before their children; names[0] is the root
    parents: list  # index of each joint's parent, -1 for the root
    heads: np.ndarray  # (joints, 3)

    def index(self, name):
        return self.names.index(name)

    def head(self, name):
        return self.heads[self.names.index(name)]


def of_joints(joints):
    """joints: (name, parent's name or "", head) of each."""
    names = [name for name, _, _ in joints]
    parents = [names.index(parent) if parent else -1 for _, parent, _ in joints]
    return Skeleton(names, parents, np.array([head for _, _, head in joints], float))


def rotation(axis, degrees):
    """Rotation matrix about a world axis ("x", "y" or "z"), right-handed."""
    angle = np.radians(degrees)
    c, s = np.cos(angle), np.sin(angle)
    if axis == "x":
        return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    if axis == "y":
        return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def global_from_local(skeleton, local):
    """Global rotations of a pose given as {joint name: rotation relative to its parent}."""
    result = np.empty((len(skeleton.names), 3, 3))
    for i, name in enumerate(skeleton.names):
        own = local.get(name, np.eye(3))
        result[i] = own if skeleton.parents[i] < 0 else result[skeleton.parents[i]] @ own
    return result


def local_from_global(skeleton, rotations):
    result = rotations.copy()
    for i, parent in enumerate(skeleton.parents):
        if parent >= 0:
            result[i] = rotations[parent].T @ rotations[i]
    return result


def transforms(skeleton, rotations, root_head):
    """(joints, 4, 4) matrices that carry rest-pose points into the pose."""
    result = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
    for i, parent in enumerate(skeleton.parents):
        rest = skeleton.heads[i]
        posed = root_head if parent < 0 else result[parent][:3, :3] @ rest + result[parent][:3, 3]
        result[i][:3, :3] = rotations[i]
        result[i][:3, 3] = posed - rotations[i] @ rest
    return result


def cross(a, b):
    """Of two vectors: np.cross takes ten times as long over them."""
    (a, b, c), (x, y, z) = a, b
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


def head_in_pose(skeleton, rotations, root_head, joint):
    """Where a joint's head is in a pose: what `transforms` says, without all other joints."""
    parent = skeleton.parents[joint]
    if parent < 0:
        return root_head
    own = rotations[parent]
    moved = head_in_pose(skeleton, rotations, root_head, parent) - own @ skeleton.heads[parent]
    return own @ skeleton.heads[joint] + moved


def skinned(vertices, weights, matrices):
    """Linear blend skinning of (n, 3) points."""
    blended = np.tensordot(weights, matrices, axes=(1, 0))
    return np.einsum("nij,nj->ni", blended[:, :3, :3], vertices) + blended[:, :3, 3]


def orthonormal(matrix):
    """The rotation nearest to a 3x3 matrix."""
    u, _, v = np.linalg.svd(matrix)
    return u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v


def at_most_four(weights):
    """Keeps each row's four heaviest weights, normalised."""
    smallest_kept = np.sort(weights, axis=1)[:, -4][:, None]
    kept = np.where(weights >= np.maximum(smallest_kept, 1e-4), weights, 0.0)
    order = np.argsort(-kept, axis=1)[:, 4:]  # ties at the fourth place
    np.put_along_axis(kept, order, 0.0, axis=1)
    return kept / kept.sum(axis=1, keepdims=True)
