"""`flaneur check` from outside: the cases of tests/data/check, what it writes, its exit status, coordinate systems, bad input."""
import json
import math
import re
import unittest

from support import SOURCE, ProgramTest, run, shared_data

CASES = SOURCE / "tests/data/check"
DOCUMENTED = re.findall(r"^### (\d+) .* \((error|warning)\)$", (SOURCE / "docs/findings.md").read_text(), re.MULTILINE)
WITH_STREET = {"301", "302", "303", "304", "305", "307", "907", "street"}
CANNOT_CHECK = {"901", "902"}
NO_TOLERANCE = {"306", "901", "902", "903", "904", "905", "906", "907"}


def house(x=0.0, y=0.0, name="house"):
    ring = [[x, y], [x + 8, y], [x + 8, y + 6], [x, y + 6], [x, y]]
    return {"type": "Feature", "properties": {"name": name}, "geometry": {"type": "Polygon", "coordinates": [ring]}}


def circle_of(points, radius=50.0):
    ring = [[radius * math.cos(2 * math.pi * i / points), radius * math.sin(2 * math.pi * i / points)] for i in range(points)]
    return {"type": "Feature", "properties": {"name": "round"}, "geometry": {"type": "Polygon", "coordinates": [ring + ring[:1]]}}


def city_of_two(path, system="EPSG:25832"):
    """A CityJSON town without terrain: two houses on a slope, 3 m of height and 4 m of way apart, at 604 km east."""
    vertices, objects = [], {}
    for name, x, z in (("upper", 0, 53), ("lower", 12, 50)):
        first = len(vertices)
        vertices += [[x + u, v, z + w] for w in (0, 7) for u, v in ((0, 0), (8, 0), (8, 6), (0, 6))]
        sides = [[0, 3, 2, 1], [4, 5, 6, 7]] + [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
        faces = [[[first + i for i in side]] for side in sides]
        semantics = {"surfaces": [{"type": "GroundSurface"}, {"type": "RoofSurface"}, {"type": "WallSurface"}],
                     "values": [[0, 1, 2, 2, 2, 2]]}
        solid = {"type": "Solid", "lod": "2", "boundaries": [faces], "semantics": semantics}
        objects[name] = {"type": "Building", "geometry": [solid]}
    metadata = {"referenceSystem": f"https://www.opengis.net/def/crs/EPSG/0/{system.split(':')[1]}"} if system else {}
    path.write_text(json.dumps({"type": "CityJSON", "version": "2.0", "metadata": metadata, "CityObjects": objects, "vertices": vertices,
                                "transform": {"scale": [1, 1, 1], "translate": [604000, 5779000, 0]}}))
    return path


def row_of_houses(path):
    """A CityJSON town of eight houses of their own sizes, askew, 20 m apart."""
    vertices, objects = [], {}
    for k in range(8):
        w, d, first = 8 + 0.6 * k, 10 - 0.4 * k, len(vertices)
        for z in (0, 7):
            vertices += [[round(603960 + 20 * k + 0.8 * u - 0.6 * v, 3), round(5779040 + 0.6 * u + 0.8 * v, 3), z]
                         for u, v in ((0, 0), (w, 0), (w, d), (0, d))]
        sides = [[0, 3, 2, 1], [4, 5, 6, 7]] + [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
        solid = {"type": "Solid", "lod": "2", "boundaries": [[[[first + i for i in side]] for side in sides]]}
        objects[f"house_{k}"] = {"type": "Building", "geometry": [solid]}
    path.write_text(json.dumps({"type": "CityJSON", "version": "2.0", "metadata": {"referenceSystem": "EPSG:25832"},
                                "CityObjects": objects, "vertices": vertices}))
    return path


def moved(features, x, y):
    """The same polygons elsewhere."""
    def shift(p):
        return [p[0] + x, p[1] + y]
    return [{**f, "geometry": {**f["geometry"], "coordinates": [[shift(p) for p in ring] for ring in f["geometry"]["coordinates"]]}}
            for f in features]


class Check(ProgramTest):
    def check(self, path, *arguments):
        out = self.folder / "findings.json"
        out.unlink(missing_ok=True)
        result = run("flaneur", "check", path, "--json", out, *arguments)
        findings = json.loads(out.read_text())["findings"] if out.exists() else None
        return result, findings

    def check_case(self, name):
        code = name.split("_")[0]
        town = CASES / (f"{name}.gltf" if (CASES / f"{name}.gltf").exists() else "street.gltf")
        with_town = code in WITH_STREET or town.name != "street.gltf"
        return self.check(CASES / f"{name}.geojson", *(["--town", town] if with_town else []))

    def check_obstacles(self, features, *arguments, members=None):
        path = self.folder / "obstacles.geojson"
        collection = {"type": "FeatureCollection", **({"flaneur": {"units": "m"}} if members is None else members)}
        path.write_text(json.dumps({**collection, "features": features}))
        return self.check(path, *arguments)

    @staticmethod
    def codes(findings):
        return sorted({str(f["code"]) for f in findings})

    def test_each_code_by_its_case_alone_once(self):
        for code, severity in DOCUMENTED:
            if code == "905":
                continue  # of options, not of files
            with self.subTest(code):
                result, findings = self.check_case(code)
                self.assertEqual(self.codes(findings), [code], findings)
                self.assertEqual(len(findings), 1)
                self.assertEqual(findings[0]["severity"], severity)
                status = 2 if code in CANNOT_CHECK else 1 if severity == "error" else 0
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertTrue(findings[0]["advice"])

    def test_nothing_where_nothing_is(self):
        for name in ["sound", "street"] + [f"{code}_none" for code, _ in DOCUMENTED]:
            if (CASES / f"{name}.geojson").exists():
                with self.subTest(name):
                    result, findings = self.check_case(name)
                    self.assertEqual((result.returncode, findings), (0, []))

    def test_either_side_of_each_tolerance(self):
        for code, _ in DOCUMENTED:
            if code in NO_TOLERANCE:
                continue
            with self.subTest(code):
                self.assertIn(code, self.codes(self.check_case(f"{code}_over")[1]))
                self.assertNotIn(code, self.codes(self.check_case(f"{code}_under")[1]))

    def test_each_number_can_be_set(self):
        for name, option, value in (
                ("102", "--same-point-m", 0.0004), ("106", "--least-area-m2", 0.005), ("107_over", "--largest-coordinate-m", 2e6),
                ("108", "--most-points", 300), ("201", "--least-area-m2", 1), ("203", "--spike-length-m", 1),
                ("301", "--tolerance-m", 0.5), ("302", "--clearance-m", 0.01), ("307_under", "--person-radius-m", 0.2),
                ("401", "--overlap-m2", 5), ("403", "--person-radius-m", 0.05), ("501", "--least-ground-m2", 100),
                ("502", "--dead-end-m", 20), ("503", "--high-resolution-radius-m", 25)):
            with self.subTest(option):
                town = ["--town", CASES / "street.gltf"] if name[:3] in WITH_STREET else []
                _, findings = self.check(CASES / f"{name}.geojson", option, value, *town)
                expected = "307" if name == "307_under" else None
                self.assertEqual(expected in self.codes(findings) if expected else name[:3] in self.codes(findings), bool(expected))

    def test_numbers_out_of_range(self):
        for option in ("--tolerance-m", "--person-radius-m", "--spike-width-m", "--dead-end-m", "--scale"):
            for value in ("0", "-1", "nan"):
                with self.subTest(option=option, value=value):
                    result, findings = self.check(CASES / "sound.geojson", f"{option}={value}")
                    self.assertEqual(result.returncode, 2)
                    self.assertEqual(self.codes(findings), ["905"])
                    self.assertIn(option[2:], result.stderr)

    def test_exit_status(self):
        self.assertEqual(self.check(CASES / "403.geojson")[0].returncode, 0)
        self.assertEqual(self.check(CASES / "403.geojson", "--warnings-as-errors")[0].returncode, 1)
        self.assertEqual(self.check(CASES / "401.geojson")[0].returncode, 1)
        self.assertEqual(self.check(self.folder / "none.geojson")[0].returncode, 2)

    def test_all_that_is_written(self):
        paths = {name: self.folder / name for name in ("f.json", "f.geojson", "map.svg", "map.html")}
        result = run("flaneur", "check", CASES / "401.geojson", "--json", paths["f.json"], "--geojson", paths["f.geojson"],
                     "--map", paths["map.svg"], "--html", paths["map.html"])
        self.assertIn("401 obstacles overlap: 1", result.stdout)
        self.assertIn("1 errors, 0 warnings", result.stdout)
        finding = json.loads(paths["f.json"].read_text())["findings"][0]
        self.assertEqual((finding["feature"], finding["other"]), ("house", "neighbour"))
        feature = json.loads(paths["f.geojson"].read_text())["features"][0]
        self.assertEqual(feature["geometry"]["coordinates"], finding["at_m"])
        self.assertEqual(feature["properties"]["code"], 401)
        page = paths["map.html"].read_text()
        self.assertNotIn("http", page.replace("http://www.w3.org/2000/svg", ""), "the page must need nothing from elsewhere")
        for text in (page, paths["map.svg"].read_text()):
            self.assertIn("house", text)
            self.assertIn("401", text)

    def test_faults_of_one_ring_are_all_reported(self):
        ring = [[0, 0], [0, 6], [0, 6.0005], [8, 6], [8, 0]]  # clockwise, open, two points coincide
        turned = {"type": "Feature", "properties": {"name": "turned"}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
        bow = {"type": "Feature", "properties": {"name": "bow"},
               "geometry": {"type": "Polygon", "coordinates": [[[20, 0], [28, 6], [28, 0], [20, 6], [20, 0]]]}}
        _, findings = self.check_obstacles([turned, bow, house(40, 0, "a"), house(47, 0, "b")])
        self.assertEqual(self.codes(findings), ["102", "103", "104", "105", "401"])

    # ---- Coordinate systems ----

    def test_degrees_become_true_metres(self):
        # One second of latitude and of longitude at 52 degrees north: 30.904 m and 19.087 m on WGS 84.
        second = 1 / 3600
        ring = [[10, 52], [10 + second, 52], [10 + second, 52 + second], [10, 52 + second], [10, 52]]
        far = [[10 + 2 * second, 52], [10 + 3 * second, 52], [10 + 3 * second, 52 + second], [10 + 2 * second, 52 + second],
               [10 + 2 * second, 52]]
        features = [{"type": "Feature", "properties": {"name": str(i)}, "geometry": {"type": "Polygon", "coordinates": [r]}}
                    for i, r in enumerate((ring, far))]
        _, findings = self.check_obstacles(features, "--person-radius-m", 8, "--least-ground-m2", 1e9, members={})
        gap = [f for f in findings if f["code"] == 404][0]
        self.assertAlmostEqual(gap["value"], 19.087, delta=0.01)
        self.assertAlmostEqual(gap["at_file"][0], 10 + 1.5 * second, delta=1e-7)

    def test_projected_metres_by_crs_and_by_option(self):
        crs = {"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}}
        features = [house(604000, 5779000, "a"), house(604007, 5779000, "b")]
        for arguments, members in (([], crs), (["--crs", "EPSG:25832"], {}), (["--units", "metres"], {})):
            with self.subTest(arguments):
                _, findings = self.check_obstacles(features, *arguments, members=members)
                self.assertEqual(self.codes(findings), ["401"])
                self.assertAlmostEqual(findings[0]["at_file"][0], 604007.5, delta=0.01)
                self.assertAlmostEqual(findings[0]["value"], 6, delta=0.001)

    def test_a_stretched_map_is_set_right(self):
        crs = {"crs": {"type": "name", "properties": {"name": "EPSG:3857"}}}
        _, findings = self.check_obstacles([house(1172000, 6830000, "a"), house(1172007, 6830000, "b")], members=crs)
        self.assertEqual(self.codes(findings), ["401"])
        self.assertLess(findings[0]["value"], 3, "6 m2 of the map are less than half of that on the ground, 52 degrees north")

    def test_other_coordinates_than_stated(self):
        crs = {"crs": {"type": "name", "properties": {"name": "EPSG:25832"}}}
        degrees = json.loads((CASES / "903_none.geojson").read_text())["features"]
        metres = [house(604000, 5779000)]
        for name, features, arguments, members in (
                ("metres without saying so", metres, [], {}), ("degrees as metres", degrees, ["--units", "metres"], {}),
                ("degrees in our own file", degrees, [], None), ("degrees in a projection", degrees, [], crs),
                ("metres as degrees", metres, ["--units", "degrees"], {}),
                ("a place far from the projection's", [house(604000, 100)], [], crs)):
            with self.subTest(name):
                result, findings = self.check_obstacles(features, *arguments, members=members)
                self.assertEqual((result.returncode, self.codes(findings)), (1, ["903"]))

    # ---- Bad input ----

    def test_bad_files(self):
        for text, code in (("no JSON", "901"), ("[]", "901"), ('{"type": "Feature', "901"), ('{"type": "FeatureCollection"}', "901"),
                           ('{"type": "FeatureCollection", "features": []}', "902"), ('{"a":' * 100000, "901"),
                           ('{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": null}]}', "902")):
            with self.subTest(text[:60]):
                path = self.folder / "obstacles.geojson"
                path.write_text(text)
                result, findings = self.check(path)
                self.assertEqual((result.returncode, self.codes(findings)), (2, [code]))
                self.assertEqual(len(result.stderr.strip().splitlines()), 1)

    def test_a_broken_feature_hides_no_other(self):
        torn = house(20, 0, "torn")
        torn["geometry"]["coordinates"] = [[["a", 1]]]
        _, findings = self.check_obstacles([torn, house(0, 0, "a"), house(7, 0, "b")])
        self.assertEqual([(f["code"], f["feature"]) for f in findings], [(401, "a"), (904, "torn")])

    def test_numbers_that_are_none(self):
        path = self.folder / "obstacles.geojson"
        for word in ("NaN", "Infinity", "-Infinity", "null"):
            with self.subTest(word):
                path.write_text(json.dumps({"type": "FeatureCollection", "flaneur": {}, "features": [house(0, 0, "NaN Infinity")]})
                                .replace("[8, 6]", f"[8, {word}]"))
                _, findings = self.check(path)
                self.assertEqual([(f["code"], f["feature"]) for f in findings], [(107, "NaN Infinity")])

    def test_huge_and_tiny(self):
        def square(side):
            ring = [[0, 0], [side, 0], [side, side], [0, side], [0, 0]]
            return {"type": "Feature", "properties": {"name": "square"}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
        self.assertEqual(self.check_obstacles([square(1000)])[1], [])
        self.assertEqual(self.codes(self.check_obstacles([square(0.001)])[1]), ["106"])
        self.assertEqual(self.codes(self.check_obstacles([circle_of(1_000_000)])[1]), ["102", "108"])
        self.assertEqual(self.codes(self.check_obstacles([circle_of(20_000)])[1]), ["108"])
        stray = house(0, 0, "stray")
        stray["geometry"]["coordinates"][0][2] = [8, 900000]
        self.assertNotIn("107", self.codes(self.check_obstacles([house(20, 0), stray])[1]))

    def test_empty_and_short_rings(self):
        for rings in ([], [[]], [[[0, 0]]], [[[0, 0], [8, 0]]], [[[0, 0], [8, 0], [0, 0]]], [[[1, 1]] * 6]):
            with self.subTest(rings):
                short = {"type": "Feature", "properties": {"name": "short"}, "geometry": {"type": "Polygon", "coordinates": rings}}
                _, findings = self.check_obstacles([house(20, 0), short])
                self.assertEqual([(f["code"], f["feature"]) for f in findings], [(101, "short")])

    # ---- Towns in map coordinates ----

    def extracted(self, town):
        out = self.folder / "extracted.geojson"
        self.assert_succeeds(run("flaneur", "footprints", town, "-o", out))
        return out, json.loads(out.read_text())

    def test_a_city_model_against_its_own_footprints(self):
        town = city_of_two(self.folder / "town.json")
        out, _ = self.extracted(town)
        result, findings = self.check(out, "--town", town)
        self.assertEqual((result.returncode, findings), (0, []), "each house stands on its own ground")

    def test_a_model_whose_up_axis_has_to_be_told(self):
        """A tower that lies or stands: the format does not say, and a judge may be wrong."""
        town, standing, lying = self.folder / "tower.obj", self.folder / "standing.geojson", self.folder / "lying.geojson"
        corners = [(x, y, z) for z in (0, 40) for x, y in ((0, 0), (8, 0), (8, 6), (0, 6))]
        faces = ((4, 3, 2, 1), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8))
        town.write_text("o tower\n" + "".join("v %g %g %g\n" % c for c in corners) + "".join("f %d %d %d %d\n" % f for f in faces))
        self.assert_succeeds(run("flaneur", "footprints", town, "-o", standing, "--up", "z"))
        self.assert_succeeds(run("flaneur", "footprints", town, "-o", lying, "--up", "y"))
        for obstacles, up, status in ((standing, "z", 0), (lying, "y", 0), (standing, "y", 1), (lying, "z", 1)):
            with self.subTest(obstacles=obstacles.name, up=up):
                self.assertEqual(run("flaneur", "check", obstacles, "--town", town, "--up", up).returncode, status)

    def test_open_shells_are_told_by_the_file_too(self):
        out, made = self.extracted(CASES / "306.gltf")
        self.assertTrue(any(f["properties"].get("open_shell") is True for f in made["features"]))
        for arguments in ([], ["--town", CASES / "306.gltf"]):
            _, findings = self.check(out, *arguments)
            self.assertEqual([f["code"] for f in findings if f["code"] < 400], [306])
        _, made = self.extracted(city_of_two(self.folder / "town.json"))
        self.assertFalse(any("open_shell" in f["properties"] for f in made["features"]))

    def test_origins_are_compared(self):
        town = city_of_two(self.folder / "town.json")
        _, made = self.extracted(town)
        east, north = made["flaneur"]["origin_m"]
        for name, by, codes in (("moved as it says", (0, 0), []), ("moved by less than it says", (0, 0.2), ["301", "303"]),
                                ("another town's", (5000, 0), ["907"]), ("another country's", (500000, 0), ["907"])):
            with self.subTest(name):
                member = {**made["flaneur"], "origin_m": [east - 37 + by[0], north + 250 + by[1]]}
                _, findings = self.check_obstacles(moved(made["features"], 37, -250), "--town", town, members={"flaneur": member})
                self.assertEqual(self.codes(findings), codes)
                if codes and codes[0] == "301":  # in the file's own coordinates
                    upper = [f for f in findings if f["code"] == 301 and f["feature"] == "upper"][0]["at_file"]
                    self.assertAlmostEqual(upper[1], 5779000 - north - 250, delta=0.3)

    def test_projected_obstacles_of_a_city_model(self):
        town = city_of_two(self.folder / "town.json")
        _, made = self.extracted(town)
        projected = moved(made["features"], *made["flaneur"]["origin_m"])
        crs = {"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}}
        for arguments, members in (([], crs), (["--units", "metres"], {})):
            with self.subTest(arguments):
                _, findings = self.check_obstacles(projected, "--town", town, "--clearance-m", 0.05, *arguments, members=members)
                self.assertEqual(findings, [])

    def test_degrees_against_a_town_that_names_no_system(self):
        town = city_of_two(self.folder / "town.json", system=None)
        ring = [[10.51, 52.15], [10.5101, 52.15], [10.5101, 52.1501], [10.51, 52.15]]
        plot = {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
        _, findings = self.check_obstacles([plot], "--town", town, members={})
        self.assertEqual(self.codes(findings), ["907"])

    # ---- Where they lie ----

    def placed(self, **changes):
        """Our own output of a town in map coordinates, with something about its place changed."""
        town = row_of_houses(self.folder / "town.json")
        out, made = self.extracted(town)
        made["flaneur"].update(changes)
        out.write_text(json.dumps(made))
        return town, out

    def on_earth(self, change):
        town, out = self.placed()
        out = out.with_name("extracted_wgs84.geojson")
        made = json.loads(out.read_text())
        change(made)
        out.write_text(json.dumps(made))
        return town, out

    def assert_one_907(self, town, out, *words):
        for arguments in ([], ["--town", town]):
            _, findings = self.check(out, *arguments)
            self.assertEqual([f["code"] for f in findings], [907], findings)
            for word in words:
                self.assertIn(word, findings[0]["message"])

    def test_nothing_is_wrong_with_a_place(self):
        town, out = self.placed()
        for path in (out, out.with_name("extracted_wgs84.geojson")):
            for arguments in ([], ["--town", town]):
                self.assertEqual(self.check(path, *arguments)[1], [])

    def test_a_wrong_crs(self):
        for wrong in ("EPSG:25833", "EPSG:31467", "EPSG:23032", "EPSG:3857", "EPSG:2056"):
            with self.subTest(wrong):
                self.assert_one_907(*self.placed(crs=wrong), wrong, "EPSG:25832")

    def test_a_wrong_crs_beside_our_own(self):
        def name_another(made):
            made["crs"] = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}
        self.assert_one_907(*self.on_earth(name_another), "EPSG:25832", "longitude and latitude")

    def test_a_wrong_origin(self):
        for off in ((100, 0), (0, -100), (37.5, 12.25)):
            with self.subTest(off):
                self.assert_one_907(*self.placed(origin_m=[604000 + off[0], 5779000 + off[1]]), "origin_m", "[604000, 5779000]")

    def test_an_origin_off_by_little_is_told_by_the_town(self):
        town, out = self.placed(origin_m=[604000.4, 5779000])
        _, findings = self.check(out, "--town", town)
        self.assertEqual([f["code"] for f in findings], [907])
        self.assertIn("0.40 m east", findings[0]["message"])

    def test_longitude_and_latitude_swapped(self):
        def swap(made, with_box=False):
            for feature in made["features"]:
                geometry = feature["geometry"]
                geometry["coordinates"] = [[p[::-1] for p in ring] for ring in geometry["coordinates"]]
            if with_box:
                made.pop("bbox"), made["flaneur"].pop("town_crs"), made["flaneur"].pop("town_origin_m")
        self.assert_one_907(*self.on_earth(swap), "swapped")
        self.assert_one_907(*self.on_earth(lambda made: swap(made, True)), "swapped", "right angles")

    def test_findings_of_one_cause_are_one(self):
        turned = [house(20 * i, 0, f"h{i}") for i in range(30)]
        for feature in turned:
            feature["geometry"]["coordinates"][0].reverse()
        _, findings = self.check_obstacles(turned)
        self.assertEqual([(f["code"], f["count"], len(f["features"])) for f in findings], [(105, 30, 30)])
        _, findings = self.check_obstacles(turned[:5] + [house(20 * i, 0, f"h{i}") for i in range(5, 30)])
        self.assertEqual([f["code"] for f in findings], [105] * 5)

    def test_dead_ends_are_only_warnings_where_no_door_is_stated(self):
        for name in ("502", "503"):
            with self.subTest(name):
                case = json.loads((CASES / f"{name}.geojson").read_text())
                case["features"] = [f for f in case["features"] if f["properties"].get("kind") != "door"]
                result, findings = self.check_obstacles(case["features"])
                self.assertEqual({f["severity"] for f in findings}, {"warning"})
                self.assertIn(int(name), [f["code"] for f in findings])
                self.assertEqual(result.returncode, 0)

    def test_a_forecourt_is_no_dead_end(self):
        def court(width, depth):
            ring = [[0, 0], [2, 0], [2, depth], [2 + width, depth], [2 + width, 0], [4 + width, 0], [4 + width, depth + 2], [0, depth + 2], [0, 0]]
            return {"type": "Feature", "properties": {"name": "court"}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
        self.assertEqual(self.check_obstacles([court(19, 25)])[1], [])
        self.assertIn("502", self.codes(self.check_obstacles([court(6, 25)])[1]))

    # ---- A real town ----

    def test_a_tile_against_its_own_footprints(self):
        for tile in ("LoD2_32_329_5725_1_NW.gml", "LoD2_32_354_5652_1_NW.gml"):
            with self.subTest(tile):
                town = shared_data(f"towns/nrw-lod2/{tile}")
                out, _ = self.extracted(town)
                _, findings = self.check(out, "--town", town)
                self.assertEqual([f for f in findings if 300 < f["code"] < 400], [])

    def test_old_town_of_krems(self):
        _, findings = self.check(shared_data("footprints/krems_old.geojson"))
        count = {code: sum(f["code"] == code for f in findings) for code in (104, 401, 402)}
        self.assertEqual(count, {104: 0, 401: 34, 402: 0}, "554 pairs touch, 34 overlap")


if __name__ == "__main__":
    unittest.main()
