"""An animal as a GLB: its materials, its skinned mesh and its clips."""

import bpy

from common.settings import fail, load_settings, write_atomically
from townspeople import scene


def _linear(key, text):
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


def _make_mesh(name, tubes, colors, armature):
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


def build(name, colors, skeleton, surface, walk_clip, *other_clips):
    """What the script of an animal does. colors: the options with which it may be dyed, and their defaults; surface() makes its tubes,
    walk_clip(skeleton) its walk and its speed, each of other_clips(skeleton) one clip more.
    """
    settings = load_settings(required=("output", "seed"), options=colors)
    colors = {key: _linear(key, settings["options"][key]) for key in colors}
    scene.empty_scene()
    armature = scene.make_armature(skeleton)
    walk, speed_mps = walk_clip(skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    faces = _make_mesh(name + "_mesh", surface(), colors, armature)
    made = (walk, *(clip(skeleton) for clip in other_clips))
    write_atomically(settings["output"], lambda path: scene.write_glb(path, armature, skeleton, made))
    print("%s: %d polygons, %d joints, walks %.2f m/s" % (name, faces, len(skeleton.names), speed_mps))
