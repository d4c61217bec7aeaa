"""People and towns in the formats that Blender reads."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import venv

from support import run

SCRIPT = pathlib.Path(__file__).resolve().parent / "figure_in_blender.py"
TRIANGLES = 4 * 528  # of the figure; the hidden cube is not part of it


class Formats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.keep = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.keep.name)
        blender = os.environ.get("FLANEUR_BLENDER", "blender")
        made = subprocess.run([blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python", SCRIPT, "--", cls.folder],
                              capture_output=True, text=True, timeout=600)
        if made.returncode != 0:
            raise AssertionError(made.stdout + made.stderr)

    @classmethod
    def tearDownClass(cls):
        cls.keep.cleanup()

    def blender_by_script(self, first=""):
        """A shell script elsewhere that does something first, and then is Blender."""
        script = self.folder / "blender.sh"
        program = shutil.which(os.environ.get("FLANEUR_BLENDER", "blender"))
        script.write_text(f'#!/bin/sh\n{first}\nexec "{program}" "$@"\n')
        script.chmod(0o755)
        return str(script)

    def levels_of(self, name):
        facts = self.folder / "levels.json"
        result = run("flaneur", "avatar", self.folder / name, "-o", self.folder / "out.glb", "--json", facts)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(facts.read_text())

    def test_the_same_figure_in_every_format_is_the_same_person(self):
        for name in ("figure.blend", "figure.fbx", "figure.dae"):
            if not (self.folder / name).exists():
                continue  # a Blender without Collada
            with self.subTest(name):
                facts = self.levels_of(name)
                self.assertEqual(facts["levels"][0]["triangles"], TRIANGLES)
                with_morphs = name != "figure.dae"
                self.assertEqual(facts["joints"], len(("hips", "head", "leg_l", "leg_r")) + with_morphs)  # and lids
                self.assertAlmostEqual(facts["height_m"], 1.75, delta=0.01)
                self.assertAlmostEqual(facts["walk_speed_mps"], 2.06, delta=0.1)
                if with_morphs:  # Collada holds one clip
                    self.assertEqual({clip["name"] for clip in facts["clips"]}, {"walk", "idle", "talk"})

    def test_a_hat_sits_on_the_head_of_a_rig_that_stands_elsewhere_and_bows(self):
        facts = self.levels_of("hat.blend")
        self.assertEqual(facts["levels"][0]["triangles"], TRIANGLES + 12)
        self.assertAlmostEqual(facts["height_m"], 1.9, delta=0.01)
        listed = run("flaneur", "avatar", self.folder / "hat.blend", "--list")
        self.assertIn("on bone head", listed.stdout)

    def test_a_hat_that_a_constraint_holds_sits_on_the_head_of_a_figure_that_walks_though_shown_at_rest(self):
        facts = self.levels_of("held_hat.blend")
        self.assertEqual(facts["levels"][0]["triangles"], TRIANGLES + 12)
        self.assertAlmostEqual(facts["height_m"], 1.9, delta=0.01)
        self.assertAlmostEqual(facts["walk_speed_mps"], 2.06, delta=0.1)
        listed = run("flaneur", "avatar", self.folder / "held_hat.blend", "--list")
        self.assertIn("on bone head", listed.stdout)

    def test_a_rig_without_a_figure_gives_its_clips_and_is_no_person_and_no_town(self):
        for name in ("walking.blend", "walking.fbx", "walking.dae"):
            if not (self.folder / name).exists():
                continue  # a Blender without Collada
            with self.subTest(name):
                self.assertIn(" s\n", run("flaneur", "avatar", self.folder / name, "--list").stdout.split("clips:\n")[1])
                facts = self.folder / "levels.json"
                result = run("flaneur", "avatar", self.folder / "figure.fbx", "--clips", self.folder / name, "-o", self.folder / "out.glb", "--json", facts)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertAlmostEqual(json.loads(facts.read_text())["walk_speed_mps"], 2.06 / 2, delta=0.15)
                for verb, missing in (("avatar", "no skin"), ("footprints", "no triangle")):
                    refused = run("flaneur", verb, self.folder / name, "-o", self.folder / "none.glb")
                    self.assertEqual(refused.returncode, 2)
                    self.assertIn("error: %s: " % (self.folder / name), refused.stderr)
                    self.assertIn(missing, refused.stderr)

    def test_a_figure_without_bones_is_refused(self):
        result = run("flaneur", "avatar", self.folder / "figure.obj", "-o", self.folder / "none.glb")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no skin", result.stderr)
        self.assertFalse((self.folder / "none.glb").exists())

    def test_what_blender_cannot_read_is_one_line(self):
        for name in ("bad.fbx", "bad.blend", "bad.dae"):
            with self.subTest(name):
                (self.folder / name).write_text("not a model")
                result = run("flaneur", "avatar", self.folder / name, "-o", self.folder / "none.glb")
                self.assertEqual(result.returncode, 2)
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                self.assertIn(name, result.stderr)
                self.assertFalse((self.folder / "none.glb").exists())

    def test_what_is_wrong_with_an_fbx_is_said(self):
        whole = (self.folder / "figure.fbx").read_bytes()
        for content, said in ((b"; FBX 7.4.0 project file\n", "is no binary FBX; save it as one"), (b"", "is no binary FBX"), (whole[:25], "is cut short"), (whole[:len(whole) // 2], "is damaged or cut short")):
            (self.folder / "odd.fbx").write_bytes(content)
            for arguments in ((self.folder / "odd.fbx",), (self.folder / "figure.fbx", "--clips", self.folder / "odd.fbx")):
                result = run("flaneur", "avatar", *arguments, "-o", self.folder / "none.glb")
                self.assertEqual(result.returncode, 2)
                self.assertRegex(result.stderr, "^flaneur: error: .*odd.fbx: " + said)

    def test_a_town_may_be_what_blender_reads_and_a_scan(self):
        for name in ("town.blend", "town.x3d", "town.ply"):
            if not (self.folder / name).exists():
                continue  # a Blender without X3D
            with self.subTest(name):
                out = self.folder / "town.geojson"
                result = run("flaneur", "footprints", self.folder / name, "-o", out)
                self.assertEqual(result.returncode, 0, result.stderr)
                features = json.loads(out.read_text())["features"]
                self.assertEqual({feature["properties"]["kind"] for feature in features}, {"building"})
                (ring,) = [ring for ring in (f["geometry"]["coordinates"][0] for f in features) if max(x for x, _ in ring) > 0]
                self.assertAlmostEqual(min(x for x, _ in ring), 3 - 4 - 0.05, delta=0.01)
                self.assertAlmostEqual(max(y for _, y in ring), 4 + 2 + 0.05, delta=0.01)

    def test_files_are_read_on_one_thread(self):
        """On several, one run in about four gave other last bits of normals that a file brings itself."""
        words = self.folder / "words.txt"
        result = run("flaneur", "avatar", self.folder / "figure.fbx", "-o", self.folder / "out.glb",
                     env=os.environ | {"FLANEUR_BLENDER": self.blender_by_script(f'echo "$@" > "{words}"')})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("--threads 1 ", words.read_text())

    def test_a_blender_that_a_script_elsewhere_starts_takes_no_python_that_happens_to_come_first(self):
        own = self.folder / "own"
        venv.create(own, symlinks=True)  # without numpy, which Blender's exporter needs
        result = run("flaneur", "avatar", self.folder / "figure.fbx", "-o", self.folder / "out.glb",
                     env=os.environ | {"FLANEUR_BLENDER": self.blender_by_script(), "PATH": f"{own / 'bin'}:{os.environ['PATH']}"})
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_scan_is_no_figure(self):
        result = run("flaneur", "avatar", self.folder / "town.ply", "-o", self.folder / "none.glb")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no skeleton", result.stderr)


if __name__ == "__main__":
    unittest.main()
