"""The MakeHuman figure of Debian's morse-simulator-data: loaded, stood upright, given its
proportions.
"""

import os
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from common.settings import fail
from townspeople import eyes
from townspeople import skeleton as sk
from townspeople.surface import Surface, nearest_weights, smoothstep, with_parts

HUMAN_RIG = "/usr/share/morse/data/robots/human_rig.blend"
ARMATURE = "HumanSkeleton"
WALK_FRAMES = range(9, 34)  # first and last are the same pose
WALK_FRAMES_PER_SECOND = 24.0
PARTS = {
    "body": "male1591",
    "shirt": "tshirt02",
    "trousers": "jeans01",
    "shoes": "classic_shoes_lres",
    "eyes": "eyes",
}
IMAGES = {
    "skin": "young_lightskinned_male_diffuse.png",
    "shoes": "classicshoes_texture_diffuse.png",
    "eye": "brown_eye.png",
}
TURN = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # the rig faces +x, people -y

# Points of the rig (turned) that garments are placed by, each with the joint that carries it.
LANDMARKS = {
    "sole": ((0.0, -0.09, -0.006), "root"),
    "ankle": ((0.0, -0.02, 0.075), "root"),
    "knee": ((0.0, -0.03, 0.496), "root"),
    "crotch": ((0.0, -0.01, 0.79), "root"),
    "hip": ((0.0, -0.01, 0.87), "root"),
    "waist": ((0.0, -0.01, 1.06), "spine03"),
    "chest": ((0.0, 0.0, 1.26), "spine01"),
    "shoulder": ((0.0, -0.015, 1.40), "spine01"),
    "neck": ((0.0, 0.0, 1.47), "neck01"),
    "chin": ((0.0, -0.13, 1.505), "head"),
    "mouth": ((0.0, -0.147, 1.53), "head"),
    "nose": ((0.0, -0.165, 1.565), "head"),
    "brow": ((0.0, -0.14, 1.62), "head"),
    "head": ((0.0, -0.05, 1.615), "head"),
    "crown": ((0.0, -0.04, 1.735), "head"),
}


@dataclass
class Figure:
    """A person without garments. Rest pose: upright, arms a little away from the body."""

    skeleton: sk.Skeleton
    parts: dict  # name in PARTS -> Surface
    walk: np.ndarray  # (frames, joints, 3, 3) global rotations against the rest pose
    walk_root: np.ndarray  # (frames, 3) positions of the root's head
    images: dict  # name in IMAGES -> (height, width, 3) bytes-like floats, bottom row first
    landmarks: dict = field(default_factory=dict)
    leg_thickness: float = 1.0  # against the source's own legs


def _append(path):
    if not os.path.exists(path):
        fail(
            "%s: not found; install the Debian package morse-simulator-data, or name the file in "
            "the option 'human_rig'" % path
        )
    try:
        with bpy.data.libraries.load(path, link=False) as (source, target):
            wanted = [ARMATURE] + [
                name
                for name in source.objects
                if any(name.endswith(part) for part in PARTS.values())
            ]
            target.objects = [name for name in source.objects if name in wanted]
            target.images = [name for name in source.images if name in IMAGES.values()]
    except OSError as error:
        fail("%s: cannot be read as a Blender file: %s" % (path, error))
    objects = {}
    for thing in target.objects:
        for key, ending in [("armature", ARMATURE)] + list(PARTS.items()):
            if thing.name.endswith(ending):
                objects[key] = thing
    for key in ["armature"] + list(PARTS):
        if key not in objects:
            fail("%s: holds no object '%s'" % (path, PARTS.get(key, ARMATURE)))
    return objects


def _joint_columns(armature):
    """Column of the kept joint that each bone's weights go to."""
    columns = {}
    for bone in armature.data.bones:
        rank = bone.name[6:] if bone.name.startswith(("finger", "metacarpal")) else ""
        same_rank = {"-1": "finger3-1", "-2": "finger3-2", "-3": "finger3-2"}
        name = bone.name
        if name not in sk.KEPT and name.startswith("finger") and not name.startswith("finger1"):
            name = same_rank[rank[1:3]] + name[-2:]
        up = bone
        while name not in sk.KEPT:
            up = up.parent
            name = up.name
        columns[bone.name] = sk.KEPT.index(name)
    return columns


def _surface(thing, columns, key):
    mesh = thing.data
    points = np.empty(len(mesh.vertices) * 3)
    mesh.vertices.foreach_get("co", points)
    weights = np.zeros((len(mesh.vertices), len(sk.KEPT)))
    names = {group.index: group.name for group in thing.vertex_groups}
    for vertex in mesh.vertices:
        for element in vertex.groups:
            if names[element.group] in columns:
                weights[vertex.index, columns[names[element.group]]] += element.weight
    uv = np.empty(len(mesh.loops) * 2)
    mesh.uv_layers[0].data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 2)
    uv[:, 1] = 1.0 - uv[:, 1]
    faces = [tuple(polygon.vertices) for polygon in mesh.polygons]
    order = [c for polygon in mesh.polygons for c in polygon.loop_indices]
    points = points.reshape(-1, 3) @ TURN.T
    bare = weights.sum(axis=1) < 1e-6
    if bare.any():
        weights[bare] = nearest_weights(points[bare], points[~bare], weights[~bare], 3)
    weights /= weights.sum(axis=1, keepdims=True)
    return Surface(points, faces, weights, uv[order], [key] * len(faces))


def _sample_walk(armature):
    """Global rotations of the kept joints and root positions at every frame of the source's
    walk.
    """
    scene = bpy.context.scene
    scene.collection.objects.link(armature)
    rest_root = np.array(armature.data.bones["root"].head_local)
    rotations, roots = [], []
    for frame in WALK_FRAMES:
        scene.frame_set(frame)
        bones = armature.pose.bones
        moved = {
            name: np.array(bones[name].matrix @ bones[name].bone.matrix_local.inverted())
            for name in sk.KEPT
        }
        rotations.append([TURN @ sk.orthonormal(moved[name][:3, :3]) @ TURN.T for name in sk.KEPT])
        roots.append(TURN @ (moved["root"][:3, :3] @ rest_root + moved["root"][:3, 3]))
    return np.array(rotations), np.array(roots)


def _pixels(image):
    values = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], image.channels)[..., :3]


def load_figure(path):
    """The figure in the source's own rest pose (arms and legs spread)."""
    objects = _append(path)
    armature = objects["armature"]
    bones = armature.data.bones
    parents = []
    for name in sk.KEPT:
        up = bones[name].parent
        while up is not None and up.name not in sk.KEPT:
            up = up.parent
        parents.append(-1 if up is None else sk.KEPT.index(up.name))
    heads = np.array([bones[name].head_local for name in sk.KEPT]) @ TURN.T
    columns = _joint_columns(armature)
    parts = {key: _surface(objects[key], columns, key) for key in PARTS}
    walk, walk_root = _sample_walk(armature)
    images = {key: _pixels(bpy.data.images[name]) for key, name in IMAGES.items()}
    landmarks = {key: np.array(point) for key, (point, _) in LANDMARKS.items()}
    for thing in objects.values():
        bpy.data.objects.remove(thing)
    for action in list(bpy.data.actions):
        bpy.data.actions.remove(action)
    skeleton = sk.Skeleton(list(sk.KEPT), parents, heads)
    return eyes.with_eye_joints(Figure(skeleton, parts, walk, walk_root, images, landmarks))


def standing_pose(figure, arm_lift_deg):
    """Global rotations: trunk as in the walk, legs upright, upper arms `arm_lift_deg` off
    vertical.
    """
    local = sk.local_from_global(figure.skeleton, _mean_rotations(figure.walk))
    pose = {name: local[i] for i, name in enumerate(figure.skeleton.names)}
    pose["root"] = np.eye(3)
    for side, sign in (("_L", 1.0), ("_R", -1.0)):
        lean = sign * 5.0
        pose["upperleg02" + side] = sk.rotation("y", lean)
        pose["lowerleg01" + side] = np.eye(3)
        pose["foot" + side] = sk.rotation("y", -lean)
        pose["shoulder02" + side] = sk.rotation("y", sign * (44.0 - arm_lift_deg) * 0.5)
        pose["upperarm02" + side] = sk.rotation("y", sign * (44.0 - arm_lift_deg) * 0.5)
    return sk.global_from_local(figure.skeleton, pose)


def _mean_rotations(walk):
    return np.array([sk.orthonormal(joint) for joint in walk[:-1].mean(axis=0)])


def _move(figure, matrices, heads, walk, walk_root):
    """The figure with vertices, landmarks and joints carried by per-joint matrices."""
    parts = {
        key: with_parts(part, vertices=sk.skinned(part.vertices, part.weights, matrices))
        for key, part in figure.parts.items()
    }
    landmarks = {}
    for key, point in figure.landmarks.items():
        matrix = matrices[figure.skeleton.index(LANDMARKS[key][1])]
        landmarks[key] = matrix[:3, :3] @ point + matrix[:3, 3]
    skeleton = sk.Skeleton(figure.skeleton.names, figure.skeleton.parents, heads)
    return replace(
        figure, skeleton=skeleton, parts=parts, walk=walk, walk_root=walk_root, landmarks=landmarks
    )


def stood(figure, arm_lift_deg=20.0):
    """The same person with the standing pose as rest pose."""
    pose = standing_pose(figure, arm_lift_deg)
    matrices = sk.transforms(figure.skeleton, pose, figure.skeleton.heads[0])
    heads = np.einsum("nij,nj->ni", matrices[:, :3, :3], figure.skeleton.heads) + matrices[:, :3, 3]
    walk = np.einsum("fnij,nkj->fnik", figure.walk, pose)
    return _move(figure, matrices, heads, walk, figure.walk_root)


def _joint_scales(names, proportions):
    """World-axis scale (x, y, z) of each joint's own flesh."""
    groups = {
        "legs": ("upperleg", "lowerleg"),
        "feet": ("foot",),
        "arms": ("shoulder02", "upperarm", "lowerarm"),
        "hands": ("wrist", "finger"),
        "head": ("head", "lids", "eye_"),
        "neck": ("neck",),
        "trunk": ("root", "spine", "clavicle"),
    }
    scales = np.ones((len(names), 3))
    for i, name in enumerate(names):
        for group, prefixes in groups.items():
            if name.startswith(prefixes):
                scales[i] = proportions.get(group, (1.0, 1.0, 1.0))
    return scales


def proportioned(figure, height_m, proportions):
    """Scales each body region, then the whole to `height_m` from sole to crown."""
    skeleton = figure.skeleton
    scales = _joint_scales(skeleton.names, proportions)
    matrices = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
    heads = skeleton.heads.copy()
    for i, parent in enumerate(skeleton.parents):
        if parent >= 0:
            heads[i] = matrices[parent][:3, :3] @ skeleton.heads[i] + matrices[parent][:3, 3]
        matrices[i][:3, :3] = np.diag(scales[i])
        matrices[i][:3, 3] = heads[i] - scales[i] * skeleton.heads[i]
    moved = _move(figure, matrices, heads, figure.walk, figure.walk_root)
    sole = moved.parts["shoes"].vertices[:, 2].min()
    crown = moved.parts["body"].vertices[:, 2].max()
    factor = height_m / (crown - sole)
    centre = moved.skeleton.head("root")
    shift = np.array([0.0, 0.0, sole])
    whole = np.eye(4)
    whole[:3, :3] *= factor
    whole[:3, 3] = -shift * factor
    legs = factor * scales[skeleton.index("lowerleg01_L")][2]
    root = (figure.walk_root - skeleton.heads[0]) * legs + (centre - shift) * factor
    result = _move(
        moved,
        np.tile(whole, (len(skeleton.names), 1, 1)),
        (heads - shift) * factor,
        figure.walk,
        root,
    )
    for key in ("ankle", "knee"):
        joint = {"ankle": "foot_L", "knee": "lowerleg01_L"}[key]
        result.landmarks[key][2] = result.skeleton.head(joint)[2]
    result.landmarks["sole"][2] = 0.0
    return replace(result, leg_thickness=factor * scales[skeleton.index("lowerleg01_L")][0])


MOUTH_CORNERS = {  # the source's droop
    "at": "mouth", "by": (0.021, 0.012, -0.001), "radius": (0.017, 0.030, 0.014), "push": (0.0008, 0.0, 0.0042),
    "mirror": True,
}


def bulged(figure, bulges):
    """Pushes shirt, trousers and body by smooth bumps.

    Each bump: {"at": landmark, "by": (x, y, z) offset from it, "radius": (x, y, z), "push": (x, y,
    z), "swell": share, "mirror": bool}; lengths relative to a figure of 1.7 m. swell grows what
    lies about the point.
    """
    factor = figure.landmarks["crown"][2] / 1.7
    parts = dict(figure.parts)
    for bump in [MOUTH_CORNERS, *bulges]:
        sides = (1.0, -1.0) if bump.get("mirror") else (1.0,)
        for side in sides:
            flip = np.array([side, 1.0, 1.0])
            centre = figure.landmarks[bump["at"]] + np.array(bump["by"]) * flip * factor
            push = np.array(bump.get("push", (0.0, 0.0, 0.0))) * flip * factor
            for key in ("shirt", "trousers", "body", "eyes"):
                points = parts[key].vertices
                distance = np.linalg.norm(
                    (points - centre) / (np.array(bump["radius"]) * factor), axis=1
                )
                share = 1.0 - smoothstep(0.0, 1.0, distance)
                parts[key] = with_parts(
                    parts[key],
                    vertices=points
                    + share[:, None] * (push + bump.get("swell", 0.0) * (points - centre)),
                )
    return replace(figure, parts=parts)


def joint_share(figure, surface, prefixes):
    """Per vertex: how much of its weight lies on joints whose names start so."""
    columns = [i for i, name in enumerate(figure.skeleton.names) if name.startswith(prefixes)]
    return surface.weights[:, columns].sum(axis=1)
