"""Paths drawn in a town so small that one knows where a visitor can walk."""
import pathlib
import sys
import tomllib
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from figures import drawn_paths  # noqa: E402

HOUSE = {"name": "house", "kind": "building", "outer_m": [[-12, 4], [-4, 4], [-4, 12], [-12, 12]]}
WELL = {"name": "well", "kind": "well", "center_m": [0, 0], "radius_m": 1.0}
GROUND = {"min_m": [-20, -20], "cell_m": 0.5, "columns": 80, "rows": 70, "kinds": b"\1" * 80 * 70}
TOUR = {"ground": GROUND, "obstacles": [HOUSE, WELL], "path": [{"position_m": [-10, -10]}, {"position_m": [15, 2]}],
        "places": [{"kind": "loiter", "position_m": [0, 2]}, {"kind": "door", "position_m": [-8, 4]}]}


def in_house(point):
    return -12 < point[0] < -4 and 4 < point[1] < 12


class DrawnPaths(unittest.TestCase):
    def test_every_kind_is_drawn_and_readable(self):
        paths = drawn_paths.drawn(TOUR, 2 * len(drawn_paths.KINDS), 5)
        kinds = {name.split("-", 1)[1].rsplit("-", 1)[0] for name, _ in paths}
        self.assertEqual(kinds, set(drawn_paths.KINDS))
        self.assertEqual({tomllib.loads(text)["people"] for _, text in paths}, set(drawn_paths.PEOPLE))
        for name, text in paths:
            with self.subTest(name):
                scenario = tomllib.loads(text)
                self.assertTrue(scenario["camera"]["leg"])
                way = [scenario["camera"]["position_m"]] + [leg["walk_to_m"] for leg in scenario["camera"]["leg"] if "walk_to_m" in leg]
                self.assertFalse(any(in_house(point) for point in way), "into the house")
                for (ax, ay), (bx, by) in zip(way, way[1:]):
                    self.assertFalse(in_house(((ax + bx) / 2, (ay + by) / 2)), "through the house")

    def test_nobody_walks_off_the_ground(self):
        for name, text in drawn_paths.drawn(TOUR, 4 * len(drawn_paths.KINDS), 9):
            with self.subTest(name):
                scenario = tomllib.loads(text)
                places = [scenario["camera"]["position_m"]] + [leg["walk_to_m"] for leg in scenario["camera"]["leg"] if "walk_to_m" in leg]
                places += [goal for person in scenario.get("person", []) for goal in person["goals_m"]]
                self.assertEqual([p for p in places if not (-20 < p[0] < 20 and -20 < p[1] < 15)], [])

    def test_nobody_walks_into_the_water(self):
        canal = bytearray(GROUND["kinds"])
        for row in range(70):
            canal[row * 80 + 60:row * 80 + 64] = bytes(4)  # 10 to 12 m east
        for name, text in drawn_paths.drawn({**TOUR, "ground": {**GROUND, "kinds": bytes(canal)}}, 4 * len(drawn_paths.KINDS), 11):
            with self.subTest(name):
                scenario = tomllib.loads(text)
                way = [scenario["camera"]["position_m"]] + [leg["walk_to_m"] for leg in scenario["camera"]["leg"] if "walk_to_m" in leg]
                self.assertIn({x < 10 for x, _ in way}, ({True}, {False}), "over the canal")

    def test_the_seed_alone_decides(self):
        self.assertEqual(drawn_paths.drawn(TOUR, 12, 3), drawn_paths.drawn(TOUR, 12, 3))
        self.assertNotEqual([text for _, text in drawn_paths.drawn(TOUR, 12, 3)], [text for _, text in drawn_paths.drawn(TOUR, 12, 4)])

    def test_a_town_without_room_is_refused(self):
        full = {**TOUR, "obstacles": [{**HOUSE, "outer_m": [[-99, -99], [99, -99], [99, 99], [-99, 99]]}]}
        with self.assertRaises(ValueError):
            drawn_paths.drawn(full, 3, 1)
        with self.assertRaises(ValueError):
            drawn_paths.drawn({**TOUR, "obstacles": [], "path": [], "places": []}, 3, 1)


if __name__ == "__main__":
    unittest.main()
