"""A small tour, baked in a few seconds, for tests of how a bake goes."""
import os
import pathlib
import subprocess

from scenes import write_box_town, write_person
from support import BIN, ProgramTest

SMALL = """
[tour]
name = "small"
[town]
file = "town.glb"
[impostor]
directions = 1
height_px = 32
samples = 1
walk_phases = 1
"""
RESULTS = {"small.glb", "footprints.geojson", "plan.png", "report.html", "report.json", "manifest.json"}


class SmallTourTest(ProgramTest):
    avatars = ("plain",)

    def setUp(self):
        super().setUp()
        self.tour = self.folder / "tour/tour.toml"
        self.tour.parent.mkdir()
        write_box_town(self.tour.parent / "town.glb")
        for name in self.avatars:
            write_person(self.tour.parent / f"{name}.glb")
        self.out = self.folder / "out"
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()
        self.write_tour()

    def write_tour(self, more=""):
        avatars = "".join(f'[[avatar]]\nname = "{name}"\nfile = "{name}.glb"\n' for name in self.avatars)
        self.tour.write_text(SMALL + avatars + more)

    def environment(self, **variables):
        return dict(os.environ, TMPDIR=str(self.temporary), **variables)

    def flaneur(self, *arguments, **variables):
        command = [BIN / "flaneur", *arguments]
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, timeout=300,
                              env=self.environment(**variables))

    def bake(self, *options, **variables):
        return self.flaneur("bake", self.tour, "-o", self.out, *options, **variables)

    def results(self):
        return {path.name: path.read_bytes() for path in self.out.glob("*") if path.is_file()}

    def leftovers(self):
        """What nobody wants to find: temporary folders, half-written files, links in between."""
        found = [path for path in self.folder.rglob("*") if ".flaneur_" in path.name or ".part-" in path.name]
        return found + list(self.temporary.iterdir()) + [path for path in self.out.rglob("*") if path.is_symlink()]


def write_program(path, body):
    """A shell script that can be run."""
    path = pathlib.Path(path)
    path.write_text("#!/bin/sh\n" + body)
    path.chmod(0o755)
    return path
