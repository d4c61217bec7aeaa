#!/usr/bin/env python3
"""Plays every scenario with adaptation off, paper and full, judges the runs and writes a page of figures.

    python3 tests/bench/scenarios.py build_assets/wolfenbuettel/wolfenbuettel.glb -o figures

    python3 tests/bench/scenarios.py PACK.glb -o figures --only-paths --paths 20 --path-seed 7   # paths nobody has tuned for, any pack

OUT/index.html is the page, OUT/figures.json holds every number. Needs gnuplot and numpy (Debian: gnuplot-nox, python3-numpy); whether crowds can be
told apart also needs scikit-learn (python3-sklearn), and is left out without it.
Exit status: 0 every target reached, 1 a target missed, 2 bad usage or input.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import re
import sys
import time

SYSTEM_PYTHON = "/usr/bin/python3"
try:
    import numpy  # noqa: F401
except ImportError:  # Debian's numpy belongs to Debian's Python, which need not be the first on PATH
    if not os.path.exists(SYSTEM_PYTHON) or os.path.realpath(sys.executable) == os.path.realpath(SYSTEM_PYTHON):
        sys.exit("scenarios: error: numpy not found: install the Debian package python3-numpy")
    os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])

from figures import drawn_runs, page, plots, runs, summary, told_apart, trade  # noqa: E402
from figures.targets import DRAWN, MODES  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FOLDER = SOURCE / "tests/scenario"
PAPER_FIGURES = {
    "walkabout-fast": ("The paper's Figure 10", "Walkabout at twice the people's top speed: people within the nominal r_high, and the "
                       "limit. First seed."),
    "walkabout-equal": ("The paper's Figure 11", "Walkabout at the people's top speed. First seed."),
    "dead-end": ("The paper's Figure 13", "Into a dead-end alley with people in it. First seed."),
}
MAP_FIGURE = ("turn-dense", "The paper's Figure 12",
              "Turning on the spot in a very dense square: density of people around the visitor, who looks up, mean over the run, first "
              "seed. Lines: the view and the nominal r_high.")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__.splitlines()[-1])
    parser.add_argument("pack", type=pathlib.Path, metavar="PACK", help="the baked demo tour (.glb)")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, metavar="OUT", help="folder for page and figures")
    parser.add_argument("--player", type=pathlib.Path, default=SOURCE / "build/release/bin/flaneur-player", help="flaneur-player")
    parser.add_argument("--seeds", type=positive, default=5, metavar="N", help="seeds 1 to N of each scenario (default: 5); numbered "
                        "scenarios (NAME-01, NAME-02, ...) count as the seeds of one")
    parser.add_argument("--scenario", action="append", metavar="NAME", help="only this one; may be given several times")
    parser.add_argument("--paths", type=natural, default=20, metavar="N", help="so many paths drawn from a seed as well, each with two seeds "
                        "of the crowd (default: 20; 0: none)")
    parser.add_argument("--path-seed", type=int, default=1, metavar="S", help="the seed that they are drawn from (default: 1)")
    parser.add_argument("--without-paper", action="store_true", help="leave out the paper's own adaptation on drawn paths: a third faster")
    parser.add_argument("--trade", action="store_true", help="play the drawn paths with less discretion as well, and draw how much shows for "
                        "how much detail: three times as long")
    parser.add_argument("--only-paths", action="store_true", help="leave out the scenarios")
    parser.add_argument("--jobs", type=positive, default=len(os.sched_getaffinity(0)), metavar="N", help="runs at once (default: cores)")
    parser.add_argument("--seconds", type=float, help="end each run after so much simulated time")
    parser.add_argument("--report-only", action="store_true", help="exit status 0 even where a target is missed")
    return parser.parse_args()


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, not {text}")
    return number


def natural(text):
    number = int(text)
    if number < 0:
        raise argparse.ArgumentTypeError(f"must not be below 0: {text}")
    return number


def scenario_groups(wanted):
    """{name: files}: numbered scenarios are one group."""
    groups = {}
    for path in sorted(FOLDER.glob("*.toml")):
        groups.setdefault(re.sub(r"-\d+$", "", path.stem), []).append(path)
    for name in wanted or []:
        if name not in groups:
            raise runs.Failed(f"there is no scenario '{name}'; there are: {', '.join(groups)}")
    return {name: files for name, files in groups.items() if not wanted or name in wanted}


def planned_jobs(options, pack_facts):
    """One dict a run, the longest scenarios first so that the cores end together."""
    jobs = []
    for group, files in scenario_groups(options.scenario).items():
        cases = [(path, None, path.stem) for path in files] if len(files) > 1 else \
            [(files[0], seed, f"seed {seed}") for seed in range(1, options.seeds + 1)]
        for path, seed, case in cases:
            jobs += [{"group": group, "case": case, "mode": mode, "seed": seed, "scenario": path, "pack": options.pack,
                      "pack_facts": pack_facts, "player": options.player, "seconds": options.seconds,
                      "folder": options.output} for mode in MODES]
    return jobs


def drawn_jobs(options, pack_facts):
    """Of the paths that are drawn from a seed, unless only one scenario is asked for."""
    if options.paths == 0 or options.scenario:
        return []
    if told_apart.MISSING:
        print(f"scenarios: warning: nothing is told apart: {told_apart.MISSING}", file=sys.stderr)
    return drawn_runs.planned_jobs(options, pack_facts, runs.read_tour(options.pack))


def paths_facts(options, drawn):
    """What the page says of the drawn paths; None without any."""
    if not drawn:
        return None
    tells = drawn_runs.compare(drawn)
    return {"seed": options.path_seed, "paths": drawn_runs.by_path(drawn), "told_apart": drawn_runs.mean_told_apart(drawn), "tells": tells,
            "missing": told_apart.MISSING}


def play_all(jobs, parallel):
    """The judged runs, in the order of the jobs."""
    done = {}
    with concurrent.futures.ProcessPoolExecutor(parallel) as pool:
        waiting = {pool.submit(drawn_runs.run_and_measure if "path" in job else runs.run_and_judge, job): (k, job)
                   for k, job in enumerate(jobs)}
        for future in concurrent.futures.as_completed(waiting):
            k, job = waiting[future]
            name = f"{job['group']}, {job['case']}, {job['mode']}"
            try:
                done[k] = future.result()
            except runs.Failed as error:
                pool.shutdown(cancel_futures=True)
                raise runs.Failed(f"{name}: {error}") from error
            print(f"[{len(done)}/{len(jobs)}] {name}", file=sys.stderr, flush=True)
    return [done[k] for k in range(len(jobs))]


def first_case(judged, group):
    """The runs by mode of the first case of a scenario."""
    chosen = [run for run in judged if run["group"] == group]
    return {run["mode"]: run for run in chosen if run["case"] == chosen[0]["case"]}


def drawn_figures(judged, names):
    figures = [(*PAPER_FIGURES[name], plots.candidates_plot(first_case(judged, name))) for name in PAPER_FIGURES if name in names]
    if MAP_FIGURE[0] in names:
        figures.insert(2, (*MAP_FIGURE[1:], plots.maps_plot(first_case(judged, MAP_FIGURE[0]))))
    return figures


def trade_figure(points):
    """None where nothing can be told apart."""
    if not any(p["told_apart"] for p in points):
        return []
    return [("How much shows for how much detail", "Frames exceeded on the drawn paths, and how well a classifier tells people near the "
             "visitor from free ones: off, the paper's way, and full from no discretion to all of it.", trade.plot(points))]


def write(path, text):
    """Whole or not at all."""
    beside = path.with_name(path.name + ".part")
    beside.write_text(text, encoding="utf-8")
    beside.replace(path)


def finite(value):
    """JSON knows no infinity."""
    if isinstance(value, dict):
        return {key: finite(v) for key, v in value.items()}
    if isinstance(value, list):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def main():
    options, start_s = arguments(), time.monotonic()
    pack_facts = runs.read_pack(options.pack)
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        jobs = [] if options.only_paths else planned_jobs(options, pack_facts)
        paths_jobs = drawn_jobs(options, pack_facts)
        played = play_all(jobs + paths_jobs + (trade.planned_jobs(paths_jobs) if options.trade else []), options.jobs)
        judged, others = [run for run in played if run["group"] != trade.GROUP], [run for run in played if run["group"] == trade.GROUP]
        for group in {run["group"] for run in judged} - {DRAWN}:
            runs.compare_with_off([run for run in judged if run["group"] == group])
        drawn = [run for run in judged if run["group"] == DRAWN]
        paths = paths_facts(options, drawn)
        traded = trade.points(drawn, others) if others else []
        table = summary.summarise(judged)
        results = summary.verdicts(table)
        facts = {"pack": str(options.pack), "runs": len(judged), "seeds": options.seeds,
                 "simulated_s": sum(float(run["time_s"][-1]) for run in judged), "seconds": time.monotonic() - start_s}
        small = {name: plots.candidates_plot(first_case(judged, name), height=110) for name in table}
        write(options.output / "figures.json",
              json.dumps(finite({**facts, "targets": results, "scenarios": table, "paths": paths, "trade": traded}), indent=1))
        write(options.output / "index.html", page.page(facts, table, results, drawn_figures(judged, table) + trade_figure(traded), small, paths))
    except OSError as error:
        raise runs.Failed(f"{error.filename or options.output}: {(error.strerror or str(error)).lower()}") from error
    print(summary.terminal_table(results))
    print(summary.paths_table(paths))
    for p in traded:
        print(f"trade: {p['name']}: exceeded {p['exceeded']:.2%}, told apart {p['told_apart'] or math.nan:.3f}")
    print(f"page    {options.output / 'index.html'}")
    return 0 if options.report_only or all(v["reached"] for v in results) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except runs.Failed as failed:
        print(f"scenarios: error: {' '.join(str(failed).split())}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
