"""Builds a dog as a GLB: rigged, with the clips walk, idle and lie.

    blender --background --factory-startup --python-exit-code 1 --python build_dog.py -- SETTINGS.json

SETTINGS.json: {"output": "dog.glb", "seed": 1, "options": {"coat": "7a5230"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from common.settings import load_settings, write_atomically  # noqa: E402
from townspeople import animal, dog, scene  # noqa: E402

COLORS = {"coat": "7a5230", "belly": "a07a4c", "dark": "2b1d14"}


def main():
    settings = load_settings(required=("output", "seed"), options=COLORS)
    colors = {key: animal.linear(key, settings["options"][key]) for key in COLORS}
    scene.empty_scene()
    skeleton = dog.dog_skeleton()
    armature = scene.make_armature(skeleton)
    walk, speed_mps = dog.walk_clip(skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    faces = animal.make_mesh("dog_mesh", dog.dog_surface("coat", "belly", "dark"), colors, armature)
    made = (walk, dog.idle_clip(skeleton), dog.lie_clip(skeleton))
    write_atomically(settings["output"], lambda path: scene.write_glb(path, armature, skeleton, made))
    print("dog: %d polygons, %d joints, walks %.2f m/s" % (faces, len(skeleton.names), speed_mps))


main()
