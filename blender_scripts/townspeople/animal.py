"""Blender objects of an animal: its materials and its skinned mesh."""

import bpy

from common.settings import fail


def linear(key, text):
    """Linear RGBA of six hexadecimal digits."""
    try:
        values = [int(text[i:i + 2], 16) / 255 for i in (0, 2, 4)]
    except (TypeError, ValueError):
        fail("options: '%s' must be a colour of six hexadecimal digits, such as '7a5230'" % key)
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values] + [1.0]


def _make_material(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = color
    shader.inputs["Roughness"].default_value = 1.0
    return material


def make_mesh(name, tubes, colors, armature):
    """How many polygons it has."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(tubes.points, [], tubes.faces)
    names = list(colors)
    for color in names:
        mesh.materials.append(_make_material(color, colors[color]))
    mesh.polygons.foreach_set("material_index", [names.index(color) for color in tubes.colors])
    mesh.polygons.foreach_set("use_smooth", [True] * len(tubes.faces))
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    groups = {bone.name: thing.vertex_groups.new(name=bone.name) for bone in armature.data.bones}
    for vertex, weights in enumerate(tubes.weights):
        for joint, share in weights.items():
            groups[joint].add([vertex], share, "REPLACE")
    thing.modifiers.new("Armature", "ARMATURE").object = armature
    return len(tubes.faces)
