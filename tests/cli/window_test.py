"""The player's window as a visitor uses it: on a display of its own (Xvfb), with keys and mouse by xdotool."""
import csv
import ctypes
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import tomllib
import unittest

from support import BIN, SOURCE, has_tools, split_glb, write_glb

PACK = SOURCE / "build_assets/wolfenbuettel/wolfenbuettel.glb"
TITLE = "Wolfenbüttel"  # of the tour
PATIENCE_S = 120
WIDTH_PX, HEIGHT_PX = 320, 180
SCREEN_PX = 640, 480


class Display:
    """An X server that nobody sees."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory()
        for _ in range(5):
            if self.starts():
                return self
            self.stop()
        raise AssertionError("Xvfb does not start")

    def starts(self):
        """Whether it is there: servers that start at the same time may take each other's number."""
        reading, writing = os.pipe()
        # -noreset: else it starts anew, and refuses whoever comes meanwhile, as soon as its only client has gone.
        self.server = subprocess.Popen(["Xvfb", "-noreset", "-displayfd", str(writing), "-screen", "0", "{}x{}x24".format(*SCREEN_PX)],
                                       pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as number:
            self.name = ":" + number.readline().strip()
        asked = subprocess.run(["xdotool", "getdisplaygeometry"], env=self.environment(), capture_output=True)
        return self.name != ":" and asked.returncode == 0 and self.server.poll() is None

    def stop(self):
        self.server.terminate()
        self.server.wait()

    def __exit__(self, *_):
        self.stop()
        self.folder.cleanup()

    def environment(self):
        return dict(os.environ, DISPLAY=self.name, XDG_CONFIG_HOME=self.folder.name, LIBGL_ALWAYS_SOFTWARE="1")

    def do(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.environment(), check=True, timeout=30,
                              capture_output=True, text=True).stdout

    def beat_s(self):
        """Long enough for three pictures, as fast as they come just now: the player looks for keys between them."""
        title = subprocess.run(["xdotool", "search", "--name", "frames/s", "getwindowname"], env=self.environment(),
                               capture_output=True, text=True).stdout
        told = re.search(r"(\d+) frames/s", title)
        return max(0.3, 3 / max(0.5, float(told.group(1)))) if told else 0.3

    def tap(self, key):
        self.do("keydown", key)
        time.sleep(self.beat_s())
        self.do("keyup", key)
        time.sleep(self.beat_s())

    def open_pages(self):
        """By a key, so that the first row is marked; with the pointer beside them."""
        self.tap("Escape")
        self.do("mousemove", 2, 2)
        time.sleep(1)

    def play(self, *arguments, pack=PACK, people=40, environment=None, verbose=True, size_px=(WIDTH_PX, HEIGHT_PX)):
        command = [BIN / "flaneur-player", pack, "--size", "{}x{}".format(*size_px), "--people", people, *["--verbose"] * verbose, *arguments]
        return subprocess.Popen([str(word) for word in command], env=dict(self.environment(), **(environment or {})),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def shows(self, title):
        return subprocess.run(["xdotool", "search", "--name", title], env=self.environment(), capture_output=True).returncode == 0

    def wait_for(self, title, program, patience_s=PATIENCE_S, every_s=0.2):
        end = time.monotonic() + patience_s
        while time.monotonic() < end and program.poll() is None:
            if self.shows(title):
                return
            time.sleep(every_s)
        said = program.communicate()[1] if program.poll() is not None else "still " + self.do("search", "--name", ".", "getwindowname")
        raise AssertionError(f"no '{title}' in the window's title: {said}")

    def wait_for_window(self, program):
        """Until it is there and has been drawn into: then its title tells the frame rate."""
        self.wait_for("frames/s", program)
        self.do("search", "--name", "frames/s", "windowfocus")

    def ask_to_close(self):
        """As a window manager does for its closing button."""
        xlib = ctypes.CDLL("libX11.so.6")
        xlib.XOpenDisplay.restype = ctypes.c_void_p
        display = ctypes.c_void_p(xlib.XOpenDisplay(self.name.encode()))
        window = ctypes.c_ulong(int(self.do("search", "--name", TITLE).split()[0]))
        atom = {}
        for name in ("WM_PROTOCOLS", "WM_DELETE_WINDOW"):
            xlib.XInternAtom.restype = ctypes.c_ulong
            atom[name] = xlib.XInternAtom(display, name.encode(), 0)

        class ClientMessage(ctypes.Structure):
            _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int), ("display", ctypes.c_void_p),
                        ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong), ("format", ctypes.c_int),
                        ("data", ctypes.c_long * 5), ("room", ctypes.c_long * 24)]
        client_message = 33
        event = ClientMessage(client_message, 0, 1, display, window, atom["WM_PROTOCOLS"], 32)
        event.data[0] = atom["WM_DELETE_WINDOW"]
        xlib.XSendEvent(display, window, 0, 0, ctypes.byref(event))
        xlib.XSync(display, 0)
        xlib.XCloseDisplay(display)


class WindowTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not has_tools("Xvfb", "xdotool"):
            raise unittest.SkipTest("no Xvfb or xdotool: install the Debian packages xvfb and xdotool")
        if not PACK.exists():
            raise unittest.SkipTest(f"no {PACK}: bake the demo tour with ./demo")

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="flaneur_window_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.settings = self.folder / "player.toml"

    def end(self, program):
        try:
            errors = program.communicate(timeout=PATIENCE_S)[1]
        except subprocess.TimeoutExpired:
            program.kill()
            program.communicate()
            raise
        # The machine may have no audio device; what --verbose tells besides is no error.
        return program.returncode, "".join(line for line in errors.splitlines(True) if not re.search("title page|first picture|no sound", line))

    def assert_ends(self, display, program):
        display.do("keydown", "F10")
        self.assertEqual(self.end(program), (0, ""))

    def assert_one_line(self, program, *words):
        code, errors = self.end(program)
        self.assertEqual(code, 2, errors)
        self.assertEqual(len(errors.strip().splitlines()), 1, errors)
        for word in words:
            self.assertIn(word, errors)

    def rows(self, path):
        with open(path, newline="") as file:
            return list(csv.DictReader(file))


class Walking(WindowTest):
    def test_walks_turns_and_ends(self):
        with Display() as display:
            metrics = self.folder / "metrics.csv"
            program = display.play("--metrics", metrics)
            display.wait_for_window(program)
            display.do("keydown", "w")
            time.sleep(3)
            display.do("keyup", "w")
            display.tap("F1")  # the plan and the graphs
            display.tap("F2")
            for _ in range(10):
                display.do("mousemove_relative", "--", -20, 0)
            time.sleep(1)
            self.assert_ends(display, program)
        rows = self.rows(metrics)
        moved = max(abs(float(rows[-1][c]) - float(rows[0][c])) for c in ("camera_x_m", "camera_y_m"))
        self.assertGreater(moved, 0.5)
        self.assertGreater(len({row["camera_yaw_rad"] for row in rows}), 3)

    def test_a_click_leads_there(self):
        with Display() as display:
            metrics = self.folder / "metrics.csv"
            program = display.play("--metrics", metrics, "--set", "pointer=point", people=0)
            display.wait_for_window(program)
            display.tap("Tab")  # off the tour
            display.do("mousemove", WIDTH_PX * 0.6, HEIGHT_PX * 0.75)
            time.sleep(0.5)
            display.do("mousedown", 1)
            time.sleep(0.4)
            display.do("mouseup", 1)
            time.sleep(5)
            self.assert_ends(display, program)
        rows = self.rows(metrics)
        moved = max(abs(float(rows[-1][c]) - float(rows[0][c])) for c in ("camera_x_m", "camera_y_m"))
        self.assertGreater(moved, 0.5)


class Screen(WindowTest):
    def size(self, display):
        told = display.do("search", "--name", TITLE, "getwindowgeometry", "--shell")
        return tuple(int(re.search(rf"^{name}=(\d+)", told, re.MULTILINE)[1]) for name in ("WIDTH", "HEIGHT"))

    def wait_for_size(self, display, size):
        end = time.monotonic() + PATIENCE_S
        while self.size(display) != size and time.monotonic() < end:
            time.sleep(0.2)
        self.assertEqual(self.size(display), size)

    def test_is_filled_by_an_option_and_by_a_key(self):
        with Display() as display:
            program = display.play("--fullscreen", "--settings", self.settings)
            display.wait_for_window(program)
            self.assertEqual(self.size(display), SCREEN_PX)
            display.tap("F11")
            self.wait_for_size(display, (WIDTH_PX, HEIGHT_PX))
            display.tap("F11")
            self.wait_for_size(display, SCREEN_PX)
            self.assert_ends(display, program)

    def test_is_chosen_by_number_or_name_and_those_there_are_are_named(self):
        with Display() as display:
            program = display.play("--monitor", "1", "--seconds", "0.1")
            self.assertEqual(self.end(program), (0, ""))
            self.assert_one_line(display.play("--monitor", "HDMI-7"), "no monitor 'HDMI-7'", "1 screen (640x480)")

    def test_the_windows_title_is_the_tours_alone(self):
        with Display() as display:
            program = display.play(verbose=False)
            display.wait_for(TITLE, program)
            time.sleep(4)
            self.assertEqual(display.do("search", "--name", TITLE, "getwindowname").strip(), TITLE)
            self.assert_ends(display, program)


class GuidedTour(WindowTest):
    def short_tour(self):
        """The demo town with a tour of a few steps: a way, a stop, another."""
        gltf, binary = split_glb(PACK)
        path = gltf["extensions"]["FLANEUR_tour"]["path"]
        first = path[0]["position_m"]
        stops = [dict(path[0]) for _ in range(3)]
        for k, stop in enumerate(stops):
            stop["position_m"] = [first[0] + 5 * k, first[1]]
            if k > 0:
                stop.update(caption=f"Stop {k}.", pause_s=2.5)
        gltf["extensions"]["FLANEUR_tour"]["path"] = stops
        pack = self.folder / "short.glb"
        write_glb(pack, gltf, binary)
        return pack

    def test_is_followed_to_its_end(self):
        with Display() as display:
            metrics = self.folder / "metrics.csv"
            program = display.play("--metrics", metrics, "--set", "keys.pause=p", pack=self.short_tour())
            display.wait_for_window(program)
            display.tap("p")
            display.wait_for("tour paused", program)
            display.tap("p")
            display.do("keydown", "s")  # off the tour
            time.sleep(2)
            display.do("keyup", "s")
            time.sleep(1)
            display.tap("Tab")          # and back to it
            display.tap("n")
            display.tap("b")
            display.wait_for("tour over", program)
            self.assert_ends(display, program)
        rows = self.rows(metrics)
        self.assertGreater(max(float(row["camera_x_m"]) for row in rows), float(rows[0]["camera_x_m"]) + 9)

    def test_its_last_stop_is_reached_from_the_pages(self):
        with Display() as display:
            program = display.play(pack=self.short_tour())
            display.wait_for_window(program)
            display.open_pages()
            for key in ("Down", "Down", "Down", "Return", "Down", "Return"):  # the stops; the second of them
                display.tap(key)
            display.wait_for("tour over", program)
            self.assert_ends(display, program)

    def test_is_held_and_what_is_changed_is_kept(self):
        with Display() as display:
            program = display.play("--settings", self.settings, "--set", "keys.pause=p", "--set", "reduced_motion=true")
            display.wait_for_window(program)
            display.tap("p")
            display.wait_for("tour paused", program)
            display.tap("m")
            display.tap("equal")
            time.sleep(1)
            self.assert_ends(display, program)
            kept = tomllib.loads(self.settings.read_text())
        self.assertEqual(kept["pointer"], "point")
        self.assertGreater(kept["field_of_view_deg"], 0)
        self.assertFalse(kept["reduced_motion"], "only what was changed in the window")
        self.assertIn("space", kept["keys"]["pause"])


class PagesInTheWindow(WindowTest):
    def test_leave_the_view_where_it_was_wherever_the_pointer_is(self):
        with Display() as display:
            metrics = self.folder / "metrics.csv"
            program = display.play("--metrics", metrics, people=0)
            display.wait_for_window(program)
            display.tap("Tab")  # off the tour
            display.open_pages()
            display.do("mousemove", 2 * WIDTH_PX - 20, 2 * HEIGHT_PX + 60)  # beside the window
            time.sleep(0.5)
            display.tap("Escape")
            time.sleep(1)
            self.assert_ends(display, program)
        yaws = [float(row["camera_yaw_rad"]) for row in self.rows(metrics)]
        self.assertLess(max(yaws) - min(yaws), 0.5)

    def test_change_the_language_by_keyboard_and_save_it_when_they_close(self):
        with Display() as display:
            program = display.play("--settings", self.settings)
            display.wait_for_window(program)
            display.open_pages()
            for key in (*["Down"] * 6, "Return", "Down", "Return", "Escape"):  # languages; the second of them
                display.tap(key)
            end = time.monotonic() + PATIENCE_S
            while not self.settings.exists() and time.monotonic() < end:
                time.sleep(0.2)
            self.assertEqual(tomllib.loads(self.settings.read_text())["language"], "de")
            self.assertIsNone(program.poll(), "and it goes on")
            self.assert_ends(display, program)

    def test_end_it_by_mouse(self):
        with Display() as display:
            width_px, height_px = 270, 480  # all rows fit
            program = display.play(size_px=(width_px, height_px))
            display.wait_for_window(program)
            display.tap("Escape")
            time.sleep(1)
            for share in (0.66, 0.67, 0.65, 0.68, 0.64):  # the last row, however letters fall
                if program.poll() is not None:
                    break
                display.do("mousemove", width_px // 2, round(height_px * share))
                time.sleep(0.5)
                display.do("mousedown", 1)
                time.sleep(0.4)
                display.do("mouseup", 1)
                time.sleep(1)
            self.assertEqual(self.end(program)[0], 0)


class Trouble(WindowTest):
    def test_a_wrong_setting_is_named_and_the_file_left_alone(self):
        with Display() as display:
            self.settings.write_text("walk_speed_mps = \"fast\"  # my own note\n")
            program = display.play("--settings", self.settings, "--seconds", "0.2")
            code, errors = self.end(program)
        self.assertEqual(code, 0)
        self.assertEqual(len(errors.splitlines()), 1)
        self.assertIn("player.toml:1: walk_speed_mps must be a number", errors)
        self.assertIn("my own note", self.settings.read_text())

    def test_ended_while_loading(self):
        for wait_s in (0.1, 0.5, 1.0):
            with Display() as display:
                program = display.play()
                time.sleep(wait_s)
                program.send_signal(signal.SIGTERM)
                self.assertIn(self.end(program)[0], (0, -signal.SIGTERM))

    def test_closed_while_loading_and_later(self):
        for later in (False, True):
            with Display() as display:
                program = display.play()
                display.wait_for("frames/s" if later else TITLE, program)
                display.ask_to_close()
                self.assertEqual(self.end(program), (0, ""))

    def test_a_lost_display_is_named(self):
        """Also while the window's context is made, where drivers crash."""
        for title in (TITLE,) * 5 + ("frames/s",):
            with Display() as display:
                program = display.play()
                display.wait_for(title, program, every_s=0.01)
                display.server.kill()
                self.assert_one_line(program, "display was lost")

    def test_a_lost_window_is_named(self):
        with Display() as display:
            program = display.play()
            display.wait_for_window(program)
            display.do("search", "--name", "frames/s", "windowclose")
            self.assert_one_line(program, "window was taken away")

    def test_without_a_display_it_says_what_to_do(self):
        environment = dict(os.environ, DISPLAY=":4711")
        environment.pop("WAYLAND_DISPLAY", None)
        self.assert_one_line(subprocess.Popen([str(BIN / "flaneur-player"), str(PACK)], env=environment, stderr=subprocess.PIPE, text=True),
                             "--headless")

    def test_graphics_too_old_are_named(self):
        too_old = {"MESA_GLES_VERSION_OVERRIDE": "2.0"}
        with Display() as display:
            for options in ((), ("--headless",)):
                with self.subTest(options):
                    self.assert_one_line(display.play("--seconds", "0.1", *options, environment=too_old), "OpenGL ES 3.0", "LIBGL_ALWAYS_SOFTWARE")

    def test_without_a_driver_it_says_what_to_do(self):
        nothing = {"LIBGL_DRIVERS_PATH": "/nowhere", "MESA_LOADER_DRIVER_OVERRIDE": "none", "__EGL_VENDOR_LIBRARY_DIRS": "/nowhere"}
        with Display() as display:
            for options in ((), ("--headless",)):
                with self.subTest(options):
                    self.assert_one_line(display.play("--seconds", "0.1", *options, environment=nothing), "libgl1-mesa-dri")


if __name__ == "__main__":
    unittest.main()
