"""A second bake makes anew what depends on the change, and nothing else."""
import json
import shutil
import unittest

from scenes import box, quad, write_person, write_png, write_textured_person, write_town
from support import ProgramTest, run

# A town's script in the least: its result is a file that lies beside it.
SCRIPT = """
import json, shutil, sys
with open(sys.argv[-1], encoding="utf-8") as file:
    settings = json.load(file)
shutil.copy(settings["options"]["made"], settings["output"])
"""
TOUR = """
[tour]
name = "small"
[town]
file = "town/build.py"
options = { made = "%s" }
[[avatar]]
name = "painted"
file = "painted person.gltf"
[[avatar]]
name = "plain"
file = "plain.glb"
[crowd]
people = 4
[impostor]
directions = 2
height_px = 32
samples = 1
walk_phases = 1
"""
PEOPLE = {"avatar painted", "avatar plain", "impostor painted", "impostor plain"}
TOWN = {"footprints small", "check small"}


class Cache(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "town").mkdir()
        (self.folder / "town/build.py").write_text(SCRIPT)
        self.write_town(house_height=7.0)
        write_png(self.folder / "a cloth.png", 200, 60, 40)
        write_textured_person(self.folder / "painted person.gltf", "a%20cloth.png")
        write_person(self.folder / "plain.glb")
        self.settings = TOUR % (self.folder / "made.glb")
        self.out = self.folder / "out"
        self.pack = self.out / "small.glb"

    def write_town(self, house_height):
        write_town(self.folder / "made.glb",
                   [("ground", {"flaneur_kind": "ground"}, *quad(20.0)),
                    ("house", {"flaneur_kind": "building"}, *box(-3, -4, 6, 8, house_height))])

    def bake(self, out=None):
        """The steps that were made anew, as "stage item"."""
        (self.folder / "tour.toml").write_text(self.settings)
        self.assert_succeeds(run("flaneur", "bake", self.folder / "tour.toml", "-o", out or self.out, "--allow-scripts"))
        report = json.loads(((out or self.out) / "report.json").read_text())
        return {f"{s['stage']} {s['item']}" for s in report["stages"] if not s["cached"]}

    def assert_made(self, expected):
        """The town is read and the pack is written each time; nothing else but `expected` may be made anew."""
        self.assertEqual(self.bake() - {"town small", "pack small"}, set(expected))

    def test_only_what_depends_on_the_change_is_made_anew(self):
        self.assert_made(PEOPLE | TOWN | {"source town"})
        self.assertEqual(self.bake(), set(), "nothing changed")

        self.settings += "[control]\nbudget_triangles = 4321\n[[stop]]\nposition_m = [10, 10]\n"
        self.assert_made({"check small"})  # whose map shows the stops
        inspected = run("flaneur", "inspect", self.pack, "--json")
        self.assertEqual(json.loads(inspected.stdout)["path_stops"], 1)

        write_png(self.folder / "a cloth.png", 40, 60, 200)
        self.assert_made({"avatar painted", "impostor painted"})
        self.settings = self.settings.replace('file = "plain.glb"', 'file = "plain.glb"\nheight_m = 1.6')
        self.assert_made({"avatar plain", "impostor plain"})
        self.settings += "[levels]\nratios = [1.0, 0.5]\n"
        self.assert_made({"avatar painted", "avatar plain"})
        self.settings += "[footprints]\nclearance_m = 0.2\n"
        self.assert_made(TOWN)
        self.settings += '[[place]]\nkind = "exit"\nposition_m = [15, 15]\n'
        self.assert_made({"check small"})

        script = self.folder / "town/build.py"
        script.write_text(SCRIPT + "# The same town all the same.\n")
        self.assert_made({"source town"})
        self.write_town(house_height=9.0)
        script.write_text(SCRIPT)
        self.assert_made({"source town"} | TOWN)

        fresh = self.folder / "fresh"
        self.bake(fresh)
        self.assertEqual(self.pack.read_bytes(), (fresh / "small.glb").read_bytes(), "cached or not, the pack is the same")

    def kept_by(self, *steps):
        """The files of the cache that these steps made."""
        descriptions = [path for path in self.out.glob("cache/??/*.json")
                        if json.loads(path.read_text().split("\n")[1])["step"] in steps]
        self.assertEqual(len(descriptions), len(steps))
        return [next(path for path in description.parent.glob(description.stem + ".*") if path != description)
                for description in descriptions]

    def test_a_caption_asks_for_nothing_but_the_models(self):
        stop = '[[stop]]\nposition_m = [10, 10]\ncaption = "%s"\n'
        plain = self.settings
        self.settings = plain + stop % "The square"
        self.bake()
        report = json.loads((self.out / "report.json").read_text())
        for kept in self.kept_by("avatar:painted", "impostor:plain"):
            kept.unlink()
        self.settings = plain + stop % "The market square"
        self.assert_made(set())
        cold = self.folder / "cold"
        self.bake(cold)
        for name in ("small.glb", "footprints.geojson", "plan.png"):
            self.assertEqual((self.out / name).read_bytes(), (cold / name).read_bytes(), name)
        again = json.loads((self.out / "report.json").read_text())
        self.assertEqual([stage["stage"] + stage["item"] for stage in again["stages"]],
                         [stage["stage"] + stage["item"] for stage in report["stages"]])

    def test_damaged_models_are_made_again(self):
        self.bake()
        before = self.pack.read_bytes()
        for kept in self.kept_by("models:small", "impostor:plain"):
            data = bytearray(kept.read_bytes())
            data[len(data) // 2] ^= 1
            kept.write_bytes(data)
        self.pack.unlink()
        self.assert_made({"impostor plain"})
        self.assertEqual(self.pack.read_bytes(), before)

    def test_a_damaged_cache_is_no_cache(self):
        self.bake()
        good = self.pack.read_bytes()
        for number, kept in enumerate(sorted((self.out / "cache").rglob("*.kept"))):
            data = bytearray(kept.read_bytes())
            data[len(data) // 2] ^= 0x40
            kept.write_bytes(data if number % 2 else data[:-5])
        self.pack.unlink()
        self.assert_made(PEOPLE | TOWN)
        self.assertEqual(self.pack.read_bytes(), good)

    def test_warnings_stay_in_the_report(self):
        shutil.rmtree(self.folder / "town")
        self.settings = self.settings.replace("town/build.py", "made.glb").split("options", 1)
        self.settings = self.settings[0] + self.settings[1].split("\n", 1)[1]
        self.settings += '[[place]]\nname = "inside"\nkind = "door"\nposition_m = [0, 0]\n'
        self.bake()
        before = json.loads((self.out / "report.json").read_text())["warnings"]
        self.assertTrue(before, "a door inside a house is worth a warning")
        self.settings += "[light]\nday_length_s = 5\n"
        self.bake()
        self.assertEqual(json.loads((self.out / "report.json").read_text())["warnings"], before)


if __name__ == "__main__":
    unittest.main()
