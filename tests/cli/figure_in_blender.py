"""Makes a rigged figure of four ellipsoids that walks and stands, as .blend, .fbx, .dae and .obj, with a hat as .blend, its clips alone, and a town of one house as .blend, .x3d and .ply.

    blender --background --factory-startup --python-exit-code 1 --python figure_in_blender.py -- FOLDER
"""
import math
import pathlib
import sys

import bpy

BONES = {  # head, tail, parent
    "hips": ((0, 0, 0.9), (0, 0, 1.2), None),
    "head": ((0, 0, 1.4), (0, 0, 1.75), "hips"),
    "leg_l": ((0.1, 0, 0.9), (0.1, 0, 0.05), "hips"),
    "leg_r": ((-0.1, 0, 0.9), (-0.1, 0, 0.05), "hips"),
}
PARTS = {  # centre, half size
    "hips": ((0, 0, 1.15), (0.2, 0.12, 0.3)),
    "head": ((0, 0, 1.6), (0.11, 0.12, 0.15)),
    "leg_l": ((0.1, 0, 0.45), (0.08, 0.1, 0.45)),
    "leg_r": ((-0.1, 0, 0.45), (0.08, 0.1, 0.45)),
}


def make_rig():
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, (head, tail, parent) in BONES.items():
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
        bone.parent = rig.data.edit_bones[parent] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def hang_part(rig, name, center, half_size):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, location=center)
    part = bpy.context.object
    part.name, part.scale, part.parent = name, half_size, rig
    bpy.ops.object.transform_apply(location=True, scale=True)
    part.vertex_groups.new(name=name).add(range(len(part.data.vertices)), 1, "REPLACE")
    part.modifiers.new("armature", "ARMATURE").object = rig


def add_blink(head):
    """Two lids in front that close as ARKit calls it."""
    head.shape_key_add(name="Basis")
    for side, sign in (("Left", 1), ("Right", -1)):
        shape = head.shape_key_add(name="eyeBlink" + side)
        for point in shape.data:
            if point.co.z > 1.62 and point.co.y < -0.05 and sign * point.co.x > 0:
                point.co.z -= 0.03


def add_action(rig, action, swing_rad):
    rig.animation_data_create()
    rig.animation_data.action = bpy.data.actions.new(action)
    rig.animation_data.action.use_fake_user = True
    for frame in range(1, 26, 3):
        for name, sign in (("leg_l", 1), ("leg_r", -1), ("head", 0.3)):  # a joint that never moves would be left out
            bone = rig.pose.bones[name]
            half = sign * swing_rad * math.sin((frame - 1) / 24 * 2 * math.pi) / 2
            bone.rotation_quaternion = (math.cos(half), math.sin(half), 0, 0)
            bone.keyframe_insert("rotation_quaternion", frame=frame)


def make_figure(folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rig = make_rig()
    for name, (center, half_size) in PARTS.items():
        hang_part(rig, name, center, half_size)
    add_blink(bpy.data.objects["head"])
    add_action(rig, "idle", 0.03)
    add_action(rig, "walk", 0.6)
    bpy.context.scene.frame_end = 25
    bpy.ops.mesh.primitive_cube_add(location=(5, 0, 0))
    bpy.context.object.hide_set(True)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "figure.blend"))
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.export_scene.fbx(filepath=str(folder / "figure.fbx"), add_leaf_bones=False, bake_anim_use_all_actions=True)
    bpy.ops.wm.obj_export(filepath=str(folder / "figure.obj"))
    if hasattr(bpy.ops.wm, "collada_export"):
        bpy.ops.wm.collada_export(filepath=str(folder / "figure.dae"))


def make_clips(folder):
    """The figure's rig without the figure, as clips are downloaded; it walks with half the swing."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_action(make_rig(), "walk", 0.3)
    bpy.context.scene.frame_end = 25
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "walking.blend"))
    bpy.ops.export_scene.fbx(filepath=str(folder / "walking.fbx"), add_leaf_bones=False, bake_anim_use_all_actions=True)
    if hasattr(bpy.ops.wm, "collada_export"):
        bpy.ops.wm.collada_export(filepath=str(folder / "walking.dae"))


def make_figure_with_hat(folder):
    """Its rig stands elsewhere, turned, and bows; the hat hangs on the head's bone."""
    bpy.ops.wm.open_mainfile(filepath=str(folder / "figure.blend"))
    rig = bpy.data.objects["rig"]
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, 1.8), scale=(0.1, 0.1, 0.1))
    hat, at = bpy.context.object, bpy.context.object.matrix_world.copy()
    hat.name, hat.parent, hat.parent_type, hat.parent_bone = "hat", rig, "BONE", "head"
    hat.matrix_world = at
    rig.animation_data.action = bpy.data.actions.new("bow")
    for name, half_rad in (("hips", 0.3), ("head", 0.4)):
        bone = rig.pose.bones[name]
        bone.rotation_quaternion = (math.cos(half_rad), math.sin(half_rad), 0, 0)
        bone.keyframe_insert("rotation_quaternion", frame=1)
        bone.keyframe_insert("rotation_quaternion", frame=10)
    rig.location, rig.rotation_euler = (3, 2, 0), (0, 0, 1)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "hat.blend"))


def make_figure_with_held_hat(folder):
    """A constraint holds the hat at the head, and the rig is shown at rest."""
    bpy.ops.wm.open_mainfile(filepath=str(folder / "figure.blend"))
    rig = bpy.data.objects["rig"]
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, 1.8), scale=(0.1, 0.1, 0.1))
    hat = bpy.context.object
    hat.name = "hat"
    rig.data.pose_position = "REST"
    bpy.context.view_layer.update()
    holds = hat.constraints.new("CHILD_OF")
    holds.target, holds.subtarget = rig, "head"
    holds.inverse_matrix = (rig.matrix_world @ rig.pose.bones["head"].matrix).inverted()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "held_hat.blend"))


def paint(house):
    """With a picture that lies as a UV map of a name says."""
    material = bpy.data.materials.new("wall")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    picture, uv_map = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeUVMap")
    picture.image = bpy.data.images.new("wall", 4, 4)
    picture.image.pack()
    uv_map.uv_map = house.data.uv_layers[0].name
    links.new(uv_map.outputs["UV"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    house.data.materials.append(material)


def make_town(folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_plane_add(size=60)
    bpy.context.object.name = "square"
    bpy.context.object["flaneur_kind"] = "ground"
    bpy.ops.mesh.primitive_cube_add(location=(3, 4, 3), scale=(4, 2, 3))
    bpy.context.object.name = "house"
    bpy.context.object["flaneur_kind"] = "building"
    paint(bpy.context.object)
    bpy.ops.mesh.primitive_cube_add(location=(-20, 20, 1))
    bpy.context.object.name = "shed"
    bpy.context.object.data.materials.append(None)  # a slot that nobody filled
    bpy.context.object["flaneur_kind"] = "building"
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "town.blend"))
    bpy.ops.export_mesh.ply(filepath=str(folder / "town.ply"))
    if "x3d" in dir(bpy.ops.export_scene):
        bpy.ops.export_scene.x3d(filepath=str(folder / "town.x3d"))


target = pathlib.Path(sys.argv[sys.argv.index("--") + 1])
make_figure(target)
make_figure_with_hat(target)
make_figure_with_held_hat(target)
make_clips(target)
make_town(target)
