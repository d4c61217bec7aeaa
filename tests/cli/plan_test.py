"""The steps of a bake: listed, done one by one, kept in a folder that others share; and many tours at once."""
import json
import shutil
import subprocess
import unittest

from scenes import write_person
from small_tour import RESULTS, SMALL, SmallTourTest
from support import BIN


class Plan(SmallTourTest):
    avatars = ("anna", "berta two")

    def setUp(self):
        super().setUp()
        self.tour.write_text(self.tour.read_text() + "height_m = 1.5\n")  # of berta, so that neither is the other's

    def plan(self, *options, **variables):
        result = self.flaneur("plan", self.tour, "-o", self.out, "--json", *options, **variables)
        self.assert_succeeds(result)
        plan = json.loads(result.stdout)
        self.assertEqual(plan["version"], 1)
        return plan["steps"]

    def keys(self):
        return {step["name"]: step["key"] for step in self.plan()}

    def test_says_what_is_made_from_what(self):
        steps = self.plan()
        names = [step["name"] for step in steps]
        self.assertEqual(names, ["town:small", "footprints:small", "meshes:small", "avatar:anna", "impostor:anna",
                                 "avatar:berta two", "impostor:berta two", "check:small", "models:small", "media:small", "pack:small"])
        for number, step in enumerate(steps):
            self.assertLessEqual(set(step["needs"]), set(names[:number]))
            self.assertRegex(step["key"], "^[0-9a-f]{64}$")
            self.assertGreater(step["seconds"], 0)
            self.assertGreater(step["memory_mb"], 0)
            self.assertFalse(step["done"])
        avatar = steps[names.index("avatar:anna")]
        self.assertIn(str(self.tour.parent / "anna.glb"), avatar["inputs"])
        self.assertIn(avatar["outputs"][0], steps[names.index("impostor:anna")]["inputs"])
        self.assertIn(str(self.out / "small.glb"), steps[-1]["outputs"])
        self.assertFalse(self.out.exists() and set(self.out.iterdir()) - {self.out / "cache"}, "a plan makes nothing")

    def test_keys_are_of_contents(self):
        before = self.keys()
        self.assertEqual(self.keys(), before)
        moved = self.folder / "moved"
        shutil.copytree(self.tour.parent, moved)
        self.tour = moved / "tour.toml"
        self.assertEqual(self.keys(), before, "another folder, the same contents")
        person = moved / "anna.glb"
        data = bytearray(person.read_bytes())
        data[-4] ^= 1
        person.write_bytes(data)
        changed = {name for name, key in self.keys().items() if key != before[name]}
        self.assertEqual(changed, {"avatar:anna", "impostor:anna", "models:small", "pack:small"})

    def test_steps_one_by_one_give_the_same_bytes_as_a_bake(self):
        self.assert_succeeds(self.bake())
        baked = self.results()
        shutil.rmtree(self.out)
        cache = self.folder / "shared"
        places = ("-o", self.out, "--cache", cache)
        steps = self.plan("--cache", cache)
        order = [step["name"] for step in steps]
        for name in reversed(order[:-1]):  # in whatever order, what is needed is made first
            self.assert_succeeds(self.flaneur("step", self.tour, name, *places))
        self.assertEqual(self.results(), {})
        self.assertTrue(all(step["done"] for step in self.plan("--cache", cache) if step["name"][:5] not in ("media", "pack:")))
        self.assert_succeeds(self.flaneur("step", self.tour, order[-1], *places))
        self.assertEqual(set(self.results()), RESULTS)
        for name in ("small.glb", "footprints.geojson", "plan.png"):
            self.assertEqual(self.results()[name], baked[name])
        self.assertTrue(self.plan("--cache", cache)[-1]["done"])
        self.assert_fails(self.flaneur("step", self.tour, "avatar:ana", *places), "no step 'avatar:ana'", "avatar:anna")

    def test_many_writers_share_a_cache(self):
        cache = self.folder / "shared"
        commands = [[BIN / "flaneur", "bake", self.tour, "-o", self.folder / f"out{i}", "--cache", cache] for i in range(3)]
        bakes = [subprocess.Popen(list(map(str, command)), env=self.environment(), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
                 for command in commands]
        self.assertEqual([bake.wait(timeout=300) for bake in bakes], [0, 0, 0])
        self.assertEqual(len({(self.folder / f"out{i}/small.glb").read_bytes() for i in range(3)}), 1)
        self.assertEqual(self.leftovers(), [])
        self.assert_succeeds(self.flaneur("cache", cache, "--verify"))

    def test_the_cache_is_shown_verified_and_trimmed(self):
        self.assert_succeeds(self.bake())
        cache = self.out / "cache"
        listed = self.flaneur("cache", cache, "--list").stdout
        for step in ("avatar:anna", "impostor:berta two", "footprints:small", "town:small"):
            self.assertIn(step, listed)
        self.assert_succeeds(self.flaneur("cache", cache, "--verify"))
        kept = max(cache.rglob("*.kept"), key=lambda path: path.stat().st_size)
        data = bytearray(kept.read_bytes())
        data[len(data) // 3] ^= 4
        kept.write_bytes(data)
        result = self.flaneur("cache", cache, "--verify")
        self.assertEqual(result.returncode, 1)
        self.assertIn("1 damaged", result.stdout)
        self.assertFalse(kept.exists())
        self.assert_succeeds(self.flaneur("cache", cache, "--trim-mb", "0"))
        self.assertEqual(list(cache.rglob("*.kept")), [])
        self.assert_succeeds(self.bake())
        self.assert_fails(self.flaneur("cache", self.folder / "none"), "none", "no such folder")


class ManyTours(SmallTourTest):
    avatars = ("shared",)

    def write(self, name, **more):
        folder = self.folder / name
        folder.mkdir()
        shutil.copy(self.tour.parent / "town.glb", folder)
        write_person(folder / "shared.glb")
        (folder / "tour.toml").write_text(self.tour.read_text().replace('"small"', f'"{more.get("named", name)}"'))
        return folder / "tour.toml"

    def test_what_they_share_is_made_once_and_one_report_is_over_all(self):
        tours = [self.write("first"), self.write("second"), self.write("third")]
        tours[1].write_text(tours[1].read_text() + "[crowd]\npeople = 3\n")
        tours[2].write_text(tours[2].read_text().replace("shared.glb", "gone.glb"))
        result = self.flaneur("bake", *tours, "-o", self.out)
        self.assert_fails(result, "gone.glb", "tour.toml:")
        report = json.loads((self.out / "report.json").read_text())
        self.assertEqual([(tour["tour"], tour["state"]) for tour in report["tours"]],
                         [("first", "baked"), ("second", "baked"), ("third", "failed")])
        page = (self.out / "report.html").read_text()
        for words in ("first/report.html", "second/report.html", "gone.glb"):
            self.assertIn(words, page)
        made = []
        for name in ("first", "second"):
            self.assertEqual(set(path.name for path in (self.out / name).iterdir() if path.is_file()),
                             {result.replace("small", name) for result in RESULTS})
            stages = json.loads((self.out / name / "report.json").read_text())["stages"]
            made += [stage["stage"] for stage in stages if not stage["cached"]]
        for stage in ("avatar", "impostor", "town", "footprints"):
            self.assertEqual(made.count(stage), 1 if stage != "town" else made.count("town"), stage)
        self.assert_succeeds(self.flaneur("bake", tours[0], tours[1], "-o", self.out))
        states = [tour["state"] for tour in json.loads((self.out / "report.json").read_text())["tours"]]
        self.assertEqual(states, ["unchanged", "unchanged"])

    def test_two_of_one_name_are_refused(self):
        tours = [self.write("first"), self.write("second", named="first")]
        self.assert_fails(self.flaneur("bake", *tours, "-o", self.out), "one name", "first")


class Comfort(SmallTourTest):
    def test_the_end_says_where_all_is_and_how_to_play_it(self):
        result = self.bake()
        self.assert_succeeds(result)
        for words in (f"pack    {self.out}/small.glb", f"report  {self.out}/report.html", f"flaneur-player {self.out}/small.glb"):
            self.assertIn(words, result.stdout)
        self.assertRegex(result.stderr, r"\[1/9\] +\d+ %  \w+")
        self.assertIn("100 %", result.stderr)

    def test_a_draft_is_a_whole_tour(self):
        self.tour.write_text(SMALL.split("[impostor]")[0] + '[[avatar]]\nname = "plain"\nfile = "plain.glb"\n')
        self.assert_succeeds(self.bake("--draft"))
        draft = self.results()["small.glb"]
        self.assert_succeeds(self.bake())
        self.assertLess(len(draft), len(self.results()["small.glb"]))
        self.assert_succeeds(self.flaneur("inspect", self.out / "small.glb"))

    def test_watch_bakes_what_changes(self):
        command = [str(BIN / "flaneur"), "bake", str(self.tour), "-o", str(self.out), "--watch"]
        with subprocess.Popen(command, env=self.environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as bake:
            try:
                lines = iter(bake.stdout.readline, "")
                self.assertTrue(any("watching" in line for line in lines))
                before = self.results()["small.glb"]
                self.write_tour("[crowd]\npeople = 9\n")
                self.assertTrue(any("watching" in line for line in lines))
                self.assertNotEqual(self.results()["small.glb"], before)
            finally:
                bake.terminate()


if __name__ == "__main__":
    unittest.main()
