"""A kiosk as children, operators and crashes meet it: on a display of its own, with keys and mouse by xdotool."""
import csv
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

from support import BIN, SOURCE, has_tools
from window_test import PACK, PATIENCE_S, SCREEN_PX, TITLE, Display

PIN = "4711"
HANG_S = 3
RESTART_S = 10  # after which a kiosk must be there again; on a machine that others share by so many times as long
SHARE = 4


def child_of(program):
    found = subprocess.run(["pgrep", "-P", str(program.pid)], capture_output=True, text=True, check=False).stdout.split()
    return int(found[0]) if found else None


class ServiceTest(unittest.TestCase):
    def test_systemd_takes_the_unit_without_a_word(self):
        if not has_tools("systemd-analyze"):
            self.skipTest("no systemd-analyze: install the Debian package systemd")
        unit = (SOURCE / "packaging/kiosk/flaneur-kiosk.service").read_text()
        with tempfile.TemporaryDirectory(prefix="flaneur_unit_") as folder:
            def verify(text):
                path = pathlib.Path(folder) / "flaneur-kiosk.service"
                path.write_text(text.replace("/usr/bin/flaneur-player", str(BIN / "flaneur-player"))
                                .replace("/usr/share/doc/flaneur-docs", str(SOURCE)))
                done = subprocess.run(["systemd-analyze", "verify", "--user", str(path)], env=dict(os.environ, XDG_RUNTIME_DIR=folder),
                                      capture_output=True, text=True, timeout=PATIENCE_S, check=False)
                return done.returncode, done.stderr
            self.assertEqual(verify(unit), (0, ""))
            self.assertIn("WatchdogSecs", verify(unit.replace("WatchdogSec=", "WatchdogSecs="))[1], "else it looks at nothing")


class KioskTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not has_tools("Xvfb", "xdotool", "pgrep"):
            raise unittest.SkipTest("no Xvfb, xdotool or pgrep: install the Debian packages xvfb, xdotool and procps")
        if not PACK.exists():
            raise unittest.SkipTest(f"no {PACK}: bake the demo tour with ./demo")

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="flaneur_kiosk_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        display = Display()
        self.display = display.__enter__()
        self.addCleanup(display.__exit__)

    def start(self, *arguments, settings="", environment=None, pack=True):
        file = self.folder / "kiosk.toml"
        file.write_text(f"pin = \"{PIN}\"\nhang_s = {HANG_S}\nstatistics_folder = \"visits\"\n{settings}")
        command = [str(BIN / "flaneur-player"), *[str(PACK)] * pack, "--kiosk", "--kiosk-settings", str(file), "--people", "10", "--verbose",
                   *arguments]
        self.log = open(self.folder / "log", "w+")
        self.addCleanup(self.log.close)
        program = subprocess.Popen(command, env=dict(self.display.environment(), **(environment or {})), stderr=self.log, start_new_session=True)
        self.addCleanup(self.kill, program)
        return program

    def kill(self, program):
        try:
            os.killpg(program.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        program.wait()

    def said(self):
        return pathlib.Path(self.log.name).read_text()

    def wait_until(self, what, patience_s=PATIENCE_S):
        began = time.monotonic()
        while time.monotonic() - began < patience_s:
            if what():
                return time.monotonic() - began
            time.sleep(0.1)
        raise AssertionError(f"waited {patience_s} s in vain; it said: {self.said()}")

    def wait_for_pictures(self, program):
        self.display.wait_for_window(program)

    def wait_for_another(self, program, before):
        """Until another process plays than the one before, and shows the town."""
        def is_there():
            return child_of(program) not in (None, before) and self.display.shows("frames/s")
        return self.wait_until(is_there, SHARE * RESTART_S)

    def hold(self, key, seconds):
        self.display.do("keydown", key)
        time.sleep(seconds)
        self.display.do("keyup", key)

    def type(self, digits):
        for digit in digits:
            self.display.tap(digit)

    def test_is_full_screen_and_nobody_gets_out_but_by_the_pin(self):
        program = self.start()
        self.wait_for_pictures(program)
        told = self.display.do("search", "--name", TITLE, "getwindowgeometry")
        self.assertIn("{}x{}".format(*SCREEN_PX), told)
        plays = child_of(program)
        for key in ("Escape", "F10", "F1", "F2", "F11", "alt+F4", "ctrl+q", "ctrl+c", "Escape", "Tab", "Return"):
            self.display.do("key", key)
            time.sleep(0.2)
        self.display.ask_to_close()
        time.sleep(1)
        self.type("1234")
        time.sleep(1)
        self.assertIsNone(program.poll(), self.said())
        self.assertEqual(child_of(program), plays)
        self.type(PIN)
        for key in ("Down", "Down", "Return"):  # the operator's page: back, start anew, end
            self.display.tap(key)
        self.assertEqual(program.wait(PATIENCE_S), 0)

    def test_shows_its_title_page_before_the_town_and_nothing_black_after(self):
        if not has_tools("ffmpeg"):
            self.skipTest("no ffmpeg: install the Debian package ffmpeg")
        size = "{}x{}".format(*SCREEN_PX)
        command = ["ffmpeg", "-loglevel", "error", "-f", "x11grab", "-framerate", "10", "-video_size", size, "-i", self.display.name,
                   "-vf", "scale=32:24", "-pix_fmt", "gray", "-f", "rawvideo", "-"]
        film = subprocess.Popen(command, stdout=subprocess.PIPE)
        program = self.start()
        self.wait_for_pictures(program)
        film.send_signal(signal.SIGINT)
        grey = film.communicate(timeout=PATIENCE_S)[0]
        brightest = [max(grey[k:k + 32 * 24]) for k in range(0, len(grey) - 32 * 24 + 1, 32 * 24)]
        first = next(k for k, value in enumerate(brightest) if value > 60)
        self.assertGreater(min(brightest[first:]), 60, brightest)
        told = re.findall(r"(title page|first picture) after ([0-9.]+) s", self.said())
        self.assertEqual([what for what, _ in told], ["title page", "first picture"])
        print(told, flush=True)

    def test_keeps_a_line_a_visit(self):
        program = self.start(settings="idle_s = 10\nlanguages = [\"fr\", \"de\"]\n")
        self.wait_for_pictures(program)
        log = self.folder / "visits/visits.csv"
        time.sleep(2)
        self.assertFalse(log.exists(), "nobody has been there")
        self.display.tap("k")
        self.wait_until(log.exists)
        with open(log, newline="") as file:
            visit, = csv.DictReader(file)
        self.assertEqual(visit["language"], "fr")
        self.assertLess(int(visit["length_s"]), 10)
        self.assertRegex(visit["began"], r"^\d{4}-\d\d-\d\d \d\d:\d\d$")

    def test_takes_a_new_tour_over_while_nobody_is_there_and_leaves_what_is_none(self):
        tour = self.folder / "tour.glb"
        shutil.copy(PACK, tour)
        program = self.start(settings=f"tour = \"{tour}\"\n", pack=False)
        self.wait_for_pictures(program)
        plays = child_of(program)
        broken = self.folder / "broken.glb"
        broken.write_bytes(PACK.read_bytes()[:1000])
        broken.rename(tour)
        self.wait_until(lambda: "the tour that is there goes on" in self.said())
        self.assertEqual(child_of(program), plays)
        fresh = self.folder / "fresh.glb"
        shutil.copy(PACK, fresh)
        fresh.rename(tour)
        self.wait_for_another(program, plays)

    def test_the_operator_starts_it_anew_by_holding_the_key_for_ending(self):
        program = self.start()
        self.wait_for_pictures(program)
        plays = child_of(program)
        self.hold("F10", 3 + 2 * self.display.beat_s())
        self.type(PIN)
        for key in ("Down", "Return"):
            self.display.tap(key)
        self.wait_for_another(program, plays)

    def test_comes_back_when_it_is_killed_and_when_it_is_stopped(self):
        program = self.start()
        self.wait_for_pictures(program)
        for how, said in ((signal.SIGKILL, "the player crashed (Killed)"), (signal.SIGSEGV, "the player crashed"),
                          (signal.SIGSTOP, "the player hangs")):
            with self.subTest(how):
                plays = child_of(program)
                os.kill(plays, how)
                took_s = self.wait_for_another(program, plays)
                print(f"{how.name}: there again after {took_s:.1f} s", flush=True)
                self.assertIn(said, self.said())
                time.sleep(1)

    def test_comes_back_when_the_process_that_watches_it_is_killed(self):
        program = self.start()
        self.wait_for_pictures(program)
        plays = child_of(program)
        program.kill()
        program.wait()
        self.wait_until(lambda: "the process that watches the player was lost" in self.said())
        found = self.wait_until(lambda: subprocess.run(["pgrep", "-P", str(plays)], capture_output=True, check=False).returncode == 0)
        self.assertIsNotNone(found)
        os.kill(plays, signal.SIGTERM)
        self.wait_until(lambda: not pathlib.Path(f"/proc/{plays}").exists())

    def test_ends_when_it_is_asked_to_by_a_signal_even_while_it_hangs(self):
        for stopped in (False, True):
            program = self.start()
            self.wait_for_pictures(program)
            plays = child_of(program)
            if stopped:
                os.kill(plays, signal.SIGSTOP)
            program.terminate()
            self.assertEqual(program.wait(PATIENCE_S), 0)
            self.assertFalse(pathlib.Path(f"/proc/{plays}").exists())

    def test_tells_the_service_manager(self):
        path = self.folder / "notify"
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            manager.bind(str(path))
            manager.settimeout(PATIENCE_S)
            program = self.start(environment={"NOTIFY_SOCKET": str(path)})
            heard = []
            while not any(message.startswith("READY=1") for message in heard):
                heard.append(manager.recv(1000).decode())
            for _ in range(3):
                self.assertIn("WATCHDOG=1", [manager.recv(1000).decode() for _ in range(3)])
            program.terminate()
            while heard[-1] != "STOPPING=1":
                heard.append(manager.recv(1000).decode())
            self.assertEqual(program.wait(PATIENCE_S), 0)

    def test_tells_the_service_manager_while_a_player_that_hangs_is_started_anew(self):
        path = self.folder / "notify"
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            manager.bind(str(path))
            manager.settimeout(10)  # WatchdogSec
            program = self.start(environment={"NOTIFY_SOCKET": str(path)})
            heard = [manager.recv(1000).decode()]
            while not heard[-1].startswith("READY=1"):
                heard.append(manager.recv(1000).decode())
            os.kill(child_of(program), signal.SIGSTOP)
            del heard[:]
            while not any(message.startswith("READY=1") for message in heard):
                heard.append(manager.recv(1000).decode())
            self.assertIn("STATUS=Starting anew", heard)
            self.assertIn("WATCHDOG=1", heard)
            self.assertIn("the player hangs", self.said())

    def codes(self):
        """What QR codes on the screen say."""
        size, picture = "{}x{}".format(*SCREEN_PX), self.folder / "screen.png"
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-f", "x11grab", "-video_size", size, "-i", self.display.name, "-frames:v", "1",
                        picture], check=True, timeout=PATIENCE_S)
        return subprocess.run(["zbarimg", "--quiet", "--raw", picture], capture_output=True, text=True, timeout=PATIENCE_S, check=False).stdout.split()

    def test_visitors_take_a_photo_with_a_code_and_are_led_by_the_map(self):
        if not has_tools("ffmpeg", "zbarimg"):
            self.skipTest("no ffmpeg or zbarimg: install the Debian packages ffmpeg and zbar-tools")
        photos, metrics = self.folder / "photos", self.folder / "metrics.csv"
        program = self.start("--photos", photos, "--set", "photo_link=https://museum.example/{file}", "--metrics", metrics,
                             settings="languages = [\"en\"]\n")
        self.wait_for_pictures(program)
        self.display.tap("k")       # somebody is there
        self.display.tap("Return")  # begins
        self.display.tap("Tab")     # on their own
        self.display.tap("p")
        self.wait_until(lambda: photos.exists() and len(list(photos.glob("*.jpg"))) == 1)
        photo, = photos.glob("*.jpg")
        self.wait_until(lambda: self.codes() == [f"https://museum.example/{photo.name}"])
        self.display.tap("Return")
        self.wait_until(lambda: self.codes() == [])
        self.display.tap("t")       # the map
        self.display.tap("Return")  # the first of the stops beside it
        time.sleep(8)
        self.hold("F10", 3 + 2 * self.display.beat_s())
        self.type(PIN)
        for key in ("Down", "Down", "Return"):
            self.display.tap(key)
        self.assertEqual(program.wait(PATIENCE_S), 0, self.said())
        with open(metrics, newline="") as file:
            rows = list(csv.DictReader(file))
        moved_m = math.hypot(*(float(rows[-1][c]) - float(rows[0][c]) for c in ("camera_x_m", "camera_y_m")))
        self.assertGreater(moved_m, 2)  # was led

    def test_the_tour_comes_from_the_settings_and_without_any_it_says_so(self):
        program = self.start(settings=f"tour = \"{PACK}\"\n", pack=False)
        self.wait_for_pictures(program)
        program.terminate()
        program.wait(PATIENCE_S)
        program = self.start(pack=False)
        self.assertEqual(program.wait(PATIENCE_S), 2)
        self.assertIn("tour = ", self.said())

    def test_what_it_cannot_begin_with_is_named_once(self):
        for settings, pack, word in (("idle_s = 1\n", True, "kiosk.toml:4: idle_s"), ("tour = \"none.glb\"\n", False, "none.glb")):
            program = self.start(settings=settings, pack=pack)
            self.assertEqual(program.wait(PATIENCE_S), 2)
            self.assertEqual(len(self.said().splitlines()), 1, self.said())
            self.assertIn(word, self.said())


if __name__ == "__main__":
    unittest.main()
