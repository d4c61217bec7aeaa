"""Builds a draught horse as a GLB: rigged, with the clips walk and idle.

    blender --background --factory-startup --python-exit-code 1 --python build_horse.py -- SETTINGS.json

SETTINGS.json: {"output": "horse.glb", "seed": 1, "options": {"coat": "7a6a58"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from townspeople import animal, horse  # noqa: E402

COLORS = {"coat": "5d3a26", "muzzle": "4a3328", "blaze": "d8cfc0", "hair": "2c1f18", "sock": "9c8a72", "hoof": "3a322c",
          "dark": "120d0a", "leather": "3a2417"}

animal.build("horse", COLORS, horse.horse_skeleton(), horse.horse_surface, horse.walk_clip, horse.idle_clip)
