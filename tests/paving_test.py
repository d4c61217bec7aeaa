"""From afar a pavement is of one brightness: its texture repeats over the square, and whatever is wider than its stones would make waves.

paving_test.py SOURCE
"""
import pathlib
import sys
import unittest

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


class Paving(unittest.TestCase):
    def test_is_even_from_afar_and_stony_from_nearby(self):
        for name in ("setts", "cobble"):
            for seed in (1, 7):
                with self.subTest(name, seed=seed):
                    texture = textures.make(name, SIZE_PX, seed)
                    self.assertLess(contrast(texture, PATCHES), MOST_CONTRAST)
                    self.assertGreater(contrast(texture, SIZE_PX), 0.2)


if __name__ == "__main__":
    unittest.main()
