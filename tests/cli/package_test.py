"""The player's Debian package: small, complete, and with nothing of the pipeline in it. The pipeline, installed."""
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from support import BIN

MOST_BYTES = 3_000_000
PIPELINE = ("OpenMesh", "OpenImageIO", "tinygltf", "polyclipping", "gmp", "expat", "proj", "blender")


def output(*command):
    result = subprocess.run(list(map(str, command)), check=False, capture_output=True, text=True)
    if result.returncode != 0:
        raise AssertionError(f"{command[0]} failed:\n{result.stdout}{result.stderr}")
    return result.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if shutil.which("dpkg-shlibdeps") is None:
            raise unittest.SkipTest("no dpkg-shlibdeps: install the Debian package dpkg-dev")
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        output("cpack", "--config", BIN.parent / "CPackConfig.cmake", "-B", cls.folder.name)
        cls.package, = pathlib.Path(cls.folder.name).glob("*.deb")

    def test_dependencies_are_those_of_the_program(self):
        depends = output("dpkg-deb", "-f", self.package, "Depends")
        for name in ("libc6", "libegl1", "libgles2", "libglfw3", "libgl1-mesa-dri", "libdraco"):
            self.assertIn(name, depends)

    def test_unpacks_to_a_small_program_that_runs_and_links_nothing_of_the_pipeline(self):
        root = pathlib.Path(self.folder.name) / "root"
        output("dpkg-deb", "-x", self.package, root)
        program = root / "usr/bin/flaneur-player"
        sanitized = "libasan" in output("ldd", program)
        if not sanitized:
            self.assertLessEqual(program.stat().st_size, MOST_BYTES)
        self.assertIn("tour pack", output(program, "--help"))
        linked = output("ldd", program).lower()
        for library in PIPELINE:
            self.assertNotIn("lib" + library.lower(), linked)
        self.assertTrue((root / "usr/share/doc/flaneur-player/copyright").is_file())


class Installation(unittest.TestCase):
    def test_the_pipeline_works_from_where_it_is_installed(self):
        with tempfile.TemporaryDirectory() as folder:
            output("cmake", "--install", BIN.parent, "--prefix", folder, "--component", "pipeline")
            flaneur = pathlib.Path(folder) / "bin/flaneur"
            self.assertIn("footprint", output(flaneur, "footprints", "--help").lower())
            self.assertIn("directions", output(flaneur, "impostor", "--help").lower())  # a program of its own beside it
            self.assertTrue((pathlib.Path(folder) / "share/flaneur/blender_scripts/convert/to_gltf.py").is_file())


if __name__ == "__main__":
    unittest.main()
