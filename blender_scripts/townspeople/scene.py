"""Blender objects of the finished person, and the GLB."""

import bpy
import numpy as np
from mathutils import Quaternion

from common import glb, gltf
from townspeople.body import WALK_FRAMES_PER_SECOND

STEADY = 1e-4  # a joint's quaternion, or the root's place in metres, that changes less stands still


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = int(WALK_FRAMES_PER_SECOND)
    return scene


def make_armature(skeleton):
    """The armature object, with its rest rotations {joint: 3x3}."""
    data = bpy.data.armatures.new("person")
    thing = bpy.data.objects.new("person", data)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    for i, name in enumerate(skeleton.names):
        bone = data.edit_bones.new(name)
        head = skeleton.heads[i]
        children = [j for j, parent in enumerate(skeleton.parents) if parent == i]
        tail = skeleton.heads[children[0]] if children else head + _onward(skeleton, i)
        if np.linalg.norm(tail - head) < 0.01:
            tail = head + np.array([0.0, 0.0, 0.03])
        bone.head, bone.tail = head, tail
        if skeleton.parents[i] >= 0:
            bone.parent = data.edit_bones[skeleton.names[skeleton.parents[i]]]
    bpy.ops.object.mode_set(mode="OBJECT")
    return thing


def _onward(skeleton, joint):
    """Direction and length of a last joint's bone."""
    name = skeleton.names[joint]
    if name.startswith("foot"):
        return np.array([0.0, -0.12, -0.03])
    if name == "head":
        return np.array([0.0, 0.0, 0.15])
    way = skeleton.heads[joint] - skeleton.heads[skeleton.parents[joint]]
    return way / np.linalg.norm(way) * 0.04


def make_mesh(name, surface, materials, material_of_cell, uv, armature, joints, tint=1.0):
    """A skinned mesh object; `uv` are glTF texture coordinates of the corners, `tint` colours the
    ambient light; `joints`: names, by column of the weights.

    It is no child of the armature: a skinned mesh below another node draws a validator's warning.
    """
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in surface.vertices], [], surface.faces)
    names = list(materials)
    for material in materials.values():
        mesh.materials.append(material)
    mesh.polygons.foreach_set(
        "material_index", [names.index(material_of_cell[c]) for c in surface.cells]
    )
    mesh.polygons.foreach_set("use_smooth", [True] * len(surface.faces))
    layer = mesh.uv_layers.new(name="UVMap")
    flipped = np.stack([uv[:, 0], 1.0 - uv[:, 1]], axis=1)
    layer.data.foreach_set("uv", flipped.astype(np.float32).ravel())
    colours = mesh.color_attributes.new("COLOR", "BYTE_COLOR", "POINT")
    values = np.ones((len(surface.vertices), 4), np.float32)
    values[:, :3] = surface.shade[:, None] * tint
    colours.data.foreach_set("color", values.ravel())
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    groups = [thing.vertex_groups.new(name=joint) for joint in joints]
    for vertex, joint in np.argwhere(surface.weights > 0):
        groups[joint].add([int(vertex)], float(surface.weights[vertex, joint]), "REPLACE")
    modifier = thing.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    return thing


def _quaternions(matrices):
    """Of rotations (frames, 3, 3) as rows (x, y, z, w), each next to the one before it (of both signs)."""
    m = matrices
    squares = 0.25 * np.maximum(1.0 + np.array([
        m[:, 0, 0] - m[:, 1, 1] - m[:, 2, 2], m[:, 1, 1] - m[:, 0, 0] - m[:, 2, 2],
        m[:, 2, 2] - m[:, 0, 0] - m[:, 1, 1], m[:, 0, 0] + m[:, 1, 1] + m[:, 2, 2]]), 0.0)
    xy, xz, yz = (0.25 * (m[:, i, j] + m[:, j, i]) for i, j in ((0, 1), (0, 2), (1, 2)))
    xw, yw, zw = (0.25 * (m[:, i, j] - m[:, j, i]) for i, j in ((2, 1), (0, 2), (1, 0)))
    products = np.array([[squares[0], xy, xz, xw], [xy, squares[1], yz, yw], [xz, yz, squares[2], zw], [xw, yw, zw, squares[3]]])
    largest = squares.argmax(axis=0)
    rows = products[largest, :, np.arange(len(m))]  # each times its largest part, which so is positive
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    rows[0] *= -1.0 if rows[0, 3] < 0 else 1.0
    signs = np.sign((rows[1:] * rows[:-1]).sum(axis=1))
    rows[1:] *= np.cumprod(np.where(signs < 0, -1.0, 1.0))[:, None]
    return rows


def _product(a, b):
    """Quaternion a times the quaternions b."""
    x, y, z, w = a
    return b @ np.array([[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z], [x, y, z, w]])


def _add_clip(document, binary, nodes, rests, skeleton, clip, seconds):
    """One animation. What hardly changes keeps its first and last frame only.

    nodes: index by joint. rests: each joint's rotation in Blender's rest pose. seconds: accessors of the times of all
    frames, and of the first and the last.
    """
    animation = {"name": clip.name, "samplers": [], "channels": []}

    def add(name, path, rows, steady):
        sampler = {"input": seconds[1 if steady else 0], "interpolation": "LINEAR",
                   "output": glb.add_floats(document, binary, rows[[0, -1]] if steady else rows)}
        animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": nodes[name], "path": path}})
        animation["samplers"].append(sampler)

    for joint, name in enumerate(skeleton.names):
        node, parent, rest = document["nodes"][nodes[name]], skeleton.parents[joint], rests[joint]
        local = clip.rotations[:, joint]
        if parent < 0:
            moves = (clip.roots - skeleton.heads[joint]) @ rest
            turned = moves @ _matrix(node).T
            add(name, "translation", turned + node.get("translation", [0.0] * 3), np.ptp(moves, axis=0).max() < STEADY)
        else:
            local = clip.rotations[:, parent].transpose(0, 2, 1) @ local
        turns = _quaternions(rest.T @ local @ rest)
        rows = _product(node.get("rotation", [0.0, 0.0, 0.0, 1.0]), turns)
        add(name, "rotation", rows / np.linalg.norm(rows, axis=1, keepdims=True), np.ptp(turns, axis=0).max() < STEADY)
    document.setdefault("animations", []).append(animation)


def _matrix(node):
    """A node's rotation."""
    x, y, z, w = node.get("rotation", [0.0, 0.0, 0.0, 1.0])
    return np.array(Quaternion((w, x, y, z)).to_matrix())


def write_glb(path, armature, skeleton, clips):
    """Everything in the scene as one GLB, and the clips by name.

    They go past Blender, whose exporter poses the armature anew for each frame of each joint's each property.
    """
    gltf.export_glb(path, export_apply=False, export_animations=False, export_def_bones=True, export_skins=True,
                    export_all_influences=False)
    document, binary = glb.read(path)
    nodes = {node["name"]: index for index, node in enumerate(document["nodes"])}
    rests = [np.array(armature.data.bones[name].matrix_local)[:3, :3].astype(float) for name in skeleton.names]
    seconds = {}
    for clip in sorted(clips, key=lambda clip: clip.name):
        frames = len(clip.rotations)
        if frames not in seconds:
            times = np.arange(frames) / WALK_FRAMES_PER_SECOND
            seconds[frames] = [glb.add_floats(document, binary, some, bounds=True) for some in (times, times[[0, -1]])]
        _add_clip(document, binary, nodes, rests, skeleton, clip, seconds[frames])
    glb.write(path, document, binary)
