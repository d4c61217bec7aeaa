"""Towns on the map: longitudes and latitudes beside the local obstacles, of `flaneur footprints` and of a bake."""
import json
import os
import pathlib
import unittest

from scenes import cities, write_box_town, write_person
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
    def test_whoever_reads_the_output_gets_nothing_else(self):
        town = city(self.folder / "town.json", (500000, 5760000), "EPSG:25832")
        read = run("flaneur", "footprints", town, "-o", "/dev/stdout")
        self.assert_succeeds(read)
        self.assertEqual(json.loads(read.stdout)["type"], "FeatureCollection")
        self.assertIn("obstacles from", read.stderr)
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        try:
            self.assert_succeeds(run("flaneur", "footprints", town, "-o", pipe))
        finally:
            os.close(reader)
        self.assertEqual([p.name for p in self.folder.glob("*wgs84*")], [], "none beside a pipe or /dev/stdout")
        self.assertEqual(list(pathlib.Path("/dev").glob("*wgs84*")), [])
        self.assert_succeeds(self.footprints(town))
        checked = run("flaneur", "check", self.folder / "obstacles.geojson", "--town", town, "--json", "/dev/stdout")
        self.assertEqual(json.loads(checked.stdout)["findings"], [])
        self.assertIn("0 errors", checked.stderr)

    def footprints(self, *arguments):
        out = self.folder / "obstacles.geojson"
        return run("flaneur", "footprints", *arguments, "-o", out)

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

    def test_a_map_in_millimetres(self):
        house = [(u, v, w) for w in (0, 7000) for u, v in ((0, 0), (8000, 0), (8000, 6000), (0, 6000))]
        faces = [(1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]
        town, out = self.folder / "town.obj", self.folder / "obstacles.geojson"
        town.write_text("".join(f"v {350e6 + x} {5650e6 + y} {z}\n" for x, y, z in house) + "o house\n" +
                        "".join("f " + " ".join(map(str, face)) + "\n" for face in faces))
        result = run("flaneur", "footprints", town, "-o", out, "--scale", 0.001, "--up", "z", "--clearance-m", 0)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = json.loads(out.read_text())
        east, north = found["flaneur"]["origin_m"]
        corners = {(round(x + east), round(y + north)) for x, y in points(found)}
        self.assertEqual(corners, {(350000 + x, 5650000 + y) for x in (0, 8) for y in (0, 6)})

    def test_feet_for_metres(self):
        feet = 1 / 0.3048
        self.assert_fails(self.footprints(city(self.folder / "town.json", (603900 * feet, 5780000 * feet))), "EPSG:25832", "outside the area")

    # ---- There and back ----

    def assert_own_output_is_right(self, town, *arguments):
        """Both files, with and without the town: nothing of walls, places and overlaps."""
        for name in ("obstacles", "obstacles_wgs84"):
            for more in ([], ["--town", town]):
                found = self.folder / "findings.json"
                run("flaneur", "check", self.folder / f"{name}.geojson", *more, *arguments, "--json", found)
                findings = json.loads(found.read_text())["findings"]
                self.assertEqual([f["message"] for f in findings if 300 < f["code"] < 306 or f["code"] in (401, 402) or f["code"] > 900],
                                 [], (name, more))

    def test_own_output_in_systems_with_a_datum_shift(self):
        for system, at in (("EPSG:2056", (2683000, 1248000)), ("EPSG:7415", (84500, 446000)), ("EPSG:28992", (155000, 463000)),
                           ("EPSG:31467", (3500000, 5400000)), ("EPSG:3068", (25000, 20000)), ("EPSG:27700", (530000, 180000)),
                           ("EPSG:31256", (2000, 341000)), ("EPSG:5514", (-743000, -1043000)), ("EPSG:6677", (-6000, -35000))):
            with self.subTest(system):
                town = cities(self.folder / "town.json", at, system)
                self.assert_succeeds(self.footprints(town))
                self.assert_own_output_is_right(town)

    def test_a_system_that_only_the_extraction_was_told(self):
        bare = self.folder / "town.glb"
        write_box_town(bare)
        self.assert_succeeds(self.footprints(bare, "--crs", "EPSG:2056", "--origin-m", 2683000, 1248000))
        self.assert_own_output_is_right(bare)
        town = cities(self.folder / "town.json", (3500000, 5400000), "EPSG:25832")  # its file names the wrong one
        self.assert_succeeds(self.footprints(town, "--crs", "EPSG:31467"))
        self.assert_own_output_is_right(town)

    # ---- Systems that are no metres, or not east and north ----

    def test_degrees_become_the_fitting_system_in_metres(self):
        for system, at, step, to in (("EPSG:6697", (35.68, 139.76), (8.98e-6, 1.108e-5), "EPSG:6691"),
                                     ("EPSG:4326", (52.1, 10.5), (8.98e-6, 1.46e-5), "EPSG:32632"),
                                     ("EPSG:4979", (-33.4, -70.6), (9.0e-6, 1.07e-5), "EPSG:32719"),
                                     ("OGC:CRS84", (10.5, 52.1), (1.46e-5, 8.98e-6), "EPSG:32632")):
            with self.subTest(system):
                town = cities(self.folder / "town.json", at, system, scale=step, turned=True)
                result = self.footprints(town)
                self.assert_succeeds(result)
                self.assertIn(f"the town is in {system}; its obstacles are in {to}, in metres", result.stdout)
                local, on_earth = self.written()
                self.assertEqual((local["flaneur"]["crs"], local["flaneur"]["source_crs"]), (to, system))
                lat, lon = at if system != "OGC:CRS84" else at[::-1]
                for x, y in points(on_earth):
                    self.assertAlmostEqual(x, lon, delta=2e-3)
                    self.assertAlmostEqual(y, lat, delta=2e-3)
                self.assert_own_output_is_right(town)

    def test_degrees_of_an_unnamed_system(self):
        town = cities(self.folder / "town.json", (10.5, 52.1), None, scale=(1.46e-5, 8.98e-6), turned=True)
        result = self.footprints(town)
        self.assert_succeeds(result)
        self.assertIn("look like degrees and were taken for EPSG:4326", result.stderr)
        self.assert_own_output_is_right(town)
        self.assert_succeeds(self.footprints(town, "--crs", "EPSG:4258"))
        self.assertEqual(self.written()[0]["flaneur"]["crs"], "EPSG:25832")

    def test_degrees_in_a_system_of_metres(self):
        town = city(self.folder / "town.json", (10.5, 52.1), "EPSG:25832", scale=1e-5)
        self.assert_fails(self.footprints(town), "degrees", "'EPSG:25832' has metres", "--crs EPSG:4326")

    def test_stretched_mirrored_and_turned_maps(self):
        for system, at in (("EPSG:3857", (1172000, 6830000)), ("EPSG:2065", (1043000, 743000)), ("EPSG:2048", (47400, 3750000))):
            with self.subTest(system):
                town = cities(self.folder / "town.json", at, system)
                self.assert_succeeds(self.footprints(town))
                self.assertEqual(self.written()[0]["flaneur"]["source_crs"], system)
                self.assert_own_output_is_right(town)

    def test_northings_before_eastings(self):
        town = cities(self.folder / "town.json", (5780000, 603900), "EPSG:25832")
        result = self.footprints(town)
        self.assert_succeeds(result)
        self.assertIn("northings stand before eastings", result.stderr)
        self.assertEqual(self.written()[0]["flaneur"]["origin_m"], [603900, 5780000])
        self.assert_own_output_is_right(town)

    def test_japanese_models(self):
        for tile, system in (("plateau-lod1/53395404_bldg_6697_op.gml", "EPSG:6691"), ("plateau+osm-pair/53392547_bldg_6697_op2.gml", "EPSG:6691")):
            with self.subTest(tile):
                town = shared_data(f"towns/{tile}")
                self.assert_succeeds(self.footprints(town))
                local, on_earth = self.written()
                self.assertEqual(local["flaneur"]["crs"], system)
                for lon, lat in points(on_earth):
                    self.assertTrue(139 < lon < 140 and 35 < lat < 36)
                self.assert_own_output_is_right(town)

    # ---- Tiles of one city ----

    def test_tiles(self):
        west = cities(self.folder / "west.json", (603900, 5780000), "EPSG:25832")
        east = cities(self.folder / "east.json", (603980, 5780000), "EPSG:25832")  # two of its houses stand in both
        result = self.footprints(west, east)
        self.assert_succeeds(result)
        self.assertIn("2 things stand in two tiles", result.stderr)
        local = self.written()[0]
        self.assertEqual(len(local["features"]), 10)
        self.assertEqual(len({f["properties"]["name"] for f in local["features"]}), 10)
        bytes_ = (self.folder / "obstacles.geojson").read_bytes()
        self.assert_succeeds(self.footprints(west, east, "--threads", 1))
        self.assertEqual(bytes_, (self.folder / "obstacles.geojson").read_bytes())
        self.assertFalse([f for f in self.findings() if f["code"] in (401, 402)])
        self.assert_fails(self.footprints(west, west), "named twice", west)
        other = cities(self.folder / "other.json", (0, 0), None)
        self.assert_fails(self.footprints(west, other), "map coordinates", other)

    def findings(self):
        run("flaneur", "check", self.folder / "obstacles.geojson", "--json", self.folder / "findings.json")
        return json.loads((self.folder / "findings.json").read_text())["findings"]

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
