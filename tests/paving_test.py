"""From afar a pavement is of one brightness: its texture repeats over the square, and whatever is wider than its stones would make waves.

paving_test.py SOURCE
"""
import pathlib
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(sys.argv.pop(1)) / "blender_scripts/town"))
import textures  # noqa: E402

SIZE_PX = 512
PATCHES = 8  # a side: each some stones wide
MOST_CONTRAST = 0.03  # standard deviation of the patches' brightness over its mean


def contrast(texture, patches):
    light = texture[..., :3].mean(axis=2)
    side = light.shape[0] // patches
    means = light.reshape(patches, side, patches, side).mean(axis=(1, 3))
    return means.std() / means.mean()


def likeness_along_courses(texture):
    """Mean correlation of the brightness across the courses, here and elsewhere along them."""
    light = texture[..., :3].mean(axis=2)
    profiles = light.reshape(light.shape[0], PATCHES, -1).mean(axis=2)
    return np.corrcoef(profiles.T)[np.triu_indices(PATCHES, 1)].mean()


class Paving(unittest.TestCase):
    def test_is_even_from_afar_and_stony_from_nearby(self):
        for name in ("setts", "cobble"):
            for seed in (1, 7):
                with self.subTest(name, seed=seed):
                    texture = textures.make(name, SIZE_PX, seed)
                    self.assertLess(contrast(texture, PATCHES), MOST_CONTRAST)
                    self.assertGreater(contrast(texture, SIZE_PX), 0.2)

    def test_courses_of_setts_run_straight(self):
        """Those that waver look like waves or scales from a man's height."""
        for seed in (1, 7):
            self.assertGreater(likeness_along_courses(textures.make("setts", SIZE_PX, seed)), 0.7)


if __name__ == "__main__":
    unittest.main()
