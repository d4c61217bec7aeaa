"""Blender objects of the finished person, and the GLB."""

import bpy
import numpy as np
from mathutils import Matrix

from common import gltf
from townspeople import skeleton as sk
from townspeople.body import WALK_FRAMES_PER_SECOND


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


def add_clip(armature, skeleton, clip):
    """One action in one NLA track, both named as the clip."""
    action = bpy.data.actions.new(clip.name)
    action.use_fake_user = True
    frames = np.arange(len(clip.rotations), dtype=float)
    local = np.array([sk.local_from_global(skeleton, frame) for frame in clip.rotations])
    for joint, name in enumerate(skeleton.names):
        rest = np.array(armature.data.bones[name].matrix_local)[:3, :3]
        turns = [
            Matrix((rest.T @ frame @ rest).tolist()).to_quaternion() for frame in local[:, joint]
        ]
        for before, after in zip(turns, turns[1:]):
            if before.dot(after) < 0:
                after.negate()
        path = 'pose.bones["%s"].' % name
        for axis in range(4):
            _curve(
                action, path + "rotation_quaternion", axis, name, frames, [q[axis] for q in turns]
            )
        if skeleton.parents[joint] < 0:
            moves = (clip.roots - skeleton.heads[joint]) @ rest
            for axis in range(3):
                _curve(action, path + "location", axis, name, frames, moves[:, axis])
    armature.animation_data_create()
    track = armature.animation_data.nla_tracks.new()
    track.name = clip.name
    strip = track.strips.new(clip.name, 0, action)
    strip.name = clip.name
    return action


def _curve(action, path, axis, group, frames, values):
    curve = action.fcurves.new(path, index=axis, action_group=group)
    curve.keyframe_points.add(len(frames))
    pairs = np.stack([frames, np.asarray(values, float)], axis=1)
    curve.keyframe_points.foreach_set("co", pairs.ravel())
    for point in curve.keyframe_points:
        point.interpolation = "LINEAR"
    curve.update()


def export_glb(path):
    """Everything in the scene as one GLB."""
    gltf.export_glb(
        path,
        export_apply=False,
        export_animations=True,
        export_frame_range=False,
        export_force_sampling=True,
        export_nla_strips=True,
        export_animation_mode="NLA_TRACKS",
        export_def_bones=True,
        export_skins=True,
        export_all_influences=False,
        export_optimize_animation_size=True,
        export_optimize_animation_keep_anim_armature=False,
        export_anim_single_armature=True,
        export_reset_pose_bones=True,
    )
