"""Builds a dog as a GLB: rigged, with the clips walk, idle and lie.

    blender --background --factory-startup --python-exit-code 1 --python build_dog.py -- SETTINGS.json

SETTINGS.json: {"output": "dog.glb", "seed": 1, "options": {"coat": "7a5230"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

import bpy  # noqa: E402

from common.settings import fail, load_settings, write_atomically  # noqa: E402
from townspeople import dog, scene  # noqa: E402

COLORS = {"coat": "7a5230", "belly": "a07a4c", "dark": "2b1d14"}


def linear(key, text):
    """Linear RGBA of six hexadecimal digits."""
    try:
        values = [int(text[i:i + 2], 16) / 255 for i in (0, 2, 4)]
    except (TypeError, ValueError):
        fail("options: '%s' must be a colour such as '%s'" % (key, COLORS[key]))
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values] + [1.0]


def make_material(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = color
    shader.inputs["Roughness"].default_value = 1.0
    return material


def make_mesh(tubes, colors, armature):
    mesh = bpy.data.meshes.new("dog_mesh")
    mesh.from_pydata(tubes.points, [], tubes.faces)
    names = list(colors)
    for name in names:
        mesh.materials.append(make_material(name, colors[name]))
    mesh.polygons.foreach_set("material_index", [names.index(color) for color in tubes.colors])
    mesh.polygons.foreach_set("use_smooth", [True] * len(tubes.faces))
    thing = bpy.data.objects.new("dog_mesh", mesh)
    bpy.context.scene.collection.objects.link(thing)
    groups = {bone.name: thing.vertex_groups.new(name=bone.name) for bone in armature.data.bones}
    for vertex, weights in enumerate(tubes.weights):
        for joint, share in weights.items():
            groups[joint].add([vertex], share, "REPLACE")
    thing.modifiers.new("Armature", "ARMATURE").object = armature
    return len(tubes.faces)


def main():
    settings = load_settings(required=("output", "seed"), options=COLORS)
    colors = {key: linear(key, settings["options"][key]) for key in COLORS}
    scene.empty_scene()
    skeleton = dog.dog_skeleton()
    armature = scene.make_armature(skeleton)
    walk, speed_mps = dog.walk_clip(skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    faces = make_mesh(dog.dog_surface("coat", "belly", "dark"), colors, armature)
    for clip in (walk, dog.idle_clip(skeleton), dog.lie_clip(skeleton)):
        scene.add_clip(armature, skeleton, clip)
    write_atomically(settings["output"], scene.export_glb)
    print("dog: %d polygons, %d joints, walks %.2f m/s" % (faces, len(skeleton.names), speed_mps))


main()
