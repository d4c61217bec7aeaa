"""A town whose file has it far from zero, in map coordinates: baked near zero, where floats are fine enough."""
import json
import unittest

from scenes import cities
from small_tour import SmallTourTest
from support import run, split_glb, write_glb

EAST, NORTH, UP = 350000, 5790000, 3640
PLACES = """
[[stop]]
position_m = [%(x)d, %(y)d]
caption = "Here."
[[stop]]
position_m = [%(x2)d, %(y2)d]
caption = "There."
[[place]]
name = "well"
kind = "goal"
position_m = [%(x)d, %(y2)d]
[[hotspot]]
position_m = [%(x2)d, %(y)d]
title = "A well"
[[smoke]]
position_m = [%(x)d.5, %(y)d.5, %(z)d]
[[street]]
name = "Lane"
points_m = [[%(x)d, %(y)d], [%(x2)d, %(y2)d]]
"""


def places(east, north, up):
    return PLACES % {"x": east - 10, "y": north + 15, "x2": east + 20, "y2": north - 12, "z": up + 12}


class FarTown(SmallTourTest):
    of_town = ""

    def setUp(self):
        super().setUp()
        self.town = self.tour.parent / "town.glb"
        gltf, binary = split_glb(self.town)
        gltf["nodes"].append({"name": "map", "translation": [EAST, UP, -NORTH], "children": gltf["scenes"][0]["nodes"]})
        gltf["scenes"][0]["nodes"] = [len(gltf["nodes"]) - 1]
        write_glb(self.town, gltf, binary)

    def baked(self, more):
        self.write_tour(more)
        self.assert_succeeds(self.bake())
        obstacles = json.loads((self.out / "footprints.geojson").read_text())
        return split_glb(self.out / "small.glb")[0]["extensions"]["FLANEUR_tour"], obstacles

    def assert_near(self, tour):
        found = [stop["position_m"] for stop in tour["path"]] + [tour["hotspots"][0]["position_m"]]
        found += [place["position_m"] for place in tour["places"] if place["name"] == "well"]
        found += [tour["smokes"][0]["position_m"][:2]] + tour["streets"][0]["points_m"]
        self.assertEqual(len(found), 7)
        for x, y in found:
            self.assertLess(max(abs(x), abs(y)), 150)
        self.assertAlmostEqual(tour["smokes"][0]["position_m"][2], UP % 100 + 12, delta=0.01)

    def test_places_as_in_the_file_or_as_in_the_moved_town(self):
        far, obstacles = self.baked(places(EAST, NORTH, UP))
        self.assert_near(far)
        self.assertEqual(obstacles["flaneur"]["origin_m"], [EAST, NORTH])
        for house in obstacles["features"]:
            self.assertAlmostEqual(house["properties"]["ground_z_m"], UP, delta=0.01)
        near, _ = self.baked(places(0, 0, 40))
        for a, b in zip(far["path"], near["path"]):
            for k in range(2):
                self.assertAlmostEqual(a["position_m"][k], b["position_m"][k], delta=0.5)  # floats, that far away

    def test_its_own_obstacles_fit_the_file(self):
        self.baked(places(EAST, NORTH, UP))
        for more in ([], ["--origin-m", "100", "200"]):
            direct = self.folder / "direct.geojson"
            self.assert_succeeds(run("flaneur", "footprints", self.town, "-o", direct, *more))
            for obstacles in (self.out / "footprints.geojson", direct):
                checked = run("flaneur", "check", obstacles, "--town", self.town)
                self.assertNotIn("907", checked.stdout)
                self.assertEqual(checked.returncode, 0, checked.stdout)

    def test_map_coordinates_are_the_places_on_earth_unless_an_origin_is_stated(self):
        self.of_town = 'georeference = { crs = "EPSG:25832" }'
        _, obstacles = self.baked("")
        self.assertEqual(obstacles["flaneur"]["origin_m"], [EAST, NORTH])
        self.assertTrue((self.out / "footprints_wgs84.geojson").exists())
        self.of_town = 'georeference = { crs = "EPSG:25832", origin_m = [200000, -300000] }'
        _, obstacles = self.baked("")
        self.assertEqual(obstacles["flaneur"]["origin_m"], [EAST + 200000, NORTH - 300000])

    def write_tour(self, more=""):
        super().write_tour(more)
        self.tour.write_text(self.tour.read_text().replace('file = "town.glb"', 'file = "town.glb"\n' + self.of_town, 1))


class TilesOfATour(SmallTourTest):
    """Models that have their places on a map stand as there, whichever comes first and in whichever format and system."""

    def setUp(self):
        super().setUp()
        self.folder_of_tour = self.tour.parent
        self.west = cities(self.folder_of_tour / "west.json", (603900, 5780000), "EPSG:25832")
        self.east = cities(self.folder_of_tour / "east.json", (603980, 5780000), "EPSG:25832")  # two houses stand in both
        gltf, binary = split_glb(self.folder_of_tour / "town.glb")  # ground and houses of its own, 100 m north
        gltf["nodes"].append({"name": "map", "translation": [603980, 0, -5780100], "children": gltf["scenes"][0]["nodes"]})
        gltf["scenes"][0]["nodes"] = [len(gltf["nodes"]) - 1]
        write_glb(self.folder_of_tour / "north.glb", gltf, binary)

    def places(self, town, parts):
        """Of obstacles on the map, by name."""
        parts = "".join(f'[[town.part]]\nfile = "{part}"\n{more}\n' for part, more in parts)
        self.write_tour(parts)
        of_town = f'file = "{town}"' if town else ""
        self.tour.write_text(self.tour.read_text().replace('file = "town.glb"', of_town, 1))
        self.assert_succeeds(self.bake())
        obstacles = json.loads((self.out / "footprints.geojson").read_text())
        x, y = obstacles["flaneur"]["origin_m"]
        return {f["properties"]["name"]: (x + min(p[0] for p in f["geometry"]["coordinates"][0]),
                                          y + min(p[1] for p in f["geometry"]["coordinates"][0])) for f in obstacles["features"]}

    def assert_stand(self, places):
        """The ten houses of west and east."""
        for k in range(5):
            for row in range(2):
                near = [p for p in places.values() if abs(p[0] - (603900 + 40 * k)) < 0.2 and abs(p[1] - (5780000 + 30 * row)) < 0.2]
                self.assertEqual(len(near), 1, (k, row, places))

    def test_stand_as_on_the_map(self):
        for town, parts in (("west.json", ["east.json"]), ("", ["west.json", "east.json"]), ("", ["east.json", "west.json"])):
            with self.subTest(town=town, parts=parts):
                places = self.places(town, [(part, "") for part in parts])
                self.assertEqual(len(places), 10)
                self.assert_stand(places)
                self.assert_fits(self.out / "footprints.geojson")
        direct = self.folder / "direct.geojson"
        self.assert_succeeds(run("flaneur", "footprints", self.west, self.east, "-o", direct))
        self.assert_fits(direct)

    def assert_fits(self, obstacles):
        found = self.folder / "found.json"
        self.assert_succeeds(run("flaneur", "check", "--town", self.west, "--town", self.east, obstacles, "--json", found))
        self.assertFalse([f for f in json.loads(found.read_text())["findings"] if f["code"] < 500 or f["code"] > 900])
        alone = run("flaneur", "check", "--town", self.west, obstacles, "--json", found)
        self.assertEqual(alone.returncode, 1, "four of the houses are not in this tile")

    def test_beside_models_in_other_formats_and_others_that_are_put_somewhere(self):
        places = self.places("", [("west.json", ""), ("town.glb", "position_m = [20.0, -70.0]"), ("north.glb", ""), ("east.json", "")])
        self.assertEqual(len(places), 10 + 4 + 4)
        self.assert_stand(places)
        rows = sorted(round(y) for _, y in places.values())
        self.assertEqual(rows.count(5780000 - 70 - 4), 4, rows)
        self.assertEqual(rows.count(5780000 + 100 - 4), 4, rows)

    def test_another_city_is_told_of(self):
        cities(self.folder_of_tour / "other.json", (303900, 5580000), "EPSG:25832")
        self.write_tour('[[town.part]]\nfile = "west.json"\n[[town.part]]\nfile = "other.json"\n')
        self.tour.write_text(self.tour.read_text().replace('file = "town.glb"', "", 1))
        result = self.bake()
        self.assert_fails(result, "other.json", "100 km", "position_m")


if __name__ == "__main__":
    unittest.main()
