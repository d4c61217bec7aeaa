"""The Debian packages: complete, with the right dependencies and papers; what is in them works where it is unpacked. The pipeline,
installed. The libraries' packages are tested in libraries_test.py."""
import gzip
import pathlib
import re
import subprocess
import tempfile
import unittest

from support import BIN, packages

MOST_BYTES = 4_000_000  # of the player
PIPELINE = ("OpenMesh", "OpenImageIO", "tinygltf", "polyclipping", "gmp", "expat", "proj", "blender")
NO_ADDRESS = "bogus-mail-host,bogus-mail-host-in-debian-changelog"  # nobody's packages have nobody's address


def output(*command):
    result = subprocess.run(list(map(str, command)), check=False, capture_output=True, text=True)
    if result.returncode != 0:
        raise AssertionError(f"{command[0]} failed:\n{result.stdout}{result.stderr}")
    return result.stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="flaneur_packages_")
        cls.addClassCleanup(folder.cleanup)
        cls.packages = packages(folder.name, "player", "pipeline", "crowd", "footprints", "dev", "demo", "docs")
        cls.root = pathlib.Path(folder.name) / "root"
        for package in cls.packages.values():
            output("dpkg-deb", "-x", package, cls.root)

    def depends(self, name):
        return output("dpkg-deb", "-f", self.packages[name], "Depends")

    def linked(self, program):
        return output("ldd", self.root / program).lower()

    def test_there_is_one_for_whoever_plays_bakes_builds_or_reads(self):
        self.assertEqual(sorted(self.packages), ["flaneur", "flaneur-demo", "flaneur-docs", "flaneur-player", "libflaneur-crowd",
                                                 "libflaneur-dev", "libflaneur-footprints"])

    def test_the_player_depends_on_what_it_links_and_on_a_driver(self):
        for name in ("libc6", "libegl1", "libgles2", "libglfw3", "libgl1-mesa-dri", "libdraco", "libopenal1", "libsndfile1"):
            self.assertIn(name, self.depends("flaneur-player"))

    def test_the_player_is_small_runs_and_links_nothing_of_the_pipeline(self):
        program = self.root / "usr/bin/flaneur-player"
        linked = self.linked(program)
        if "libasan" not in linked:
            self.assertLessEqual(program.stat().st_size, MOST_BYTES)
        self.assertIn("tour pack", output(program, "--help"))
        itself = output("objdump", "-p", program)  # fontconfig brings expat, which the pipeline links for its own sake
        for library in PIPELINE:
            self.assertNotIn("lib" + library.lower(), itself if library.lower() == "expat" else linked)

    def test_the_pipeline_depends_on_what_it_links_and_runs(self):
        for name in ("libgmp10", "libmpfr6", "libproj", "libopenimageio", "libpolyclipping", "libdraco", "libsndfile1"):
            self.assertIn(name, self.depends("flaneur"))
        self.assertIn("blender", output("dpkg-deb", "-f", self.packages["flaneur"], "Recommends"))
        self.assertIn("footprint", output(self.root / "usr/bin/flaneur", "footprints", "--help").lower())
        self.assertTrue((self.root / "usr/share/flaneur/blender_scripts/convert/to_gltf.py").is_file())

    def test_the_demo_tour_plays(self):
        self.assertRegex(self.depends("flaneur-demo"), r"flaneur-player \(= [0-9.]+\)")
        command, = re.findall("^Exec=(.*)$", (self.root / "usr/share/applications/flaneur-demo.desktop").read_text(), re.MULTILINE)
        program, pack = command.split()
        output(self.root / "usr/bin" / program, self.root / pack.lstrip("/"), "--headless", "--no-draw", "--seconds", "1")

    def test_the_player_brings_a_kiosk(self):
        unit = (self.root / "usr/lib/systemd/user/flaneur-kiosk.service").read_text()
        for line in ("Type=notify", "WatchdogSec=10", "Restart=always", "ExecStart=/usr/bin/flaneur-player --kiosk"):
            self.assertIn(line, unit)
        session, = re.findall("^Exec=(.*)$", (self.root / "usr/share/xsessions/flaneur-kiosk.desktop").read_text(), re.MULTILINE)
        self.assertTrue((self.root / session.lstrip("/")).stat().st_mode & 0o100)
        output("sh", "-n", self.root / session.lstrip("/"))
        # The example is in order as it is: all that is wrong is that there is no display.
        nowhere = {"PATH": "/usr/bin:/bin", "DISPLAY": ":4711", "HOME": "/nonexistent"}
        settings = self.root / "usr/share/doc/flaneur-player/examples/kiosk.toml"
        said = subprocess.run([self.root / "usr/bin/flaneur-player", self.root / "usr/share/flaneur/wolfenbuettel.glb", "--kiosk",
                               "--kiosk-settings", settings], env=nowhere, capture_output=True, text=True, check=False)
        self.assertEqual(said.returncode, 2)
        self.assertIn("no display", said.stderr)

    def test_whoever_builds_gets_the_libraries_of_the_same_version(self):
        for library in ("libflaneur-crowd", "libflaneur-footprints"):
            self.assertRegex(self.depends("libflaneur-dev"), rf"{library} \(= [0-9.]+\)")
        self.assertIn("libgmp10", self.depends("libflaneur-footprints"))

    def test_the_crowd_links_the_system_alone(self):
        linked = {name.split("-")[0] for name in re.findall(r"[\w+-]+(?= \()", self.depends("libflaneur-crowd"))}
        self.assertLessEqual(linked, {"libc6", "libgcc", "libstdc++6", "libasan8", "libubsan1"})

    def test_each_says_who_may_do_what_with_it(self):
        for name in self.packages:
            papers = self.root / "usr/share/doc" / name
            copyright_text = (papers / "copyright").read_text()
            self.assertTrue(copyright_text.startswith("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/"))
            stated = set(re.findall(r"^License: (\S+)(?: and (\S+))?$", copyright_text, re.MULTILINE))
            texts = set(re.findall(r"^License: (\S+)\n ", copyright_text, re.MULTILINE))
            self.assertEqual({n for pair in stated for n in pair if n}, texts)
            notice = (papers / "NOTICE").read_text()
            for library in ("CGAL", "GPL", "OpenAL Soft", "libsndfile", "ImGui", "meshoptimizer", "PROJ", "Boost", "GMP", "MPFR"):
                self.assertIn(library, notice)

    def test_notice_names_every_library_that_a_program_links_itself(self):
        notice = (self.root / "usr/share/doc/flaneur/NOTICE").read_text().lower()
        spelled = {"polyclipping": "clipper", "brotlienc": "brotli", "tomlplusplus": "toml++", "glesv2": "opengl es", "openal": "openal soft",
                   "openimageio_util": "openimageio", "openmeshcore": "openmesh", "zstd": "zstandard"}
        system = {"c", "m", "gcc_s", "stdc++", "ld-linux-x86-64", "asan", "ubsan"}
        for binary in ("bin/flaneur-player", "bin/flaneur", "lib/flaneur/flaneur_pictures.so", "lib/libflaneur_crowd.so.0.2", "lib/libflaneur_footprints.so.0.2"):
            for library in re.findall(r"NEEDED +(?:lib)?(\S+?)\.so", output("objdump", "-p", self.root / "usr" / binary)):
                name = library.lower()
                if name not in system:
                    self.assertIn(spelled.get(name, name), notice, binary)

    def test_manual_pages_are_there_for_each_program_and_verb(self):
        verbs = re.findall(r"^  flaneur (\w+)", output(self.root / "usr/bin/flaneur", "--help"), re.MULTILINE)
        self.assertGreaterEqual(len(verbs), 6)
        for name in ["flaneur-player", "flaneur", *(f"flaneur-{verb}" for verb in verbs)]:
            page = gzip.decompress((self.root / f"usr/share/man/man1/{name}.1.gz").read_bytes()).decode()
            self.assertRegex(page, rf"(?m)^{name} \\- \w")
            self.assertNotIn(str(BIN), page)  # a folder of the machine it was built on

    def test_lintian_finds_no_error(self):
        output("lintian", "--allow-root", "--fail-on", "error", "--suppress-tags", NO_ADDRESS, *self.packages.values())


class Installation(unittest.TestCase):
    def test_the_pipeline_works_from_where_it_is_installed(self):
        with tempfile.TemporaryDirectory() as folder:
            output("cmake", "--install", BIN.parent, "--prefix", folder, "--component", "pipeline")
            flaneur = pathlib.Path(folder) / "bin/flaneur"
            self.assertIn("footprint", output(flaneur, "footprints", "--help").lower())
            self.assertIn("directions", output(flaneur, "impostor", "--help").lower())
            self.assertNotIn("OpenImageIO", output("objdump", "-p", flaneur))  # slow to load
            (module,) = pathlib.Path(folder).glob("lib/**/flaneur_pictures.so")
            self.assertIn("libOpenImageIO.so", output("objdump", "-p", module))
            self.assertTrue((pathlib.Path(folder) / "share/flaneur/blender_scripts/convert/to_gltf.py").is_file())


if __name__ == "__main__":
    unittest.main()
