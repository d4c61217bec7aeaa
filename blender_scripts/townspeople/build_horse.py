"""Builds a draught horse as a GLB: rigged, with the clips walk and idle.

    blender --background --factory-startup --python-exit-code 1 --python build_horse.py -- SETTINGS.json

SETTINGS.json: {"output": "horse.glb", "seed": 1, "options": {"coat": "7a6a58"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from common.settings import load_settings, write_atomically  # noqa: E402
from townspeople import animal, horse, scene  # noqa: E402

COLORS = {"coat": "5d3a26", "muzzle": "4a3328", "blaze": "d8cfc0", "hair": "2c1f18", "sock": "9c8a72", "hoof": "3a322c",
          "dark": "120d0a", "leather": "3a2417"}


def main():
    settings = load_settings(required=("output", "seed"), options=COLORS)
    colors = {key: animal.linear(key, settings["options"][key]) for key in COLORS}
    scene.empty_scene()
    skeleton = horse.horse_skeleton()
    armature = scene.make_armature(skeleton)
    walk, speed_mps = horse.walk_clip(skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    faces = animal.make_mesh("horse_mesh", horse.horse_surface(), colors, armature)
    made = (walk, horse.idle_clip(skeleton))
    write_atomically(settings["output"], lambda path: scene.write_glb(path, armature, skeleton, made))
    print("horse: %d polygons, %d joints, walks %.2f m/s" % (faces, len(skeleton.names), speed_mps))


main()
