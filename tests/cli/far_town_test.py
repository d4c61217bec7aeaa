"""A town whose file has it far from zero, in map coordinates: baked near zero, where floats are fine enough."""
import json
import unittest

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


if __name__ == "__main__":
    unittest.main()
