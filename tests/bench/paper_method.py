#!/usr/bin/env python3
"""Where the paper's own method gains: frames exceeded with off, paper and full, by how the visitor moves and how full the place is.

    python3 tests/bench/paper_method.py -o docs/paper_method.svg

A square of 40 m, people who walk about on it, a limit of 12 within 10 m, several seeds of the crowd. Fullness 1: as many people as would fill
the view up to the limit if they were spread evenly. Prints every number; needs gnuplot and numpy (Debian: gnuplot-nox, python3-numpy).
"""
import argparse
import concurrent.futures
import math
import os
import pathlib
import random
import statistics
import sys
import tempfile

SYSTEM_PYTHON = "/usr/bin/python3"
try:
    import numpy  # noqa: F401
except ImportError:  # Debian's numpy belongs to Debian's Python, which need not be the first on PATH
    if not os.path.exists(SYSTEM_PYTHON) or os.path.realpath(sys.executable) == os.path.realpath(SYSTEM_PYTHON):
        sys.exit("paper_method: error: numpy not found: install the Debian package python3-numpy")
    os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])

from figures import measures, plots, runs  # noqa: E402
from figures.targets import MODES  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HALF_M, R_HIGH_M, FOV_DEG, LIMIT, TOP_MPS, SECONDS = 20, 10, 60, 12, 1.9, 40
FULLNESS = (0.5, 0.75, 1.0)
# What the visitor does, and how fast they are of the people's top speed.
VISITORS = {"stands": 0, "turns at 18°/s": 0, "half as fast": 0.5, "as fast": 1, "twice as fast": 2}


def legs(visitor, seed):
    dice = random.Random(seed)
    if visitor == "stands":
        return f"[[camera.leg]]\nwait_s = {SECONDS}\n"
    if visitor.startswith("turns"):
        return f"[[camera.leg]]\nturn_by_deg = {18 * SECONDS}\nrate_dps = 18\n"
    speed_mps, text, left_s, place = TOP_MPS * VISITORS[visitor], "", SECONDS, (0, 0)
    while left_s > 0:
        to = (round(dice.uniform(-14, 14), 1), round(dice.uniform(-14, 14), 1))
        text += f"[[camera.leg]]\nwalk_to_m = [{to[0]}, {to[1]}]\nspeed_mps = {speed_mps}\n"
        left_s -= math.dist(place, to) / speed_mps
        place = to
    return text


def scenario(visitor, fullness, seed):
    in_view_m2 = math.pi * R_HIGH_M**2 * FOV_DEG / 360
    people = round(fullness * LIMIT / in_view_m2 * (2 * HALF_M)**2)
    return (f"people = {people}\nseconds = {SECONDS}\n[limit]\nhigh = {LIMIT}\n[ground]\nmin_m = [{-HALF_M}, {-HALF_M}]\n"
            f"max_m = [{HALF_M}, {HALF_M}]\n[camera]\nposition_m = [0, 0]\nfov_deg = {FOV_DEG}\nr_high_m = {R_HIGH_M}\n{legs(visitor, seed)}")


def exceeded(job):
    """Share of frames of one run."""
    player, visitor, fullness, mode, seed = job
    with tempfile.TemporaryDirectory(prefix="paper_method_") as folder:
        folder = pathlib.Path(folder)
        path = folder / "scenario.toml"
        path.write_text(scenario(visitor, fullness, seed), encoding="utf-8")
        metrics, people = runs.play(player, None, path, seed, mode, None, folder)
    return measures.share_exceeded(measures.candidates(metrics, people, R_HIGH_M), metrics["limit"])


def plot(shares, width=1040, height=300):
    """One panel a fullness: frames exceeded by what the visitor does, a line a mode."""
    script = (f'set terminal svg size {width},{height} {plots.FONT} background rgb "#ffffff"\nset output "plot.svg"\n{plots.STYLE}'
              f"set encoding utf8\nset multiplot layout 1,{len(FULLNESS)} margins 0.07,0.99,0.3,0.86 spacing 0.04,0\n"
              f"set yrange [0:100]\nset xrange [-0.5:{len(VISITORS) - 0.5}]\nset xtics rotate by 30 right ("
              + ", ".join(f'"{name}" {k}' for k, name in enumerate(VISITORS)) + ")\n")
    data = {}
    for k, fullness in enumerate(FULLNESS):
        script += f'set title "fullness {fullness:g}"\nset ylabel "{"frames exceeded, %" if k == 0 else ""}"\n'
        lines = []
        for mode in MODES:
            data[f"{mode}{k}"] = [(x, 100 * shares[name, fullness, mode]) for x, name in enumerate(VISITORS)]
            lines.append(f'"{mode}{k}" u 1:2 w lp pt 7 ps 0.6 lw 1.5 lc rgb "{plots.COLOURS[mode]}"')
            y = 0.94 - 0.08 * MODES.index(mode)
            named = k == 0  # there is room above the lines where few frames are exceeded
            script += (f'set label {MODES.index(mode) + 1} "{mode}" at graph 0.9,{y:.2f} textcolor rgb "{plots.COLOURS[mode]}"\n'
                       if named else f"unset label {MODES.index(mode) + 1}\n")
        script += "plot " + ", ".join(lines) + "\n"
    return plots.gnuplot(script + "unset multiplot\n", data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="SVG")
    parser.add_argument("--player", type=pathlib.Path, default=SOURCE / "build/release/bin/flaneur-player", help="flaneur-player")
    parser.add_argument("--seeds", type=int, default=4, metavar="N", help="of the crowd (default: 4)")
    options = parser.parse_args()
    cases = [(name, fullness, mode) for fullness in FULLNESS for name in VISITORS for mode in MODES]
    jobs = [(options.player, *case, seed) for case in cases for seed in range(1, options.seeds + 1)]
    with concurrent.futures.ProcessPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        found = list(pool.map(exceeded, jobs))
    shares = {case: statistics.fmean(found[k * options.seeds:(k + 1) * options.seeds]) for k, case in enumerate(cases)}
    print(f"frames exceeded, mean of {options.seeds} seeds")
    for fullness in FULLNESS:
        for name in VISITORS:
            print(f"  fullness {fullness:<5g} visitor {name:15} " + "  ".join(f"{mode} {shares[name, fullness, mode]:6.1%}" for mode in MODES))
    options.output.write_text(plot(shares), encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except runs.Failed as failed:
        sys.exit(f"paper_method: error: {failed}")
