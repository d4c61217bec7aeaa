"""A bake that is killed, meets damaged files or programs that hang: nothing is lost, mixed up or left behind."""
import json
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from small_tour import RESULTS, SmallTourTest, write_program
from support import BIN


def is_alive(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


class Damaged(SmallTourTest):
    def test_a_changed_result_is_made_again(self):
        self.assert_succeeds(self.bake())
        good = self.results()
        self.assertEqual(set(good), RESULTS)
        for name in sorted(RESULTS - {"report.json", "manifest.json"}):
            for damage in (lambda data: data[:len(data) // 2] + bytes([data[len(data) // 2] ^ 1]) + data[len(data) // 2 + 1:],
                           lambda data: b""):
                with self.subTest(name):
                    (self.out / name).write_bytes(damage(good[name]))
                    self.assert_succeeds(self.bake())
                    for same in {"small.glb", "footprints.geojson", "plan.png"}:
                        self.assertEqual(self.results()[same], good[same])
                    self.assertGreater(len(self.results()[name]), 100)
        for name in ("report.json", "manifest.json"):
            (self.out / name).write_text("{}")
            self.assert_succeeds(self.bake())
            self.assertIn("stages", json.loads((self.out / "report.json").read_text()))

    def test_the_manifest_names_what_is_there(self):
        self.assert_succeeds(self.bake())
        files = json.loads((self.out / "manifest.json").read_text())["files"]
        self.assertEqual(set(files), RESULTS - {"manifest.json"})
        for name, told in files.items():
            summed = subprocess.run(["sha256sum", str(self.out / name)], check=True, capture_output=True, text=True)
            self.assertEqual(told["sha256"], summed.stdout.split()[0])

    def test_a_scripts_town_with_a_flipped_bit_is_made_again(self):
        shutil.move(self.tour.parent / "town.glb", self.tour.parent / "made.glb")
        (self.tour.parent / "build.py").write_text(
            "import json, shutil, sys\nsettings = json.load(open(sys.argv[-1]))\n"
            "shutil.copy(settings['options']['made'], settings['output'])\n")
        made = self.tour.parent / "made.glb"
        self.tour.write_text(self.tour.read_text().replace('"town.glb"', f'"build.py"\noptions = {{ made = "{made}" }}'))
        self.assert_succeeds(self.bake("--allow-scripts"))
        good = self.results()["small.glb"]
        kept, = (self.out / "cache").rglob("*.glb")
        data = bytearray(kept.read_bytes())
        data[-20] ^= 1
        kept.write_bytes(data)
        (self.out / "small.glb").unlink()
        for file in (self.out / "cache").rglob("*.kept"):  # so that the town has to be read
            file.unlink()
        self.assert_succeeds(self.bake("--allow-scripts"))
        self.assertEqual(self.results()["small.glb"], good)
        self.assertNotEqual(kept.read_bytes(), bytes(data))

    def test_a_script_that_writes_half_a_town_poisons_nothing(self):
        town = self.tour.parent / "town.glb"
        script = self.tour.parent / "build.py"
        copy = "import json, sys\nsettings = json.load(open(sys.argv[-1]))\ndata = open({town!r}, 'rb').read()[:{size}]\nopen(settings['output'], 'wb').write(data)\n"
        self.tour.write_text(self.tour.read_text().replace('"town.glb"', '"build.py"'))
        size = town.stat().st_size
        script.write_text(copy.format(town=str(town), size=size - 100))
        self.assert_fails(self.bake("--allow-scripts"), "town.glb", "no whole glTF")
        self.assertEqual(self.results(), {})
        script.write_text(copy.format(town=str(town), size=size))
        self.assert_succeeds(self.bake("--allow-scripts"))

    def test_a_file_that_a_script_reads_is_in_its_key(self):
        """Though nothing names it: neither tour.toml nor the script's folder."""
        town = self.tour.parent / "data/town.glb"
        town.parent.mkdir()
        shutil.move(self.tour.parent / "town.glb", town)
        (self.tour.parent / "scripts").mkdir()
        (self.tour.parent / "scripts/build.py").write_text(
            f"import json, sys\nsettings = json.load(open(sys.argv[-1]))\nopen(settings['output'], 'wb').write(open({str(town)!r}, 'rb').read())\n")
        self.tour.write_text(self.tour.read_text().replace('"town.glb"', '"scripts/build.py"'))
        self.assert_succeeds(self.bake("--allow-scripts"))
        self.assert_succeeds(self.bake("--allow-scripts"))
        self.assertTrue(all(stage["cached"] for stage in json.loads((self.out / "report.json").read_text())["stages"]))
        from scenes import write_box_town  # pylint: disable=import-outside-toplevel
        write_box_town(town, houses=2)
        self.assert_succeeds(self.bake("--allow-scripts"))
        made = {stage["stage"] for stage in json.loads((self.out / "report.json").read_text())["stages"] if not stage["cached"]}
        self.assertIn("source", made)
        self.assertIn("footprints", made)


class Killed(SmallTourTest):
    def start(self, *options, **variables):
        command = [BIN / "flaneur", "bake", self.tour, "-o", self.out, *options]
        return subprocess.Popen(list(map(str, command)), env=self.environment(**variables), stderr=subprocess.PIPE,
                                stdout=subprocess.DEVNULL, text=True)

    def start_with_slow_blender(self, body, *options):
        """Until that Blender runs; the processes that it names."""
        marker = self.folder / "marker"
        marker.unlink(missing_ok=True)
        blender = write_program(self.folder / "blender", f'{body}\necho $$ $! > "{marker}.new"; mv "{marker}.new" "{marker}"\nwait\nwait\n')
        bake = self.start(*options, FLANEUR_BLENDER=str(blender))
        deadline = time.monotonic() + 60
        while not marker.exists() and bake.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        return bake, [int(word) for word in marker.read_text().split()]

    def assert_all_end(self, processes, seconds):
        deadline = time.monotonic() + seconds
        while any(map(is_alive, processes)):
            self.assertLess(time.monotonic(), deadline, f"still running: {processes}")
            time.sleep(0.05)

    def test_blender_and_what_it_started_end_with_a_bake_that_is_killed(self):
        bake, processes = self.start_with_slow_blender('echo half > "$TMPDIR/half"\nsleep 300 &')
        bake.kill()
        bake.communicate(timeout=60)
        self.assert_all_end(processes, 10)
        self.assertNotEqual(self.leftovers(), [], "nobody could tidy up")
        self.assert_succeeds(self.bake())
        self.assertEqual(self.leftovers(), [])
        self.assertEqual(set(self.results()), RESULTS)

    def test_blender_that_does_not_listen_is_killed(self):
        bake, processes = self.start_with_slow_blender("trap '' TERM\n(trap '' TERM; sleep 300; sleep 300) &")
        bake.send_signal(signal.SIGTERM)
        self.assertIn("interrupted", bake.communicate(timeout=20)[1])
        self.assertEqual(bake.returncode, -signal.SIGTERM)
        self.assert_all_end(processes, 10)
        self.assertEqual(self.leftovers(), [])

    def test_blender_that_takes_too_long_is_stopped_and_said_so(self):
        bake, processes = self.start_with_slow_blender("sleep 300 &", "--time-limit", "1")
        complaint = bake.communicate(timeout=30)[1]
        self.assertEqual(bake.returncode, 2, complaint)
        self.assertIn("stopped after 1 s", complaint)
        self.assertIn("--time-limit", complaint)
        self.assert_all_end(processes, 10)

    def test_two_bakes_into_one_folder_wait_for_each_other(self):
        bakes = [self.start(), self.start()]
        for bake in bakes:
            self.assertEqual((bake.communicate(timeout=300)[1].count("error"), bake.returncode), (0, 0))
        self.assertEqual(set(self.results()), RESULTS)
        self.assertEqual(self.leftovers(), [])


if __name__ == "__main__":
    unittest.main()
