"""Details of the town's solids that one sees from afar, because they are thinner than a pixel there, or from close by.

town_shapes_test.py SOURCE
"""
import pathlib
import random
import sys
import unittest
from types import SimpleNamespace

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(sys.argv.pop(1)) / "blender_scripts/town"))
import house  # noqa: E402
import layout  # noqa: E402
import nature  # noqa: E402
import square  # noqa: E402
import town_wall  # noqa: E402
from mesh import Mesh  # noqa: E402


def faces(mesh):
    """(material, corners, normals or None) of each polygon."""
    start = 0
    for k, size in enumerate(mesh.sizes):
        yield mesh.materials[k], np.array(mesh.points[start:start + size]), mesh.normals.get(k)
        start += size


def normal(corners):
    n = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    return n / np.linalg.norm(n)


class TownShapes(unittest.TestCase):
    def test_no_coping_has_a_level_underside(self):
        """It would be a dark line of less than a pixel, which breaks into dashes."""
        wall = town_wall.make_line_wall(np.array([(0.0, 0.0), (8.0, 0.0), (14.0, 2.0)]), 2.0, 0.4, (1, 1, 1))
        self.assertGreater(min(normal(corners)[2] for _, corners, _ in faces(wall)), -0.9)

    def test_posts_of_two_walls_meet_at_a_corner(self):
        """A notch between them shows a line of plaster."""
        plot = SimpleNamespace(width=7.0, depth=8.0, left_open=True, right_open=True, back_open=False, left_seen=True,
                               right_seen=False, kind="", gateway=False)
        for seed in range(4):
            made = house.House(plot, random.Random(seed), 3, "eaves")
            for level in range(3):
                house.sides(made, level)
            timber = np.concatenate([corners for material, corners, _ in faces(made.mesh) if material == "timber"])
            for level in (1, 2):
                y, low, high = made.fronts[level], made.bases[level], made.bases[level] + made.heights[level]
                for x in (-house.CORNER, 7.0 + house.CORNER):
                    at_corner = timber[np.hypot(timber[:, 0] - x, timber[:, 1] - y + house.CORNER) < 1e-6][:, 2]
                    self.assertLess(min(abs(at_corner - low)), 1e-6)
                    self.assertGreaterEqual(max(at_corner), high - 1e-6)

    def test_walls_pass_before_a_house_whose_corner_parts_them(self):
        """It poked out between their ends."""
        corner = np.array((0.1, -0.1))
        walls = layout.before_corners([np.array([(0.0, 3.0), (0.0, 0.2)]), np.array([(0.0, 0.0), (0.0, -2.0)])])
        made = [np.array(town_wall.make_line_wall(line, 2.0, 0.4, (1, 1, 1)).points) for line in walls]
        self.assertGreater(min(points[:, 0].max() for points in made), corner[0])
        outer = [points[np.abs(points[:, 1] - corner[1]) < 0.3][:, 0] for points in made]
        self.assertTrue(any(len(x) and x.min() < corner[0] - 0.05 < corner[0] < x.max() for x in outer), outer)

    def test_bark_runs_on_round_a_trunk_and_up_it(self):
        """Each ring had its own scale, and showed where the next began."""
        mesh, at = Mesh(), {}
        nature._trunk(mesh, [((0, 0, 0), 0.33), ((0, 0, 0.4), 0.27), ((0, 0, 2.0), 0.2)], 9, (1, 1, 1))
        for point, uv in zip(mesh.points, mesh.uvs):
            at.setdefault(tuple(np.round(point, 5)), set()).add(tuple(np.round(np.mod(np.add(uv, 1e-5), 1.0), 4)))
        self.assertEqual([uvs for uvs in at.values() if len(uvs) > 1], [])

    def test_fruit_is_round(self):
        """Where two facets meet, the light on them is the same."""
        mesh = Mesh()
        square.heap(mesh, 0.0, 0.3, 0.0, 0.3, 0.0, random.Random(1))
        light = {}
        for _, corners, normals in faces(mesh):
            for corner, n in zip(corners, normals):
                light.setdefault(tuple(np.round(corner, 5)), []).append(n)
        sharp = [ns for ns in light.values() if min(np.array(ns) @ np.array(ns[0])) < 0.98 and len(ns) < 8]  # not the tip
        self.assertEqual(sharp, [])


if __name__ == "__main__":
    unittest.main()
