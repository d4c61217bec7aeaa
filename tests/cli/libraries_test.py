"""The libraries as other programs meet them: installed, found by CMake and pkg-config, the samples built and run."""
import ctypes
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from support import BIN, SOURCE, packages

HOUSE = """\
o Square
v 0 0 0
v 40 0 0
v 40 40 0
v 0 40 0
f 1 2 3 4
o House of stone
v 10 10 -0.3
v 18 10 -0.3
v 18 16 -0.3
v 10 16 -0.3
v 10 10 8
v 18 10 8
v 18 16 8
v 10 16 8
f 5 6 10 9
f -7 -6 -2 -3
f 7/1/1 8/1/1 12/1/1 11/1/1
f 8 5 9 12
f 9 10 11 12
"""
# 0.1 m beside the house's obstacle: a gap that nobody passes.
NEIGHBOUR = """\
o Neighbour
v 18.2 10 -0.3
v 26 10 -0.3
v 26 16 -0.3
v 18.2 16 -0.3
v 18.2 10 8
v 26 10 8
v 26 16 8
v 18.2 16 8
f 13 14 18 17
f 14 15 19 18
f 15 16 20 19
f 16 13 17 20
f 17 18 19 20
"""


def call(*command, **options):
    result = subprocess.run(list(map(str, command)), check=False, capture_output=True, text=True, timeout=600, **options)
    if result.returncode != 0:
        raise AssertionError(f"{command[0]} failed:\n{result.stdout}{result.stderr}")
    return result.stdout


def sanitizer():
    """What a program needs beside it to link and load libraries of the sanitizer build."""
    return ["-fsanitize=address,undefined"] if "FLANEUR_ASAN:BOOL=ON" in (BIN.parent / "CMakeCache.txt").read_text() else []


class Samples:
    """The tests, for whatever puts the libraries under cls.prefix; see Installed."""

    prefix = None

    @classmethod
    def build(cls):
        folder = pathlib.Path(cls.folder.name) / "samples"
        call("cmake", "-S", SOURCE / "samples", "-B", folder, f"-DCMAKE_PREFIX_PATH={cls.prefix}", "-DCMAKE_BUILD_TYPE=Release",
             "-DCMAKE_C_FLAGS=-Wall -Wextra -Wpedantic -Werror " + " ".join(sanitizer()),
             "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Werror " + " ".join(sanitizer()))
        call("cmake", "--build", folder)
        return folder

    def footprints(self, text):
        path = pathlib.Path(self.folder.name) / "town.obj"
        path.write_text(text)
        return subprocess.run([self.samples / "footprints_of_obj", path], check=False, capture_output=True, text=True, timeout=600)

    def test_footprints_of_a_house(self):
        result = self.footprints(HOUSE)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("obstacle House of stone:", result.stdout)
        self.assertIn("(9.95, 9.95)", result.stdout)
        self.assertIn("(18.05, 16.05)", result.stdout)
        self.assertIn("1 obstacles, 0 findings", result.stdout)

    def test_footprints_of_two_houses_and_what_is_wrong_between_them(self):
        result = self.footprints(HOUSE + NEIGHBOUR)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("warning 403 at (18.1", result.stdout)

    def test_a_broken_file_is_said(self):
        result = self.footprints(HOUSE + "f 1 2 99\n")
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("index", result.stderr)

    def test_a_crowd_in_a_square_keeps_its_limit_of_meshes(self):
        lines = call(self.samples / "crowd_in_square").splitlines()
        self.assertEqual(len(lines), 20)
        meshes = [sum(map(int, re.search(r"meshes +(\d+) fine +(\d+) middle +(\d+) coarse", line).groups())) for line in lines]
        impostors = [int(re.search(r"(\d+) impostors", line)[1]) for line in lines]
        self.assertLessEqual(max(meshes), 8)
        self.assertGreater(max(meshes), 3)
        self.assertGreater(max(impostors), 20)
        self.assertEqual(lines, call(self.samples / "crowd_in_square").splitlines())  # the same each time

    def test_a_crowd_from_python_leaves_the_room(self):
        library = next(self.prefix.rglob("libflaneur_crowd.so"))
        environment = dict(os.environ)
        if sanitizer():
            environment["LD_PRELOAD"] = call("gcc", "-print-file-name=libasan.so").strip()
        lines = call(sys.executable, SOURCE / "samples/crowd.py", library, env=environment).splitlines()
        self.assertEqual(lines[0], "  0 s: 50 inside, 50 on the way")
        self.assertLess(len(lines), 59)  # before the time was up
        self.assertIn(" 0 inside", lines[-1])

    def test_the_structures_in_python_are_those_of_the_header(self):
        include = next(self.prefix.rglob("base.h")).parent.parent
        specification = importlib.util.spec_from_file_location("crowd_sample", SOURCE / "samples/crowd.py")
        sample = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(sample)
        pairs = {"FlaneurCrowdDef": sample.CrowdDef, "FlaneurPersonDef": sample.PersonDef, "FlaneurPerson": sample.Person,
                 "FlaneurPersonSpan": sample.People, "FlaneurPolygon": sample.Polygon}
        rows = [f'printf("%zu\\n", offsetof({name}, {field}));' for name, kind in pairs.items() for field, _ in kind._fields_]
        rows += [f'printf("%zu\\n", sizeof({name}));' for name in pairs]
        source = "#include <flaneur/crowd.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void) {" + "".join(rows) + "}"
        program = pathlib.Path(self.folder.name) / "layout"
        call("cc", "-std=c99", f"-I{include}", "-xc", "-", "-o", program, input=source)
        wanted = [getattr(kind, field).offset for kind in pairs.values() for field, _ in kind._fields_]
        wanted += [ctypes.sizeof(kind) for kind in pairs.values()]
        self.assertEqual(list(map(int, call(program).split())), wanted)

    def test_pkg_config_finds_headers_and_libraries(self):
        folder = next(self.prefix.rglob("flaneur-footprints.pc")).parent
        flags = call("pkg-config", "--cflags", "--libs", "flaneur-footprints", env=dict(os.environ, PKG_CONFIG_PATH=str(folder)))
        program = pathlib.Path(self.folder.name) / "by_pkg_config"
        call("c++", "-std=c++17", SOURCE / "samples/footprints_of_obj.cpp", "-o", program, *flags.split(), *sanitizer())
        town = pathlib.Path(self.folder.name) / "by_pkg_config.obj"
        town.write_text(HOUSE)
        said = call(program, town, env=dict(os.environ, LD_LIBRARY_PATH=str(folder.parent)))
        self.assertIn("1 obstacles, 0 findings", said)

    def test_each_header_is_c_and_stands_alone(self):
        include = next(self.prefix.rglob("base.h")).parent.parent
        for header in sorted((include / "flaneur").glob("*.h")):
            for compiler in (["cc", "-std=c99", "-xc", "-Wstrict-prototypes"], ["c++", "-std=c++11", "-xc++"]):
                call(*compiler, "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{include}", "-fsyntax-only", "-",
                     input=f"#include <flaneur/{header.name}>\nint main(void) {{ return 0; }}\n")

    def test_samples_are_short(self):
        for path in sorted((SOURCE / "samples").glob("*.*")):
            self.assertLess(len(path.read_text().splitlines()), 100, path)


class Installed(Samples, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="flaneur_libraries_")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.prefix = pathlib.Path(cls.folder.name) / "prefix"
        for component in ("crowd", "footprints", "dev"):
            call("cmake", "--install", BIN.parent, "--prefix", cls.prefix, "--component", component)
        cls.samples = cls.build()


class Packaged(Samples, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="flaneur_libraries_")
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name) / "root"
        for package in packages(cls.folder.name, "crowd", "footprints", "dev").values():
            call("dpkg-deb", "-x", package, root)
        cls.prefix = root / "usr"
        cls.samples = cls.build()


if __name__ == "__main__":
    unittest.main()
