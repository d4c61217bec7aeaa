"""Plays paths drawn from a seed with two seeds of the crowd, and judges adaptation on them: whether it shows, and what it does."""
import pathlib
import statistics
import tempfile

import numpy as np

from figures import drawn_paths, measures, told_apart
from figures.recording import judge
from figures.runs import Failed, play, read_scenario
from figures.targets import DRAWN, MODES

CROWD_SEEDS = (101, 202)
RINGS_M = 20
LIGHT_SHARE = 0.5   # where off exceeds in at most so many frames, full can be asked to keep the limit


def write_paths(options, tour):
    """The files of the drawn paths."""
    try:
        paths = drawn_paths.drawn(tour, options.paths, options.path_seed)
    except ValueError as error:
        raise Failed(f"{options.pack}: {error}") from error
    folder = options.output / "paths"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.toml"):
        old.unlink()
    files = []
    for name, text in paths:
        files.append(folder / f"{name}.toml")
        files[-1].write_text(text, encoding="utf-8")
    return files


def planned_jobs(options, pack_facts, tour):
    """One dict a run, as scenarios.planned_jobs makes them."""
    return [{"group": DRAWN, "case": f"{path.stem}, seed {seed}", "path": path.stem, "mode": mode, "seed": seed, "scenario": path,
             "pack": options.pack, "pack_facts": pack_facts, "player": options.player, "seconds": options.seconds,
             "folder": options.output} for path in write_paths(options, tour) for seed in CROWD_SEEDS for mode in MODES
            if mode != "paper" or not options.without_paper]


def run_and_measure(job):
    """A dict: the job's own keys, `figures` of the run by itself, and what comparing and plotting need."""
    facts = read_scenario(job["scenario"], job["pack_facts"])
    with tempfile.TemporaryDirectory(dir=job["folder"], prefix=".run-") as folder:
        metrics, people = play(job["player"], job["pack"], job["scenario"], job["seed"], job["mode"], job["seconds"],
                               pathlib.Path(folder), job.get("discretion"))
    counts = measures.candidates(metrics, people, facts["r_high_m"])
    return {
        **{key: job[key] for key in ("group", "case", "mode", "path", "seed")}, "discretion": job.get("discretion"),
        "figures": {
            "over_budget": len(judge.frames_over_budget(rows_of(metrics))),
            "exceeded": measures.share_exceeded(counts, metrics["limit"]),
            "over": measures.people_over(counts, metrics["limit"]),
            "over_at_start": float(max(0, counts[0] - metrics["limit"][0])),
            "wrong_view": measures.wrong_views(metrics, people),
            "too_near": measures.too_near(metrics, people),
            "switches": measures.level_switches(people, facts["step_s"]),
            "shortfalls": float(metrics["shortfalls"].mean()),
        },
        "stands": path_kind(job["path"]) in drawn_paths.STANDING_KINDS,
        "rings": measures.ring_densities(metrics, people, RINGS_M),
        "pieces": told_apart.features(metrics, people, facts["step_s"]) if told_apart.MISSING is None else None,
        "time_s": metrics["time_s"], "candidates": counts, "limits": metrics["limit"], "limit": float(metrics["limit"][0]),
    }


def rows_of(metrics):
    names = ("frame", "triangles_people", "triangles_people_shadows", "budget_triangles")
    return [dict(zip(names, row)) for row in zip(*(metrics[name] for name in names))]


def path_kind(path):
    return path.split("-", 1)[1].rsplit("-", 1)[0]


def compare(runs):
    """Adds the figures that need off; returns what told the modes apart: {mode: [(feature, loss)]}."""
    base = {(run["path"], run["seed"]): run for run in runs if run["mode"] == "off"}
    for run in runs:
        off, figures = base[run["path"], run["seed"]], run["figures"]
        figures["filled"] = measures.filled(run["candidates"], run["limits"], off["candidates"])
        share = statistics.fmean(base[run["path"], seed]["figures"]["exceeded"] for seed in CROWD_SEEDS)
        if share <= LIGHT_SHARE:
            figures["exceeded_light"] = figures["exceeded"]
        elif run is not off:
            figures["over_of_off"] = figures["over"] / off["figures"]["over"] if off["figures"]["over"] > 0 else None
    compare_rings(runs)
    return compare_pieces(runs) if told_apart.MISSING is None else {}


def compare_rings(runs):
    """Of both seeds together: a ring holds few people."""
    rings = {(path, mode): np.mean([run["rings"] for run in runs if (run["path"], run["mode"]) == (path, mode)], axis=0)
             for path, mode in {(run["path"], run["mode"]) for run in runs}}
    for run in runs:
        if run["stands"] and run["mode"] != "off":
            run["figures"]["ring"] = measures.densest_ring(rings[run["path"], run["mode"]], rings[run["path"], "off"])


def compare_pieces(runs):
    """A mode with one seed against off with the other, both ways round; off against off is what chance alone makes."""
    def pieces(mode, seed):
        return {run["path"]: run["pieces"] for run in runs if (run["mode"], run["seed"]) == (mode, seed)}

    first, second = CROWD_SEEDS
    tells = {}
    for mode in [mode for mode in MODES if any(run["mode"] == mode for run in runs)]:
        ways = [(first, second)] if mode == "off" else [(first, second), (second, first)]
        found = [told_apart.told_apart(pieces(mode, a), pieces("off", b)) for a, b in ways]
        for run in runs:
            if run["mode"] == mode and run["path"] in found[0]:
                run["figures"]["told_apart"] = statistics.fmean(scores[run["path"]] for scores in found)
        if mode != "off":
            tells[mode] = told_apart.what_tells(pieces(mode, first), pieces("off", second))[:8]
    return tells


def by_path(runs):
    """{path: {mode: {figure: mean over the seeds}}}, for the page's table."""
    table = {}
    for run in runs:
        table.setdefault(run["path"], {}).setdefault(run["mode"], []).append(run["figures"])
    return {path: {mode: {key: statistics.fmean(f[key] for f in some) for key in some[0]
                          if all(f.get(key) is not None for f in some)} for mode, some in modes.items()}
            for path, modes in table.items()}


def mean_told_apart(runs):
    """{mode: (mean AUC over the paths, its standard error)}."""
    found = {}
    for mode in MODES:
        scores = list({run["path"]: run["figures"]["told_apart"] for run in runs
                       if run["mode"] == mode and "told_apart" in run["figures"]}.values())
        if len(scores) > 1:
            found[mode] = (statistics.fmean(scores), statistics.stdev(scores) / len(scores)**0.5)
    return found
