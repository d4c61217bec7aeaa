"""Builds a dog as a GLB: rigged, with the clips walk, idle and lie.

    blender --background --factory-startup --python-exit-code 1 --python build_dog.py -- SETTINGS.json

SETTINGS.json: {"output": "dog.glb", "seed": 1, "options": {"coat": "7a5230"}}; colours sRGB.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

from townspeople import animal, dog  # noqa: E402

COLORS = {"coat": "7a5230", "belly": "a07a4c", "dark": "2b1d14"}

animal.build("dog", COLORS, dog.dog_skeleton(), lambda: dog.dog_surface("coat", "belly", "dark"), dog.walk_clip, dog.idle_clip, dog.lie_clip)
