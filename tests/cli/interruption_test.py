"""An interrupted bake, and one on a full disk, leave all as it was: the earlier pack, no half-written file, no running child."""
import os
import pathlib
import signal
import subprocess
import time
import unittest

from scenes import write_box_town, write_person
from support import BIN, ProgramTest, run

TOUR = """
[tour]
name = "small"
[town]
file = "town.glb"
[[avatar]]
name = "plain"
file = "plain.glb"
[impostor]
directions = 1
height_px = 32
samples = 1
walk_phases = 1
"""
# In Blender's place: says who it is, lets something half-written lie about, and works on.
SLOW_BLENDER = """#!/bin/sh
echo half > "$TMPDIR/half-written"
sleep 300 &
echo $$ > "{marker}.new"
mv "{marker}.new" "{marker}"
wait
"""


class Interruption(ProgramTest):
    def setUp(self):
        super().setUp()
        write_box_town(self.folder / "town.glb")
        write_person(self.folder / "plain.glb")
        (self.folder / "tour.toml").write_text(TOUR)
        self.out = self.folder / "out"
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()

    def results(self):
        """What the bake made, by name; what its cache holds is its own affair, but for hidden and partial files."""
        files = [p for p in self.folder.rglob("*") if p.is_file()]
        loose = [p for p in files if ".part-" in p.name or "/.flaneur_" in str(p) or self.temporary in p.parents]
        self.assertEqual(loose, [])
        return {p.name: p.read_bytes() for p in self.out.glob("*") if p.is_file()}

    def bake(self, *command):
        command = [*command, BIN / "flaneur", "bake", self.folder / "tour.toml", "-o", self.out]
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)

    def interrupt(self, number):
        """Starts a bake that needs Blender, and ends it by a signal once Blender runs."""
        marker = self.folder / "marker"
        blender = self.folder / "blender"
        blender.write_text(SLOW_BLENDER.format(marker=marker))
        blender.chmod(0o755)
        environment = dict(os.environ, FLANEUR_BLENDER=str(blender), TMPDIR=str(self.temporary))
        bake = subprocess.Popen([BIN / "flaneur", "bake", self.folder / "tour.toml", "-o", self.out], env=environment,
                                stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not marker.exists() and bake.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        group = int(marker.read_text())
        bake.send_signal(number)
        complaint = bake.communicate(timeout=60)[1]
        self.assertEqual(bake.returncode, -number, complaint)
        self.assertEqual(len([line for line in complaint.splitlines() if "interrupted" in line]), 1, complaint)
        return group

    def assert_group_ends(self, group):
        deadline = time.monotonic() + 10
        while time.monotonic() < deadline:
            members = [p for p in pathlib.Path("/proc").glob("[0-9]*/stat") if self.group_of(p) == group]
            if not members:
                return
            time.sleep(0.05)
        self.fail(f"still running: {members}")

    @staticmethod
    def group_of(stat):
        """The process group of a living process."""
        try:
            state, _, group = stat.read_text().rsplit(")", 1)[1].split()[:3]
        except OSError:
            return 0
        return 0 if state == "Z" else int(group)

    def test_signals_keep_the_earlier_pack_and_end_blender(self):
        self.assertEqual(self.bake().returncode, 0)
        before = self.results()
        self.assertIn("small.glb", before)
        for height, number in ((1.6, signal.SIGINT), (1.7, signal.SIGTERM), (1.8, signal.SIGHUP)):
            with self.subTest(number):
                changed = TOUR.replace('"plain.glb"', f'"plain.glb"\nheight_m = {height}')
                (self.folder / "tour.toml").write_text(changed)
                self.assert_group_ends(self.interrupt(number))
                (self.folder / "marker").unlink()
                self.assertEqual(self.results(), before)

    def test_a_first_bake_interrupted_leaves_no_results(self):
        self.assert_group_ends(self.interrupt(signal.SIGTERM))
        self.assertEqual(self.results(), {})
        self.assertEqual(self.bake().returncode, 0)

    def test_full_disk_keeps_all_earlier_results(self):
        self.assertEqual(self.bake().returncode, 0)
        before = self.results()
        (self.folder / "tour.toml").write_text(TOUR + "[crowd]\npeople = 3\n")
        # No file may grow beyond so many KiB, as on a full disk: all is written but the pack, or nothing at all.
        for kilobytes in (len(before["small.glb"]) // 1024 - 1, 0):
            with self.subTest(kilobytes):
                result = self.bake("bash", "-c", f"ulimit -f {kilobytes}; trap '' XFSZ; exec \"$@\"", "bash")
                self.assert_fails(result, "cannot be written")
                self.assertEqual(self.results(), before)

    def test_full_file_system(self):
        """The same on a real one, where this user may make one."""
        small = self.folder / "small"
        small.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(small)], capture_output=True,
                                 check=False)
        if mounted.returncode != 0:
            self.skipTest("mounting a small file system is not permitted here; the size limit above stands for it")
        self.addCleanup(subprocess.run, ["umount", str(small)], check=True)
        out, self.out = self.out, small / "out"
        self.assert_succeeds(self.bake())
        before = self.results()
        free = os.statvfs(small).f_bavail * os.statvfs(small).f_frsize
        (small / "filler").write_bytes(b"x" * max(0, free - 4096))
        (self.folder / "tour.toml").write_text(TOUR + "[crowd]\npeople = 3\n")
        self.assert_fails(self.bake(), "cannot be written")
        self.assertEqual(self.results(), before)
        self.out = out


if __name__ == "__main__":
    unittest.main()
