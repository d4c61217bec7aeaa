"""The demo tour's pictures look as they did when somebody last looked at them.

Reference stills stand beside their scenarios in tests/data/stills. `stills_test.py --remake` draws them anew, from the demo tour as it
is baked now: look at each before committing it. `stills_test.py --compare FOLDER` compares those that a folder holds with them.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import BIN, SOURCE, ProgramTest, has_tools

PACK = SOURCE / "build_assets/wolfenbuettel/wolfenbuettel.glb"
STILLS = SOURCE / "tests/data/stills"
SIZE = "320x180"
# Drivers differ in the last bits, in smoothing edges and in choosing mip levels: pictures are compared as averages of 4 x 4 pixels. Drawn
# by Mesa's other software rasterizer, without any multisampling, up to 2.6 % of those are off; without people, their
# shadows, or with the sun an hour later at least 7.7 %.
COMPARED = "80x45"
TOLERANCE, MOST_OFF_PERCENT = 0.12, 4


def draw(scenario, picture, *options, environment=None):
    command = [str(BIN / "flaneur-player"), str(PACK), "--headless", "--scenario", str(scenario), "--screenshot", str(picture), *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, env=dict(os.environ, **(environment or {})))
    if done.returncode != 0:
        raise AssertionError(done.stderr)


def draw_still(name, picture, **options):
    if name != "plan":
        return draw(STILLS / f"{name}.toml", picture, "--size", SIZE, **options)
    whole = pathlib.Path(picture).with_suffix(".whole.png")
    draw(STILLS / "crowd_far.toml", whole, "--views", "--size", "640x360", **options)
    subprocess.run(["oiiotool", str(whole), "--cut", "260x330+5+5", "-o", str(picture)], check=True)  # beside it are frame times
    whole.unlink()


def look_alike(one, other):
    with tempfile.TemporaryDirectory() as folder:
        small = [str(pathlib.Path(folder) / name) for name in ("one.png", "other.png")]
        for picture, to in zip((one, other), small):
            subprocess.run(["oiiotool", str(picture), "--resize:filter=box", COMPARED, "-o", to], check=True)
        result = subprocess.run(["idiff", "-fail", str(TOLERANCE), "-failpercent", str(MOST_OFF_PERCENT), "-warn", "1", *small],
                                capture_output=True, text=True)
        return result.returncode == 0, result.stdout


NAMES = ("morning", "noon", "dusk", "crowd_near", "crowd_far", "shadow", "plan")


class Stills(ProgramTest):
    @classmethod
    def setUpClass(cls):
        if not has_tools("idiff", "oiiotool"):
            raise unittest.SkipTest("no idiff: install the Debian package openimageio-tools")
        if not PACK.exists():
            raise unittest.SkipTest(f"no {PACK}: bake the demo tour with ./demo")

    def assert_alike(self, one, other):
        alike, said = look_alike(one, other)
        self.assertTrue(alike, f"{one} and {other} differ:\n{said}")

    def assert_different(self, one, other):
        self.assertFalse(look_alike(one, other)[0], f"{one} and {other} pass for the same")

    def test_look_as_they_did(self):
        for name in NAMES:
            with self.subTest(name):
                picture = self.folder / f"{name}.png"
                draw_still(name, picture)
                self.assert_alike(STILLS / f"{name}.png", picture)

    def test_a_still_of_several_is_that_of_a_run_which_ends_there(self):
        run = [str(BIN / "flaneur-player"), str(PACK), "--headless", "--people", "100", "--size", SIZE]
        subprocess.run([*run, "--at", "12.5,2", "--screenshot", str(self.folder / "walk.png")], check=True, capture_output=True)
        for moment in ("2", "12.5"):
            subprocess.run([*run, "--seconds", moment, "--screenshot", str(self.folder / "one.png")], check=True, capture_output=True)
            self.assertEqual((self.folder / f"walk_{moment}s.png").read_bytes(), (self.folder / "one.png").read_bytes(), moment)

    def test_another_rasterizer_makes_no_difference(self):
        picture = self.folder / "shadow.png"
        draw_still("shadow", picture, environment={"GALLIUM_DRIVER": "softpipe", "LIBGL_ALWAYS_SOFTWARE": "1"})
        self.assert_alike(STILLS / "shadow.png", picture)

    def test_missing_people_and_shadows_are_noticed(self):
        for name in ("crowd_near", "crowd_far", "shadow"):
            with self.subTest(name):
                scenario, picture = self.folder / f"{name}.toml", self.folder / f"{name}.png"
                scenario.write_text((STILLS / f"{name}.toml").read_text().split("[[person]]")[0])
                draw(scenario, picture, "--size", SIZE)
                self.assert_different(STILLS / f"{name}.png", picture)

    def test_another_hour_is_noticed(self):
        picture = self.folder / "noon.png"
        draw(STILLS / "noon.toml", picture, "--size", SIZE, "--hour", "13")
        self.assert_different(STILLS / "noon.png", picture)

    def test_a_missing_sky_is_noticed(self):
        for name in ("morning", "noon"):
            picture = self.folder / f"{name}.png"
            subprocess.run(["oiiotool", str(STILLS / f"{name}.png"), "--fill:color=0,0,0", SKY, "-o", str(picture)], check=True)
            self.assert_different(STILLS / f"{name}.png", picture)


SKY = "90x40+190+0"  # in the pictures of the market square


def remake():
    for name in NAMES:
        draw_still(name, STILLS / f"{name}.png")
        print(STILLS / f"{name}.png")


def compare(folder):
    """The exit status: 0 where all that are in the folder look like the reference stills of their names."""
    pictures = sorted(pathlib.Path(folder).glob("*.png"))
    alike = [look_alike(STILLS / picture.name, picture) for picture in pictures]
    for picture, (same, said) in zip(pictures, alike):
        print(picture.name, "is alike" if same else f"differs:\n{said}")
    return 0 if pictures and all(same for same, _ in alike) else 1


if __name__ == "__main__":
    if sys.argv[1:] == ["--remake"]:
        remake()
    elif sys.argv[1:2] == ["--compare"]:
        sys.exit(compare(sys.argv[2]))
    else:
        unittest.main()
