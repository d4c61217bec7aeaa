"""Every operation by which a bake changes files goes wrong in turn, or is the last before it is killed: earlier results are whole, the next bake is right, and nothing is left over.

With FLANEUR_ALL_FAULTS=1 at every operation, else at FLANEUR_FAULTS (10) of them, which take half a minute.
"""
import hashlib
import json
import os
import shutil
import signal
import unittest

from small_tour import SmallTourTest
from support import BIN

LIBRARY = BIN.parent / "lib/fail_files.so"
MADE = ("small.glb", "footprints.geojson", "plan.png")


class Faults(SmallTourTest):
    def setUp(self):
        super().setUp()
        if not LIBRARY.exists():
            self.skipTest(f"no {LIBRARY}: the tests' libraries are not built, or this build has sanitizers, which stand no other preload")

    def faulty(self, number, kind):
        return self.bake("-j", "1", LD_PRELOAD=str(LIBRARY), FAULT_PROGRAM="flaneur", FAULT_AT=str(number), FAULT_KIND=kind,
                         FAULT_COUNT=str(self.folder / "count"))

    def made(self):
        return {name: (self.out / name).read_bytes() for name in MADE if (self.out / name).exists()}

    def assert_whole(self, *allowed):
        """All results are of one bake: byte for byte what its manifest says, and what one of these bakes has made."""
        now = self.made()
        self.assertIn(now, allowed)
        if not now:
            return
        for name, told in json.loads((self.out / "manifest.json").read_text())["files"].items():
            self.assertEqual(hashlib.sha256((self.out / name).read_bytes()).hexdigest(), told["sha256"], name)

    def numbers(self, all_of_them):
        if os.environ.get("FLANEUR_ALL_FAULTS"):
            return range(1, all_of_them + 1)
        most = int(os.environ.get("FLANEUR_FAULTS", "10"))
        return sorted({round(1 + i * (all_of_them - 1) / (most - 1)) for i in range(most)})

    def attack(self, kind, begin, old, new):
        """begin() puts everything into the state from which a bake makes `new` of `old`."""
        begin()
        self.assert_succeeds(self.faulty(0, kind))
        self.assertEqual(self.made(), new)
        count = int((self.folder / "count").read_text())
        self.assertGreater(count, 20)
        for number in self.numbers(count):
            with self.subTest(operation=number, of=count, kind=kind):
                begin()
                result = self.faulty(number, kind)
                self.assertIn(result.returncode, {"fail": (0, 2), "kill": (0, -signal.SIGKILL)}[kind], result.stderr)
                if result.returncode == 2:
                    self.assertEqual(result.stderr.count("error:"), 1, result.stderr)
                    self.assert_whole(old)
                self.assert_whole(*([new] if result.returncode == 0 else [old, new]))
                self.assert_succeeds(self.bake())
                self.assertEqual(self.made(), new)
                self.assert_whole(new)
                self.assertEqual(self.leftovers(), [])

    def test_a_bake_over_an_earlier_one(self):
        self.assert_succeeds(self.bake())
        old = self.made()
        shutil.copytree(self.out, self.folder / "before")
        self.write_tour("[crowd]\npeople = 7\n")
        self.assert_succeeds(self.bake())
        new = self.made()
        self.assertNotEqual(new, old)

        def begin():
            shutil.rmtree(self.out)
            shutil.copytree(self.folder / "before", self.out)
        for kind in ("fail", "kill"):
            self.attack(kind, begin, old, new)

    def test_a_first_bake(self):
        """Whose impostor is in the cache already, so that Blender need not run each time."""
        self.assert_succeeds(self.bake())
        new = self.made()
        shutil.move(self.out / "cache", self.folder / "cache")
        for path in (self.folder / "cache").rglob("*.json"):
            if '"avatar:' in path.read_text() or '"footprints:' in path.read_text():
                path.unlink()

        def begin():
            shutil.rmtree(self.out, ignore_errors=True)
            shutil.copytree(self.folder / "cache", self.out / "cache")
        self.attack("kill", begin, {}, new)


if __name__ == "__main__":
    unittest.main()
