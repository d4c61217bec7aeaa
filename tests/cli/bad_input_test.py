"""Bad input: one clear line, status 2, nothing half-written, an earlier good file kept."""
import os
import shutil
import subprocess
import unittest

from scenes import write_box_town, write_town
from support import BIN, ProgramTest, run, shared_data, split_glb, write_glb


def tour(town, avatar):
    return f"""
[tour]
name = "small"
[town]
file = "{town}"
[[avatar]]
name = "visitor"
file = "{avatar}"
[crowd]
people = 8
[impostor]
directions = 4
"""


class BadInput(ProgramTest):
    def write_tour(self, town="town.glb", avatar="avatar.glb", more=""):
        path = self.folder / "tour.toml"
        path.write_text(tour(town, avatar) + more)
        return path

    def bake(self, path, **options):
        return run("flaneur", "bake", path, "-o", self.folder / "out", **options)

    def with_avatar(self):
        shutil.copy(shared_data("avatars/khronos/RiggedFigure.glb"), self.folder / "avatar.glb")

    def test_missing_tour(self):
        self.assert_fails(run("flaneur", "bake", self.folder / "none.toml"), "none.toml", "no such file")

    def test_missing_town_is_named(self):
        self.with_avatar()
        self.assert_fails(self.bake(self.write_tour()), "town.glb", "no such file")

    def test_unknown_key_suggests_the_right_one(self):
        path = self.write_tour(more='\n[control]\nhihg_limit = 3\n')
        self.assert_fails(self.bake(path), "tour.toml", "hihg_limit", "high_limit")

    def test_not_a_gltf(self):
        for verb, output in (("avatar", "out.glb"), ("footprints", "out.geojson"), ("impostor", "out")):
            with self.subTest(verb):
                bad = self.folder / "bad.glb"
                bad.write_text("no glTF at all")
                target = self.folder / output
                self.assert_fails(run("flaneur", verb, bad, "-o", target), "bad.glb")
                self.assertFalse(target.exists())

    def test_truncated_glb(self):
        whole = self.folder / "whole.glb"
        write_box_town(whole)
        cut = self.folder / "cut.glb"
        cut.write_bytes(whole.read_bytes()[:-200])
        self.assert_fails(run("flaneur", "footprints", cut, "-o", self.folder / "o.geojson"), "cut.glb")

    def test_no_skin(self):
        statue = self.folder / "statue.glb"
        write_box_town(statue, houses=1)
        self.assert_fails(run("flaneur", "avatar", statue, "-o", self.folder / "o.glb"), "statue.glb", "skin")

    def test_no_walk_clip(self):
        gltf, binary = split_glb(shared_data("avatars/khronos/RiggedFigure.glb"))
        gltf.pop("animations")
        still = self.folder / "still.glb"
        write_glb(still, gltf, binary)
        self.assert_fails(run("flaneur", "avatar", still, "-o", self.folder / "o.glb"), "still.glb", "walk")

    def test_empty_town(self):
        empty = self.folder / "empty.glb"
        write_glb(empty, {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "n"}]})
        self.assert_fails(run("flaneur", "footprints", empty, "-o", self.folder / "o.geojson"), "empty.glb")

    def test_non_finite_vertices_name_the_house(self):
        town = self.folder / "town.glb"
        write_box_town(town, spoil=lambda positions: [(float("nan"), y, z) for _, y, z in positions])
        result = run("flaneur", "footprints", town, "-o", self.folder / "o.geojson")
        self.assert_fails(result, "town.glb", "house_4")

    def test_blender_not_found(self):
        figure = shared_data("avatars/khronos/RiggedFigure.glb")
        environment = dict(os.environ, FLANEUR_BLENDER="/no/such/blender")
        result = run("flaneur", "impostor", figure, "-o", self.folder / "o", env=environment)
        self.assert_fails(result, "blender", "install")
        self.assertFalse((self.folder / "o").exists())

    def test_disk_full(self):
        town = self.folder / "town.glb"
        write_box_town(town)
        limit = "ulimit -f 0; trap '' XFSZ; exec \"$@\""  # no file may grow: as a full disk does
        command = ["bash", "-c", limit, "bash", BIN / "flaneur", "footprints", town, "-o", self.folder / "o.geojson"]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assert_fails(result, "o.geojson", "cannot be written")
        self.assertEqual([p.name for p in self.folder.iterdir()], ["town.glb"])

    def test_failed_bake_keeps_the_good_pack(self):
        self.with_avatar()
        out = self.folder / "out"
        out.mkdir()
        (out / "small.glb").write_text("an earlier good pack")
        write_town(self.folder / "town.glb", [])
        self.assertEqual(self.bake(self.write_tour()).returncode, 2)
        self.assertEqual((out / "small.glb").read_text(), "an earlier good pack")

    def test_player_names_a_broken_pack(self):
        pack = self.folder / "pack.glb"
        write_box_town(pack)
        self.assert_fails(run("flaneur-player", pack, "--headless", "--no-draw"), "pack.glb", "FLANEUR_tour")
        self.assert_fails(run("flaneur-player", self.folder / "no.glb", "--headless", "--no-draw"), "no.glb")


class Usage(ProgramTest):
    def test_help_is_there_for_each(self):
        for verb in ("bake", "avatar", "impostor", "footprints", "check", "inspect"):
            with self.subTest(verb):
                result = run("flaneur", verb, "--help")
                self.assert_succeeds(result)
                self.assertGreater(len(result.stdout.splitlines()), 3)
        self.assert_succeeds(run("flaneur", "--help"))
        self.assert_succeeds(run("flaneur-player", "--help"))

    def test_wrong_words_are_bad_usage(self):
        self.assert_fails(run("flaneur", "bakee"), "bakee", "bake")
        self.assertEqual(run("flaneur").returncode, 2)
        self.assertEqual(run("flaneur", "bake").returncode, 2)
        self.assertEqual(run("flaneur-player", "--no-such-option").returncode, 2)


if __name__ == "__main__":
    unittest.main()
