"""Builds a pigeon as a GLB: rigged, with the clips walk, idle and fly, for a [[flock]].

    blender --background --factory-startup --python-exit-code 1 --python build_pigeon.py -- SETTINGS.json

SETTINGS.json: {"output": "pigeon.glb", "seed": 1, "options": {"coat": "8b919c"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from common.settings import load_settings, write_atomically  # noqa: E402
from townspeople import animal, pigeon, scene  # noqa: E402

COLORS = {"coat": "848a96", "neck": "4c5562", "wing": "a3a8b0", "dark": "33363c", "bar": "3b3f47", "beak": "9c5a50",
          "eye": "c06a20"}


def main():
    settings = load_settings(required=("output", "seed"), options=COLORS)
    colors = {key: animal.linear(key, settings["options"][key]) for key in COLORS}
    scene.empty_scene()
    skeleton = pigeon.pigeon_skeleton()
    armature = scene.make_armature(skeleton)
    walk, speed_mps = pigeon.walk_clip(skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    faces = animal.make_mesh("pigeon_mesh", pigeon.pigeon_surface(), colors, armature)
    made = (walk, pigeon.idle_clip(skeleton), pigeon.fly_clip(skeleton))
    write_atomically(settings["output"], lambda path: scene.write_glb(path, armature, skeleton, made))
    print("pigeon: %d polygons, %d joints, walks %.2f m/s" % (faces, len(skeleton.names), speed_mps))


main()
