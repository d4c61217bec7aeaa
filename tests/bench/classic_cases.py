#!/usr/bin/env python3
"""Plays the classic cases of crowds (tests/scenario/classic), times them and writes a page to watch them on.

    python3 tests/bench/classic_cases.py -o cases                      # all: a table of figures, and cases/index.html
    python3 tests/bench/classic_cases.py bottleneck -o cases --open    # one, in the browser

Times are of whole steps, without a picture. Exit status: 0 done, 2 bad usage or input.
"""
import argparse
import csv
import itertools
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import tomllib
import webbrowser

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FOLDER = SOURCE / "tests/scenario/classic"
PAGE = pathlib.Path(__file__).with_name("classic_cases.html")
SHOWN_HZ = 10  # places a second on the page, which goes evenly from one to the next
LONGEST_S = 600  # real time a run may take


class Failed(Exception):
    """One line for the user."""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__.splitlines()[-1])
    parser.add_argument("case", nargs="*", metavar="CASE", help="name or file (default: all)")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="OUT", help="folder for the page")
    parser.add_argument("--player", type=pathlib.Path, default=SOURCE / "build/release/bin/flaneur-player",
                        help="flaneur-player")
    parser.add_argument("--runs", type=positive, default=5, metavar="N",
                        help="times are the least of so many runs (default: 5)")
    parser.add_argument("--open", action="store_true", help="open the page in the browser")
    return parser.parse_args()


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, not {text}")
    return number


def chosen(names):
    known = sorted(FOLDER.glob("*.toml"))
    if not names:
        return known
    paths = []
    for name in names:
        path = pathlib.Path(name) if name.endswith(".toml") else FOLDER / f"{name}.toml"
        if not path.exists():
            raise Failed(f"there is no case '{name}'; there are: {', '.join(p.stem for p in known)}")
        paths.append(path)
    return paths


def read_scenario(path):
    try:
        text = path.read_text(encoding="utf-8")
        scenario = tomllib.loads(text)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Failed(f"{path}: {error}") from error
    if "ground" not in scenario:
        raise Failed(f"{path}: has no [ground]; what is played in a tour is watched with flaneur-player")
    about = " ".join(line[1:].strip() for line in text.splitlines() if line.startswith("#"))
    return {"name": path.stem, "about": about, **scenario}


def rows_of(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def play(player, path):
    """Metrics by step, and the steps' people, {id: (x, y, radius)}."""
    with tempfile.TemporaryDirectory() as folder:
        metrics, trajectories = pathlib.Path(folder, "metrics.csv"), pathlib.Path(folder, "trajectories.csv")
        command = [player, "--headless", "--no-draw", "--scenario", path,
                   "--metrics", metrics, "--trajectories", trajectories]
        try:
            result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=LONGEST_S,
                                    check=False)
        except OSError as error:
            raise Failed(f"{player}: {error.strerror.lower()}; build it, or name it with --player") from error
        except subprocess.TimeoutExpired as error:
            raise Failed(f"{path}: the player did not end within {LONGEST_S} s") from error
        if result.returncode != 0:
            said = result.stderr.strip().splitlines() or [f"the player ended with status {result.returncode}"]
            raise Failed(said[-1])
        steps = rows_of(metrics)
        people = [{} for _ in steps]
        for row in rows_of(trajectories):
            person = (float(row["x_m"]), float(row["y_m"]), float(row["radius_m"]))
            people[int(row["frame"])][int(row["id"])] = person
    return steps, people


def closest_gap_m(people):
    """Between any two; below zero where they overlap."""
    pairs = (pair for step in people for pair in itertools.combinations(step.values(), 2))
    return min((math.dist(a[:2], b[:2]) - a[2] - b[2] for a, b in pairs), default=math.inf)


def times_ms(steps):
    """The first step, in which everybody looks for the way, and the mean of the others until the last arrives."""
    busy = [float(s["step_ms"]) for s in steps[2:] if int(s["people"]) > int(steps[-1]["people"])]
    return float(steps[1]["step_ms"]), statistics.fmean(busy or [float(s["step_ms"]) for s in steps[2:]])


def figures(runs):
    """Of one case: [(steps, people), ...]."""
    steps, people = runs[0]
    left = steps[-1]["people"]
    times = [times_ms(run[0]) for run in runs]
    arrived = next(s for s in steps if s["people"] == left)
    return {"people": len(people[0]), "left": int(left), "arrived_s": float(arrived["time_s"]),
            "gap_cm": round(100 * closest_gap_m(people), 1) + 0.0,
            "first_ms": min(t[0] for t in times), "mean_ms": min(t[1] for t in times)}


def shown(scenario, steps, people):
    """What the page draws of one case; places in centimetres."""
    step_s = float(steps[1]["time_s"])
    every = max(1, round(1 / SHOWN_HZ / step_s))
    headings = {}
    for k, person in enumerate(scenario.get("person", [])):
        if person.get("goals_m"):
            (x, y), (to_x, to_y) = person["position_m"], person["goals_m"][0]
            headings[k] = round(math.degrees(math.atan2(to_y - y, to_x - x)))
    frames = [[[i, round(100 * x), round(100 * y)] for i, (x, y, _) in step.items()] for step in people[::every]]
    return {"name": scenario["name"], "about": scenario["about"], "obstacles": scenario.get("obstacle", []),
            "ground": [scenario["ground"]["min_m"], scenario["ground"]["max_m"]],
            "headings": headings, "named": len(scenario.get("person", [])),
            "radii": {i: p[2] for step in people for i, p in step.items()}, "frames": frames, "frame_s": every * step_s}


def table(cases):
    lines = [f"{'case':18}{'people':>8}{'all there s':>13}{'closest cm':>12}{'ms/step':>10}{'first ms':>10}"]
    for name, f in cases:
        there = f"{f['arrived_s']:.1f}" if f["left"] < f["people"] else "-"
        numbers = f"{f['gap_cm']:12.1f}{f['mean_ms']:10.4f}{f['first_ms']:10.4f}"
        lines.append(f"{name:18}{f['people']:8d}{there:>13}{numbers}")
    return "\n".join(lines)


def main():
    options = arguments()
    cases, scenes = [], []
    for path in chosen(options.case):
        scenario = read_scenario(path)
        runs = [play(options.player, path) for _ in range(options.runs)]
        cases.append((path.stem, figures(runs)))
        scenes.append(shown(scenario, *runs[0]))
    page = options.output / "index.html"
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        data = json.dumps(scenes, separators=(",", ":")).replace("</", "<\\/")
        page.write_text(PAGE.read_text(encoding="utf-8").replace("[/*scenes*/]", data), encoding="utf-8")
    except OSError as error:
        raise Failed(f"{error.filename or options.output}: {(error.strerror or str(error)).lower()}") from error
    print(table(cases))
    print(f"page    {page}")
    if options.open:
        webbrowser.open(page.resolve().as_uri())
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failed as failed:
        print(f"classic_cases: error: {' '.join(str(failed).split())}", file=sys.stderr)
        sys.exit(2)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
