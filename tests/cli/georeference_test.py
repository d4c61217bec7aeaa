"""Towns on the map: longitudes and latitudes beside the local obstacles, of `flaneur footprints` and of a bake."""
import json
import unittest

from scenes import write_box_town, write_person
from support import ProgramTest, run, shared_data

METRE_NORTH_DEG = 1 / 110574.4  # at the equator
TOUR = """
[tour]
name = "placed"
[town]
file = "town.glb"
%s
[[avatar]]
file = "person.glb"
[crowd]
people = 4
[impostor]
directions = 4
height_px = 16
samples = 1
[[place]]
kind = "exit"
position_m = [0, -20]
[[place]]
kind = "exit"
position_m = [0, 20]
[[stop]]
position_m = [-10, -15]
[[stop]]
position_m = [10, -15]
"""


def points(collection):
    for feature in collection["features"]:
        for ring in feature["geometry"]["coordinates"]:
            yield from ring


def city(path, at, system="EPSG:25832", scale=1.0):
    """A CityJSON town of one box, 8 by 6 units, with a corner at this place."""
    vertices = [[u, v, w] for w in (0, 7) for u, v in ((0, 0), (8, 0), (8, 6), (0, 6))]
    faces = [[[0, 3, 2, 1]], [[4, 5, 6, 7]]] + [[[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i]] for i in range(4)]
    house = {"type": "Building", "geometry": [{"type": "Solid", "lod": "2", "boundaries": [faces]}]}
    path.write_text(json.dumps({
        "type": "CityJSON", "version": "2.0", "metadata": {"referenceSystem": system} if system else {}, "vertices": vertices,
        "transform": {"scale": [scale, scale, 1], "translate": [*at, 0]}, "CityObjects": {"house": house}}))
    return path


class Georeference(ProgramTest):
    def footprints(self, town, *arguments):
        out = self.folder / "obstacles.geojson"
        return run("flaneur", "footprints", town, "-o", out, *arguments)

    def written(self, name="obstacles"):
        return [json.loads(path.read_text()) if path.exists() else None
                for path in (self.folder / f"{name}.geojson", self.folder / f"{name}_wgs84.geojson")]

    def assert_on_earth(self, local, on_earth, longitude=9.0):
        """Near the middle of zone 32 and the equator, where degrees are easily told: same points, same order."""
        east, north = local["flaneur"]["origin_m"]
        for (x, y), (lon, lat) in zip(points(local), points(on_earth), strict=True):
            self.assertAlmostEqual(lon, longitude + (x + east - 500000) / 0.9996 / 111319.49, delta=2e-8)
            self.assertAlmostEqual(lat, (y + north) / 0.9996 * METRE_NORTH_DEG, delta=2e-8)

    def test_a_city_model_that_names_its_system(self):
        for name in ("EPSG:25832", "urn:ogc:def:crs:EPSG::25832", "https://www.opengis.net/def/crs/EPSG/0/25832", "EPSG:5555"):
            with self.subTest(name):  # 25832 is for places north of 38 degrees, so far up
                result = self.footprints(city(self.folder / "town.json", (500000, 5760000), name))
                self.assert_succeeds(result)
                self.assertEqual(result.stderr, "")
                local, on_earth = self.written()
                self.assertEqual(local["flaneur"]["units"], "m")
                for lon, lat in points(on_earth):
                    self.assertAlmostEqual(lon, 9, delta=2e-4)
                    self.assertAlmostEqual(lat, 51.99, delta=0.01)
                check = run("flaneur", "check", self.folder / "obstacles_wgs84.geojson", "--town", self.folder / "town.json")
                self.assertIn("0 errors, 0 warnings", check.stdout, "the same obstacles, by another way")

    def test_a_model_without_a_place_gets_one(self):
        town = self.folder / "town.glb"
        write_box_town(town)
        self.assert_succeeds(self.footprints(town))
        self.assertIsNone(self.written()[1])
        self.assert_succeeds(self.footprints(town, "--crs", "EPSG:32632", "--origin-m", 500000, 1000))
        local, on_earth = self.written()
        self.assertEqual(local["flaneur"]["origin_m"], [500000, 1000])
        self.assert_on_earth(local, on_earth)

    def test_the_file_is_not_believed(self):
        town = city(self.folder / "town.json", (500000, 5760000), "EPSG:31467")  # whose eastings begin with 3
        self.assert_fails(self.footprints(town), "EPSG:31467", "outside the area", town)
        self.assertEqual(self.written(), [None, None])
        self.assert_succeeds(self.footprints(town, "--crs", "none"))
        self.assertIsNone(self.written()[1])
        self.assert_succeeds(self.footprints(town, "--crs", "EPSG:25832"))
        self.assertIsNotNone(self.written()[1])

    def test_a_name_in_the_file_that_nothing_can_be_made_of(self):
        for at, name in (((500000, 5760000), "our own"), ((0, 0), "EPSG:25832")):
            with self.subTest(name):
                result = self.footprints(city(self.folder / "town.json", at, name))
                self.assert_succeeds(result)
                self.assertIn("warning: longitudes and latitudes are not known", result.stderr)
                self.assertIsNone(self.written()[1])

    def test_wrong_systems(self):
        town = city(self.folder / "town.json", (500000, 5760000))
        for arguments, words in ((["--crs", "EPSG:4326"], ["degrees", "EPSG:25832"]), (["--crs", "EPSG:99999"], ["not known"]),
                                 (["--crs", "EPSG:28992"], ["outside the area"]), (["--crs", "EPSG:2263"], ["foot", "metres"]),
                                 (["--origin-m", 7, 7], ["origin", "(500000, 5760000)"])):
            with self.subTest(arguments):
                self.assert_fails(self.footprints(town, *arguments), *words)
                self.assertEqual(self.written(), [None, None])
        bare = self.folder / "town.glb"
        write_box_town(bare)
        self.assert_fails(self.footprints(bare, "--crs", "EPSG:25832"), "origin is missing")
        self.assert_fails(self.footprints(bare, "--crs", "EPSG:25832", "--origin-m", 10.5, 52.1), "looks like degrees")

    def test_coordinates_that_may_be_a_neighbouring_zones(self):
        for east, warned in ((192000, True), (270000, True), (290000, False), (340000, False), (603900, False), (709000, False), (800000, True)):
            with self.subTest(east):
                result = self.footprints(city(self.folder / "town.json", (east, 5780000)))
                self.assert_succeeds(result)
                self.assertEqual(["neighbouring zone" in line for line in result.stderr.splitlines()], [True] if warned else [])

    def test_feet_for_metres(self):
        feet = 1 / 0.3048
        self.assert_fails(self.footprints(city(self.folder / "town.json", (603900 * feet, 5780000 * feet))), "EPSG:25832", "outside the area")

    def test_degrees_in_a_city_model(self):
        for system in ("EPSG:4326", "EPSG:25832", None):
            with self.subTest(system):
                town = city(self.folder / "town.json", (10.5, 52.1), system, scale=1e-5)
                self.assert_fails(self.footprints(town), "degrees")

    def test_a_tile(self):
        town = shared_data("towns/nrw-lod2/LoD2_32_354_5652_1_NW.gml")
        self.assert_succeeds(self.footprints(town))
        local, on_earth = self.written()
        self.assertEqual(len(on_earth["features"]), len(local["features"]))
        for lon, lat in points(on_earth):  # Cologne
            self.assertTrue(6.9 < lon < 7 and 51 < lat < 51.1)

    def test_a_bake(self):
        write_box_town(self.folder / "town.glb")
        write_person(self.folder / "person.glb")
        tour, out = self.folder / "tour.toml", self.folder / "out"
        tour.write_text(TOUR % 'georeference = { crs = "EPSG:32632", origin_m = [10.5, 52.1] }')
        self.assert_fails(run("flaneur", "bake", tour, "-o", out, "--allow-outside"), "town.georeference", "looks like degrees")
        tour.write_text(TOUR % 'georeference = { crs = "EPSG:32632", origin_m = [500000, 1000] }')
        self.assert_succeeds(run("flaneur", "bake", tour, "-o", out, "--allow-outside"))
        local = json.loads((out / "footprints.geojson").read_text())
        self.assertEqual(local["flaneur"]["origin_m"], [500000, 1000])
        on_earth = out / "footprints_wgs84.geojson"
        self.assert_on_earth(local, json.loads(on_earth.read_text()))
        tour.write_text(TOUR % "")
        self.assert_succeeds(run("flaneur", "bake", tour, "-o", out, "--allow-outside"))
        self.assertEqual(json.loads((out / "footprints.geojson").read_text())["flaneur"]["origin_m"], [0, 0])
        self.assertFalse(on_earth.exists(), "it would be another town's")


if __name__ == "__main__":
    unittest.main()
