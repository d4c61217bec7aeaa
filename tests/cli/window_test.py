"""The player's window as a visitor uses it: on a display of its own (Xvfb), with keys and mouse by xdotool."""
import csv
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import tomllib
import unittest

from support import BIN, SOURCE

PACK = SOURCE / "build_assets/wolfenbuettel/wolfenbuettel.glb"
PATIENCE_S = 120


class Display:
    """An X server that nobody sees."""

    def __enter__(self):
        reading, writing = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "640x480x24"],
                                       pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as number:
            self.name = ":" + number.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def environment(self):
        return dict(os.environ, DISPLAY=self.name, XDG_CONFIG_HOME=tempfile.mkdtemp(), LIBGL_ALWAYS_SOFTWARE="1")

    def do(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self.environment(), check=True, timeout=30,
                       capture_output=True)

    def play(self, *arguments):
        return subprocess.Popen([str(BIN / "flaneur-player"), str(PACK), "--size", "320x180", "--people", "40", *map(str, arguments)],
                                env=self.environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for_window(self, program):
        """Until it is there and has been drawn into: then its title tells the frame rate."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end and program.poll() is None:
            if subprocess.run(["xdotool", "search", "--name", "frames/s"], env=self.environment(), capture_output=True).returncode == 0:
                return
            time.sleep(0.2)
        raise AssertionError("no picture: " + (program.communicate()[1] if program.poll() is not None else "too late"))


class Window(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for tool, package in (("Xvfb", "xvfb"), ("xdotool", "xdotool")):
            if shutil.which(tool) is None:
                raise unittest.SkipTest(f"no {tool}: install the Debian package {package}")
        if not PACK.exists():
            raise unittest.SkipTest(f"no {PACK}: bake the demo tour with ./demo")

    def end(self, program):
        try:
            errors = program.communicate(timeout=PATIENCE_S)[1]
        except subprocess.TimeoutExpired:
            program.kill()
            program.communicate()
            raise
        return program.returncode, errors

    def test_walks_turns_and_ends(self):
        with Display() as display, tempfile.TemporaryDirectory() as folder:
            metrics = pathlib.Path(folder) / "metrics.csv"
            program = display.play("--metrics", metrics)
            display.wait_for_window(program)
            display.do("search", "--name", "frames/s", "windowfocus")
            display.do("keydown", "w")
            time.sleep(3)
            display.do("keyup", "w")
            display.do("key", "F1")  # the plan and the graphs
            time.sleep(1)
            display.do("key", "F2")
            for _ in range(10):
                display.do("mousemove_relative", "--", -20, 0)
            time.sleep(1)
            display.do("keydown", "F10")  # held: a slow machine looks for keys between its pictures
            self.assertEqual(self.end(program)[0], 0)
            with open(metrics, newline="") as file:
                rows = list(csv.DictReader(file))
            first, last = rows[0], rows[-1]
            moved = max(abs(float(last[c]) - float(first[c])) for c in ("camera_x_m", "camera_y_m"))
            self.assertGreater(moved, 0.5)
            self.assertGreater(len({row["camera_yaw_rad"] for row in rows}), 3)

    def test_holds_the_tour_and_keeps_what_is_changed(self):
        with Display() as display, tempfile.TemporaryDirectory() as folder:
            settings = pathlib.Path(folder) / "player.toml"
            program = display.play("--settings", settings, "--set", "keys.pause=p", "--set", "reduced_motion=true")
            display.wait_for_window(program)
            display.do("search", "--name", "frames/s", "windowfocus")
            display.do("key", "p")
            time.sleep(3)
            display.do("search", "--name", "tour paused")
            display.do("key", "m")
            display.do("key", "equal")
            time.sleep(1)
            display.do("keydown", "F10")
            code, errors = self.end(program)
            self.assertEqual((code, errors), (0, ""))
            kept = tomllib.loads(settings.read_text())
        self.assertEqual(kept["pointer"], "point")
        self.assertGreater(kept["field_of_view_deg"], 0)
        self.assertFalse(kept["reduced_motion"], "only what was changed in the window")
        self.assertIn("space", kept["keys"]["pause"])

    def test_a_wrong_setting_is_named_and_the_file_left_alone(self):
        with Display() as display, tempfile.TemporaryDirectory() as folder:
            settings = pathlib.Path(folder) / "player.toml"
            settings.write_text("walk_speed_mps = \"fast\"  # my own note\n")
            program = display.play("--settings", settings, "--seconds", "0.2")
            code, errors = self.end(program)
            self.assertEqual(code, 0)
            self.assertEqual(len(errors.splitlines()), 1)
            self.assertIn("player.toml:1: walk_speed_mps must be a number", errors)
            self.assertIn("my own note", settings.read_text())

    def test_closed_while_loading(self):
        for wait_s in (0.1, 0.5, 1.0):
            with Display() as display:
                program = display.play()
                time.sleep(wait_s)
                program.send_signal(signal.SIGTERM)
                self.assertIn(self.end(program)[0], (0, -signal.SIGTERM))

    def test_a_lost_display_ends_it_with_a_message(self):
        with Display() as display:
            program = display.play()
            display.wait_for_window(program)
            display.server.kill()
            code, errors = self.end(program)
        self.assertGreater(code, 0)
        self.assertTrue(errors.strip())

    def test_without_a_display_it_says_what_to_do(self):
        environment = dict(os.environ, DISPLAY=":4711")
        environment.pop("WAYLAND_DISPLAY", None)
        done = subprocess.run([str(BIN / "flaneur-player"), str(PACK)], env=environment, capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1)
        self.assertIn("--headless", done.stderr)

    def test_without_a_driver_it_says_what_to_do(self):
        environment = dict(os.environ, LIBGL_DRIVERS_PATH="/nowhere", MESA_LOADER_DRIVER_OVERRIDE="none", __EGL_VENDOR_LIBRARY_DIRS="/nowhere")
        done = subprocess.run([str(BIN / "flaneur-player"), str(PACK), "--headless", "--seconds", "0.1"], env=environment,
                              capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(done.returncode, 2)
        self.assertIn("libgl1-mesa-dri", done.stderr)


if __name__ == "__main__":
    unittest.main()
