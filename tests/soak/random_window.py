"""Somebody at the player's window who presses, drags, clicks, resizes, hides and closes in any order, by real keys and a real mouse (xdotool on Xvfb).

    python3 tests/soak/random_window.py PACK [--seconds 300] [--seed N] [--kiosk] [--bin FOLDER]

What the player may never do: crash, hang, warn, or, as a kiosk, end or leave its screen. Outside a kiosk visitors may close it, and come again. Prints the
seed, so that the same visitor comes again; exit status 1 with what was wrong and what had been done before.
"""
import argparse
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/cli"))
from window_test import SCREEN_PX, Display  # noqa: E402

KEYS = ("w a s d e f g h m n o p q r t x 1 2 3 0 Up Down Left Right Prior Next Home End Escape Return space Tab BackSpace Delete plus minus comma period "
        "Shift_L Control_L Alt_L F1 F2 F3 F5 F11 F12 Print Menu KP_Add KP_Subtract adiaeresis").split()
HANGS_S = 60  # beside whatever else this machine does
KIOSK = 'pin = "4711"\nidle_s = 20\n'


class Visitor:
    def __init__(self, display, seed, is_kiosk):
        self.display, self.random, self.is_kiosk, self.done = display, random.Random(seed), is_kiosk, []

    def window(self):
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "."], env=self.display.environment(), capture_output=True, text=True)
        return found.stdout.split()[:1]

    def somewhere(self):
        return [self.random.randrange(size) for size in SCREEN_PX]

    def key(self):
        key, long_s = self.random.choice(KEYS), self.random.choice((0, 0.05, 0.05, 1.0))
        self.display.do("keydown", key)
        time.sleep(long_s)
        self.display.do("keyup", key)
        return key

    def keys(self):
        some = self.random.sample(KEYS, self.random.randint(2, 4))
        self.display.do("keydown", *some)
        time.sleep(self.random.random())
        self.display.do("keyup", *self.random.sample(some, len(some)))
        return " ".join(some)

    def click(self):
        at, button = self.somewhere(), self.random.choice((1, 1, 1, 1, 2, 3, 4, 5, 8))
        self.display.do("mousemove", *at, "click", "--repeat", self.random.choice((1, 1, 2, 5)), button)
        return f"{button} at {at}"

    def drag(self):
        self.display.do("mousemove", *self.somewhere(), "mousedown", 1)
        for _ in range(self.random.randint(1, 4)):
            self.display.do("mousemove", *self.somewhere())
            time.sleep(self.random.random() / 5)
        self.display.do("mouseup", 1)

    def pages(self):
        """Through the menu, row by row."""
        self.display.do("key", "Escape")
        for _ in range(self.random.randint(1, 8)):
            self.display.do("key", self.random.choice(("Down", "Down", "Up", "Left", "Right", "Return", "Tab")))
            time.sleep(0.1)

    def size(self):
        size = [self.random.choice((64, 120, 200, 320, 480, 640)) for _ in range(2)]
        for window in self.window():
            self.display.do("windowsize", window, *size)
        return f"{size}"

    def hide(self):
        for window in self.window():
            self.display.do("windowunmap", window)
            time.sleep(self.random.choice((0.1, 2)))
            self.display.do("windowmap", window)
            self.display.do("windowfocus", window)

    def wait(self):
        time.sleep(self.random.random() * (25 if self.is_kiosk and self.random.random() < 0.2 else 3))

    def act(self):
        kinds = [self.key] * 6 + [self.keys] * 2 + [self.click] * 4 + [self.drag] * 2 + [self.pages] * 3 + [self.wait]
        kinds += [] if self.is_kiosk else [self.size, self.hide]
        what = self.random.choice(kinds)
        self.done.append(what.__name__)
        self.done[-1] = f"{what.__name__} {what() or ''}".strip()


def start(display, arguments, folder):
    more = []
    if arguments.kiosk:
        (folder / "kiosk.toml").write_text(KIOSK)
        more = ["--kiosk", "--kiosk-settings", folder / "kiosk.toml"]
    environment = dict(display.environment(), XDG_STATE_HOME=str(folder), XDG_PICTURES_DIR=str(folder), HOME=str(folder))
    command = [arguments.bin / "flaneur-player", arguments.pack, "--size", "320x180", "--people", "60", "--verbose", *more]
    log = open(folder / "log.txt", "a+")
    return subprocess.Popen([str(word) for word in command], env=environment, stdout=log, stderr=log, start_new_session=True), log


def said(log):
    """But for what it says of the tour itself, whenever it starts."""
    log.flush()
    log.seek(0)
    of_tour = re.compile(r"warning: (stop|place) ")
    return [line for line in log.read().splitlines() if ("warning" in line or "error" in line) and not of_tour.search(line)]


def works_s(program):
    """Processor seconds so far, of the player and, in a kiosk, of what watches it: who hangs takes none."""
    ticks = 0
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue  # it has just ended
        if int(fields[3]) == program.pid:  # its session
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def fault(display, program, arguments, log):
    """What is wrong, or None."""
    code = program.poll()
    if code is not None:
        return f"ended with status {code}: {said(log)}" if code != 0 or arguments.kiosk else None
    if said(log):
        return f"says {said(log)}"
    before, end = works_s(program), time.monotonic() + HANGS_S
    while time.monotonic() < end and program.poll() is None:
        answers = subprocess.run(["xdotool", "search", "--name", "."], env=display.environment(), capture_output=True, timeout=30).returncode == 0
        if answers and works_s(program) > before + 0.05:
            return None
        time.sleep(0.2)
    return None if program.poll() == 0 and not arguments.kiosk else f"hangs or has gone: status {program.poll()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pack", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--seed", type=int, default=int(time.time()) % 100000)
    parser.add_argument("--kiosk", action="store_true")
    parser.add_argument("--bin", type=pathlib.Path, default=SOURCE / "build/release/bin")
    arguments = parser.parse_args()
    print("seed", arguments.seed, flush=True)
    wrong, starts = None, 1
    with Display() as display, tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        visitor = Visitor(display, arguments.seed, arguments.kiosk)
        program, log = start(display, arguments, folder)
        display.wait_for("frames/s", program)
        end = time.monotonic() + arguments.seconds
        while time.monotonic() < end and wrong is None:
            visitor.act()
            if len(visitor.done) % 5 == 0:
                wrong = fault(display, program, arguments, log)
            if wrong is None and program.poll() is not None:
                wrong = fault(display, program, arguments, log)
                program, log = start(display, arguments, folder)
                starts += 1
                display.wait_for("frames/s", program)
        if program.poll() is None:
            os.killpg(program.pid, signal.SIGTERM)
            try:
                program.wait(30)
            except subprocess.TimeoutExpired:
                wrong = wrong or "does not end when it is asked to"
                os.killpg(program.pid, signal.SIGKILL)
    print(f"{len(visitor.done)} acts, {starts} starts,", "no fault" if wrong is None else f"{wrong}\nafter " + " | ".join(visitor.done[-25:]))
    sys.exit(wrong is not None)


if __name__ == "__main__":
    main()
