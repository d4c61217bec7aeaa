"""Builds a pigeon as a GLB: rigged, with the clips walk, idle and fly, for a [[flock]].

    blender --background --factory-startup --python-exit-code 1 --python build_pigeon.py -- SETTINGS.json

SETTINGS.json: {"output": "pigeon.glb", "seed": 1, "options": {"coat": "767c88"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from townspeople import animal, pigeon  # noqa: E402

COLORS = {"coat": "6f7682", "neck": "4c5562", "wing": "868c97", "dark": "33363c", "bar": "4a4f59", "beak": "9c5a50",
          "eye": "c06a20"}

animal.build("pigeon", COLORS, pigeon.pigeon_skeleton(), pigeon.pigeon_surface, pigeon.walk_clip, pigeon.idle_clip, pigeon.fly_clip)
