"""Bad input: one clear line, status 2, nothing half-written, an earlier good file kept."""
import csv
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import time
import unittest

from scenes import box, quad, write_box_town, write_person, write_png, write_town
from support import BIN, SOURCE, ProgramTest, run, split_glb, write_glb


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
        return run("flaneur", "bake", path, "-o", self.folder / "out", "--allow-scripts", **options)

    def with_avatar(self):
        write_person(self.folder / "avatar.glb")

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

    def test_a_walk_that_is_not_there_is_named(self):
        person = self.folder / "person.glb"
        write_person(person)
        self.assert_fails(run("flaneur", "avatar", person, "--walk", "stroll", "-o", self.folder / "o.glb"), "person.glb", "stroll")

    def test_empty_town(self):
        empty = self.folder / "empty.glb"
        write_glb(empty, {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "n"}]})
        self.assert_fails(run("flaneur", "footprints", empty, "-o", self.folder / "o.geojson"), "empty.glb")

    def test_a_town_without_walkable_ground_stops_the_bake(self):
        self.with_avatar()
        ground = ("ground", {"flaneur_kind": "ground"}, *quad(10.0))
        write_town(self.folder / "town.glb", [ground, ("keep", {"flaneur_kind": "building"}, *box(-12.0, -12.0, 24.0, 24.0, 9.0))])
        self.assert_fails(self.bake(self.write_tour()), "no walkable ground", "flaneur_kind")
        self.assertFalse((self.folder / "out/small.glb").exists())

    def test_a_town_wider_than_the_player_takes_stops_the_bake(self):
        self.with_avatar()
        write_town(self.folder / "town.glb", [("ground", {"flaneur_kind": "ground"}, *quad(10_200.0)),
                                              ("keep", {"flaneur_kind": "building"}, *box(-12.0, -12.0, 24.0, 24.0, 9.0))])
        self.assert_fails(self.bake(self.write_tour()), "21 km wide", "20 km", "units metres")
        self.assertFalse((self.folder / "out/small.glb").exists())

    def test_non_finite_vertices_name_the_house(self):
        town = self.folder / "town.glb"
        write_box_town(town, spoil=lambda positions: [(float("nan"), y, z) for _, y, z in positions])
        result = run("flaneur", "footprints", town, "-o", self.folder / "o.geojson")
        self.assert_fails(result, "town.glb", "house_4")

    def test_blender_not_found(self):
        figure = self.folder / "avatar.glb"
        self.with_avatar()
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

    def test_every_missing_file_is_named_before_the_work_begins(self):
        (self.folder / "build.py").write_text("import time\ntime.sleep(600)\n")
        self.assert_fails(self.bake(self.write_tour(town="build.py")), "avatar.glb", "no such file")
        self.with_avatar()
        more = '[[town.part]]\nfile = "gone.gltf"\n'
        self.assert_fails(self.bake(self.write_tour(town="build.py", more=more)), "gone.gltf", "no such file")

    def test_a_painting_that_says_nothing_stops_the_bake_before_the_people_are_made(self):
        (self.folder / "avatar.glb").write_text("never read")
        write_box_town(self.folder / "town.glb")
        for name, color in (("black.png", (0, 0, 0)), ("red.png", (255, 0, 0))):
            write_png(self.folder / name, *color)
        (self.folder / "text.png").write_text("no picture at all")
        for table, words in (('file = "gone.png"', ("gone.png", "no such file")),
                             ('file = "text.png"', ("text.png",)),
                             ('file = "black.png"', ("black.png", "nothing is painted")),
                             ('file = "red.png"\nmin_m = [0, 0]\nmax_m = [30, 10]', ("red.png", "4 x 4 pixels", "30 x 10 m")),
                             ('file = "red.png"\nmin_m = [900, 0]\nmax_m = [910, 10]', ("red.png", "off the town's ground")),
                             ('file = "red.png"\nmin_m = [0, 0]', ("tour.toml:", "min_m and max_m"))):
            with self.subTest(table):
                self.assert_fails(self.bake(self.write_tour(more=f"[painting]\n{table}\n")), *words)

    def test_what_is_not_installed_beside_the_programs_is_named(self):
        (self.folder / "avatar.glb").write_text("never read")
        write_box_town(self.folder / "town.glb")
        write_png(self.folder / "red.png", 255, 0, 0)
        alone = self.folder / "bin"
        alone.mkdir()
        shutil.copy2(BIN / "flaneur", alone)
        command = [alone / "flaneur", "bake", self.write_tour(more='[painting]\nfile = "red.png"\n'), "-o", self.folder / "out"]
        result = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
        self.assert_fails(result, "flaneur_pictures.so", "install")

    def test_a_bad_source_stops_the_bake_in_one_line(self):
        self.with_avatar()
        write_box_town(self.folder / "town.glb")
        (self.folder / "text.glb").write_text("no glTF at all")
        (self.folder / "cut.glb").write_bytes((self.folder / "town.glb").read_bytes()[:-200])
        for town, avatar, words in (("text.glb", "avatar.glb", "text.glb"), ("cut.glb", "avatar.glb", "cut.glb"),
                                    ("town.glb", "text.glb", "text.glb"), ("town.glb", "town.glb", "skin")):
            with self.subTest(f"{town} {avatar}"):
                self.assert_fails(self.bake(self.write_tour(town, avatar)), words)
                self.assertEqual([p.name for p in (self.folder / "out").iterdir()], ["cache"])

    def test_a_file_that_is_of_no_use_is_told_of_where_the_tour_names_it(self):
        self.with_avatar()
        write_box_town(self.folder / "town.glb")
        (self.folder / "junk.bin").write_bytes(b"junk" * 100)
        whole = self.write_tour().read_text()
        after_avatar = whole.index("[crowd]")
        for key, table in (("stop.sound", '[[stop]]\nposition_m = [0, 0]\nsound = "%s"\n'), ("sound.file", '[[sound]]\nkind = "loop"\nposition_m = [0, 0]\nfile = "%s"\n'),
                           ("hotspot.picture", '[[hotspot]]\nposition_m = [0, 0]\ntitle = "x"\npicture = "%s"\n'),
                           ("title_page.logo", '[title_page]\nlogo = "%s"\n'), ("painting.file", '[painting]\nfile = "%s"\n'),
                           ("town.part.file", '[[town.part]]\nfile = "%s"\n'), ("avatar.part.file", '[[avatar.part]]\nfile = "%s"\n'),
                           ("avatar.clip.file", '[[avatar.clip]]\nname = "walk"\nfile = "%s"\n')):
            for name, words in (("junk.bin", "junk.bin"), (".", "a folder")):
                with self.subTest(key=key, name=name):
                    path = self.folder / "tour.toml"
                    path.write_text(whole[:after_avatar] + table % name + whole[after_avatar:])
                    line = path.read_text()[:path.read_text().index(f'"{name}"')].count("\n") + 1
                    self.assert_fails(self.bake(path), f"tour.toml:{line}: {key}: ", words)

    def test_a_tour_from_another_system_is_told_what_is_other_here(self):
        self.with_avatar()
        write_box_town(self.folder / "town.glb")
        self.assert_fails(self.bake(self.write_tour(town="models\\\\town.glb")), "tour.toml", "models\\town.glb", "stands /")
        path = self.write_tour(more='[title_page]\nbackground = "#000000"\n')
        path.write_bytes(path.read_text().replace('"small"', '"F\u00fchrung"').encode("latin1"))
        self.assert_fails(self.bake(path), "tour.toml:3", "UTF-8")

    def test_a_script_says_what_is_wrong_with_its_options(self):
        write_box_town(self.folder / "town.glb")
        script = SOURCE / "blender_scripts/townspeople/build.py"
        for options, words in (('{ persn = "monk" }', ("persn", "person")), ('{ person = "munk" }', ("munk", "monk"))):
            with self.subTest(options):
                path = self.write_tour(avatar=script)
                path.write_text(path.read_text().replace(f'"{script}"', f'"{script}"\noptions = {options}'))
                self.assert_fails(self.bake(path), "build.py", *words)

    def test_a_script_that_breaks_is_named(self):
        self.with_avatar()
        (self.folder / "build.py").write_text("raise ValueError('no bricks left')\n")
        self.assert_fails(self.bake(self.write_tour(town="build.py")), "build.py", "no bricks left")
        (self.folder / "build.py").write_text("print('all done')\n")
        self.assert_fails(self.bake(self.write_tour(town="build.py")), "town.glb", "no such file")

    def test_outputs_that_cannot_be_written_are_named(self):
        self.with_avatar()
        write_box_town(self.folder / "town.glb")
        for arguments in (("avatar", "avatar.glb", "-o", "town.glb/x.glb"),
                          ("impostor", "avatar.glb", "-o", "town.glb"), ("footprints", "town.glb", "-o", "."),
                          ("footprints", "town.glb", "-o", "town.glb/x.geojson")):
            with self.subTest(arguments):
                before = sorted(p.name for p in self.folder.iterdir())
                self.assert_fails(run("flaneur", *arguments, cwd=self.folder), arguments[-1])
                self.assertEqual(sorted(p.name for p in self.folder.iterdir()), before)

    def test_obstacles_that_are_none(self):
        for text in ("no JSON", "[]", "{}", '{"type": "FeatureCollection", "features": []}',
                     '{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": 3}]}'):
            with self.subTest(text):
                (self.folder / "obstacles.geojson").write_text(text)
                self.assert_fails(run("flaneur", "check", self.folder / "obstacles.geojson"), "obstacles.geojson")

    def test_what_nests_too_deep_is_refused(self):
        def deep(what, opening, closing, depth=200000):
            (self.folder / what).write_text(opening * depth + "1" + closing * depth)
            return (self.folder / what).read_text()

        inner, outer = deep("inner", '{"a":', "}"), deep("outer", "[", "]")
        gltf = '{"asset": {"version": "2.0"}, "extras": %s}' % inner
        (self.folder / "deep.gltf").write_text(gltf)
        text = (gltf + " " * (-len(gltf) % 4)).encode()
        (self.folder / "deep.glb").write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text), len(text), b"JSON") + text)
        (self.folder / "deep.json").write_text(
            '{"type": "CityJSON", "version": "2.0", "vertices": [], "transform": {"scale": [1, 1, 1], "translate": [0, 0, 0]},'
            '"CityObjects": {"a": {"type": "Building", "geometry": [{"type": "Solid", "lod": 1, "boundaries": %s}]}}}' % outer)
        (self.folder / "deep.geojson").write_text('{"type": "FeatureCollection", "features": [%s]}' % outer)
        (self.folder / "deep.toml").write_text("x = 1\n" + ".".join("a" * 50000) + " = 1\n")
        for name in ("deep.gltf", "deep.glb", "deep.json"):
            for verb in ("footprints", "avatar") if name != "deep.json" else ("footprints",):
                with self.subTest((verb, name)):
                    self.assert_fails(run("flaneur", verb, self.folder / name, "-o", self.folder / "out"), name, "200 deep")
        self.assert_fails(run("flaneur", "check", self.folder / "deep.geojson"), "deep.geojson", "200 deep")
        self.assert_fails(run("flaneur-player", self.folder / "deep.glb", "--headless", "--no-draw"), "deep.glb", "200 deep")
        self.assert_fails(self.bake(self.folder / "deep.toml"), "deep.toml:2", "200 parts")
        self.assert_fails(run("flaneur-player", "--headless", "--no-draw", "--scenario", self.folder / "deep.toml"),
                          "deep.toml:2", "200 parts")

    def test_player_names_a_broken_pack(self):
        pack = self.folder / "pack.glb"
        write_box_town(pack)
        self.assert_fails(run("flaneur-player", pack, "--headless", "--no-draw"), "pack.glb", "FLANEUR_tour")
        self.assert_fails(run("flaneur-player", self.folder / "no.glb", "--headless", "--no-draw"), "no.glb")


class Playing(ProgramTest):
    """What can be wrong once there is a good pack."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="flaneur_cli_")
        cls.addClassCleanup(folder.cleanup)
        made = pathlib.Path(folder.name)
        write_box_town(made / "town.glb")
        write_person(made / "avatar.glb")
        small = "walk_phases = 1\nheight_px = 32\nsamples = 1\n"
        place = '[[place]]\nname = "gate"\nkind = "exit"\nposition_m = [20, 20]\n'
        write_png(made / "red.png", 255, 0, 0)
        paint = '[painting]\nfile = "red.png"\nmin_m = [5, 10]\nmax_m = [25, 30]\n'
        (made / "tour.toml").write_text(tour("town.glb", "avatar.glb") + small + place + paint)
        baked = run("flaneur", "bake", made / "tour.toml", "-o", made)
        if baked.returncode != 0:
            raise AssertionError(baked.stderr)
        cls.pack = made / "small.glb"

    def play(self, *arguments, pack=None, draw=False, **options):
        mode = ["--headless"] if draw else ["--headless", "--no-draw"]
        length = [] if "--seconds" in arguments else ["--seconds", 0.1]
        return run("flaneur-player", pack or self.pack, *mode, *length, *arguments, **options)

    def test_the_pack_itself_is_good(self):
        self.assert_succeeds(self.play())
        self.assertTrue((self.pack.parent / "plan.png").exists())

    def test_people_start_where_they_are_painted(self):
        paths = self.folder / "paths.csv"
        self.assert_succeeds(self.play("--trajectories", paths))
        with open(paths, encoding="utf-8", newline="") as file:
            starts = [(float(r["x_m"]), float(r["y_m"])) for r in csv.DictReader(file) if r["frame"] == "1"]
        self.assertEqual(len(starts), 8)
        for x, y in starts:  # who comes along may start beside the paint
            self.assertTrue(2 < x < 28 and 7 < y < 33, (x, y))

    def test_broken_packs(self):
        def changed(place, value):
            gltf, binary = split_glb(self.pack)
            target = gltf["extensions"]["FLANEUR_tour"]
            for key in place[:-1]:
                target = target[key]
            target[place[-1]] = value
            write_glb(self.folder / "broken.glb", gltf, binary)

        for place, value, words in ((("places", 0, "kind"), "portal", ("places[0].kind", "portal", "exit")),
                                    (("obstacles", 1, "kind"), "castle", ("obstacles[1].kind", "castle", "building")),
                                    (("obstacles", 0, "outer_m", 2), ["a", 1], ("obstacles[0].outer_m[2]", "number")),
                                    (("avatars", 0, "share"), "many", ("avatars[0].share", "number")),
                                    (("avatars", 0, "levels", 0, "node"), 99999, ("levels[0].node", "99999")),
                                    (("crowd",), "a lot", ("FLANEUR_tour.crowd", "object")),
                                    (("version",), 99, ("version 99",))):
            with self.subTest(place):
                changed(place, value)
                for result in (self.play(pack=self.folder / "broken.glb"), run("flaneur", "inspect", self.folder / "broken.glb")):
                    self.assert_fails(result, "broken.glb", *words)

    def test_truncated_pack(self):
        whole = self.pack.read_bytes()
        for size in (0, 11, 19, 500, len(whole) // 2, len(whole) - 1):
            (self.folder / "cut.glb").write_bytes(whole[:size])
            self.assert_fails(self.play(pack=self.folder / "cut.glb"), "cut.glb")

    def test_outputs_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        for option, draw in (("--metrics", False), ("--trajectories", False), ("--screenshot", True), ("--film", True)):
            for target in (self.folder, self.folder / "file/x"):
                with self.subTest(f"{option} {target.name}"):
                    self.assert_fails(self.play(option, target, draw=draw), target)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["file"])

    def test_sizes(self):
        for size in ("64", "x", "64x", "0x0", "64x64x", "64x64.5", "-64x64", "99999x64", "", "axb", "4294967360x64"):
            with self.subTest(size):
                self.assert_fails(self.play("--size", size, draw=True), "--size", "16 to 8192")
        self.assert_fails(self.play("--size", "65x64", "--film", self.folder / "film.mp4", draw=True), "even", "65x64")

    def test_what_is_no_number_is_no_number(self):
        still = ("--screenshot", self.folder / "a.png", "--size", "64x32")
        for option in ("--seconds", "--hour", "--discretion", "--at"):
            for number in ("nan", "-nan", "inf"):
                with self.subTest(f"{option} {number}"):
                    self.assert_fails(self.play(option, number, *(still if option == "--at" else ()), draw=True), option)

    def test_outputs_go_into_pipes_and_leave_them(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        self.assert_fails(self.play("--metrics", pipe), "pipe", "nobody reads")
        reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        try:
            self.assert_succeeds(self.play("--metrics", pipe))
            self.assertIn(b"frame", os.read(reader, 10000))
        finally:
            os.close(reader)
        self.assertTrue(pipe.is_fifo())
        written = self.play("--metrics", "/dev/stdout")
        self.assert_succeeds(written)
        self.assertIn("frame", written.stdout)
        self.assert_fails(self.play("--film", pipe, "--size", "64x64", draw=True), "pipe", "name a file")
        self.assertTrue(pipe.is_fifo())

    def test_devices_and_pipes_are_no_inputs(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        for path in (pipe, "/dev/zero"):
            self.assert_fails(self.play(pack=path), path, "device, pipe or socket")
            self.assert_fails(self.play("--scenario", path), path, "device, pipe or socket")
            for verb in ("avatar", "footprints", "check", "inspect"):
                with self.subTest(f"{verb} {path}"):
                    output = [] if verb in ("check", "inspect") else ["-o", self.folder / "out"]
                    self.assert_fails(run("flaneur", verb, path, *output), path, "device, pipe or socket")

    def test_a_large_still_can_be_interrupted(self):
        command = [BIN / "flaneur-player", self.pack, "--headless", "--seconds", "0.1", "--size", "4096x4096", "--samples", "4",
                   "--screenshot", self.folder / "large.png"]
        with subprocess.Popen(list(map(str, command)), stderr=subprocess.PIPE, text=True) as player:
            time.sleep(3)
            began = time.monotonic()
            player.terminate()
            _, said = player.communicate(timeout=100)
        if player.returncode == 0:
            self.skipTest("it was drawn before it could be interrupted")
        self.assertEqual((player.returncode, len(said.splitlines())), (2, 1), said)
        self.assertIn("interrupted", said)
        self.assertLess(time.monotonic() - began, 60, "it goes on drawing")  # takes 116 s where nothing but the picture's end is waited for
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_still_is_there_or_it_was_interrupted(self):
        """Whenever the request to stop comes: one of the two is said and done, never both."""
        picture = self.folder / "still.png"
        command = list(map(str, [BIN / "flaneur-player", self.pack, "--headless", "--seconds", "0.1", "--size", "640x480", "--screenshot", picture]))
        began = time.monotonic()
        subprocess.run(command, check=True, capture_output=True)
        takes_s = time.monotonic() - began
        for share in range(2, 12):
            picture.unlink(missing_ok=True)
            with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as player:
                time.sleep(takes_s * share / 10)
                player.terminate()
                _, said = player.communicate(timeout=100)
            with self.subTest(share=share):
                self.assertEqual(picture.exists(), player.returncode == 0, said)

    def test_a_film_may_be_called_as_one_likes(self):
        for name in ("-y.mp4", "http:x.mp4"):
            result = run("flaneur-player", self.pack, "--headless", "--seconds", 0.1, "--size", "64x64", f"--film={name}", cwd=self.folder)
            self.assert_succeeds(result)
            self.assertEqual((self.folder / name).read_bytes()[4:8], b"ftyp")

    def test_no_ffmpeg(self):
        result = self.play("--film", self.folder / "film.mp4", "--size", "64x64", draw=True, env=dict(os.environ, PATH="/none"))
        self.assert_fails(result, "ffmpeg", "install")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_full_disk_leaves_no_half_film(self):
        """Found at once or at the very end, where ffmpeg has the rest of its file still to write."""
        film = ("--seconds", 4, "--size", "320x180", "--film")
        self.assert_succeeds(self.play(*film, self.folder / "film.mp4", draw=True))
        small = self.folder / "small"
        small.mkdir()
        for kilobytes in (4, (self.folder / "film.mp4").stat().st_size // 4096 * 4):
            with self.subTest(kilobytes):
                mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(small)], capture_output=True, check=False)
                if mounted.returncode != 0:
                    self.skipTest("mounting a small file system is not permitted here")
                try:
                    result = self.play(*film, small / "film.mp4", draw=True)
                    self.assert_fails(result, "film.mp4", "cannot be written", "no space left")
                    self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                    self.assertEqual(list(small.iterdir()), [])
                finally:
                    subprocess.run(["umount", str(small)], check=True)

    def test_packs_damaged_at_random_are_refused_in_one_line_or_played(self):
        result = run("broken_packs", self.pack, 300)
        if result.returncode == 77:
            self.skipTest(result.stdout)
        self.assert_succeeds(result)

    def test_options_that_contradict(self):
        self.assert_fails(self.play("--screenshot", self.folder / "a.png"), "--no-draw")
        self.assert_fails(run("flaneur-player", self.pack, "--screenshot", self.folder / "a.png"), "--headless")
        self.assert_fails(self.play("--seconds", "soon"), "--seconds")
        self.assert_fails(self.play("--adaptation", "half"), "--adaptation", "off", "paper", "full")
        still = ("--screenshot", self.folder / "a.png", "--size", "64x32")
        self.assert_fails(self.play("--compare", "off", "full", draw=True), "--compare", "--film")
        self.assert_fails(self.play("--compare", "off", *still, draw=True), "--compare", "2")
        self.assert_fails(self.play("--compare", "off", "half", *still, draw=True), "--compare", "paper")
        self.assert_fails(self.play("--compare", "off", "full", *still, "--metrics", self.folder / "m.csv", draw=True), "--metrics")
        self.assert_fails(self.play("--at", 1, draw=True), "--at", "--screenshot")
        self.assert_fails(self.play("--at", "1,soon", *still, draw=True), "--at", "soon")
        self.assert_fails(self.play("--at", "0.1,9", "--seconds", 1, *still, draw=True), "a_9s.png", "after 1 s")
        self.assert_fails(self.play("--samples", 4, draw=True), "--samples", "--film")
        self.assert_fails(self.play("--samples", 3, *still, draw=True), "--samples", "4")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_two_adaptations_stand_side_by_side(self):
        pictures = {}
        for name, size, options in (("one", "64x64", ()), ("two", "128x64", ("--compare", "off", "full"))):
            pictures[name] = self.folder / f"{name}.png"
            self.assert_succeeds(self.play("--screenshot", pictures[name], "--size", size, *options, draw=True))
        width, height = struct.unpack(">II", pictures["two"].read_bytes()[16:24])
        self.assertEqual((width, height), (128, 64))
        self.assertNotEqual(pictures["one"].read_bytes(), pictures["two"].read_bytes())

    def test_scenarios(self):
        path = self.folder / "scenario.toml"
        for text, words in (("peeple = 3", ("scenario.toml:1", "people")),
                            ('seed = 1\npeople = "many"', ("scenario.toml:2", "whole number")),
                            ("people = ", ("scenario.toml:1", "not TOML")),
                            ('adaptation = "half"', ("off, paper, full",)),
                            ("[[camera.leg]]\nspeed_mps = 1", ("camera.leg", "walk_to_m")),
                            ("[[person]]\ngoals_m = [[1, 2]]", ("position_m",)),
                            ("[[person]]\nposition_m = [-17, 0]", ("person 1", "obstacle")),
                            ("[[person]]\nposition_m = [900, 0]", ("person 1", "outside")),
                            ("[[person]]\nposition_m = [20, 0]\ngoals_m = [[-17, 0]]", ("person 1", "goal 1")),
                            ("[ground]\nmin_m = [0, 0]\nmax_m = [0, 0]", ("ground", "min_m"))):
            with self.subTest(text):
                path.write_text(text)
                self.assert_fails(self.play("--scenario", path), "scenario.toml", *words)
        self.assert_fails(self.play("--scenario", self.folder / "none.toml"), "none.toml", "no such file")


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
