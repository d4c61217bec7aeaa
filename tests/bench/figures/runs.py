"""Plays one scenario once and judges it."""
import pathlib
import subprocess
import tempfile
import tomllib

import numpy as np

from figures import measures, recording
from figures.recording import judge
from figures.targets import FREE_SECONDS
from support import split_glb

MOST_SAMPLES = 20000   # of speeds and turn rates kept of a run
MAP_HALF_M, MAP_CELL_M = 15.0, 0.75
LONGEST_S = 1800       # real time a run may take


class Failed(Exception):
    """One line for the user."""


def read_tour(path):
    """A pack's description of its tour, with the `kinds` of its ground's cells: bytes, row by row from the south."""
    try:
        document, binary = split_glb(path)
        tour = document["extensions"]["FLANEUR_tour"]
        view = document["bufferViews"][tour["ground"]["kind_view"]]
        begin = view.get("byteOffset", 0)
        tour["ground"]["kinds"] = binary[begin:begin + view["byteLength"]]
        return tour
    except OSError as error:
        raise Failed(f"{path}: {error.strerror.lower()}") from error
    except (ValueError, KeyError, IndexError, AttributeError) as error:
        raise Failed(f"{path}: not a tour pack; bake one with flaneur bake") from error
    except Exception as error:  # a truncated header
        raise Failed(f"{path}: not a tour pack ({error})") from error


def read_pack(path):
    """What judging needs of a pack."""
    tour = read_tour(path)
    return {"gates": [p["position_m"] for p in tour["places"] if p["kind"] in ("door", "exit")],
            "top_speed_mps": tour["crowd"]["top_speed_mps"], "step_hz": tour["control"]["step_hz"],
            "r_high_m": tour["control"]["r_high_m"]}


def read_scenario(path, pack):
    """What judging needs of a scenario played with that pack."""
    try:
        data = tomllib.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Failed(f"{path}: {error}") from error
    camera, persons = data.get("camera", {}), data.get("person", [])
    return {"step_s": 1 / data.get("step_hz", pack["step_hz"]), "r_high_m": camera.get("r_high_m", pack["r_high_m"]),
            "targets": [leg["walk_to_m"] for leg in camera.get("leg", []) if "walk_to_m" in leg],
            "last_goals": [p["goals_m"][-1] for p in persons if p.get("goals_m")],
            "top_speed_mps": max([pack["top_speed_mps"]] + [p.get("top_speed_mps", p.get("speed_mps", 0)) for p in persons]),
            "gates": pack["gates"], "has_camera": "camera" in data}


def play(player, pack, scenario, seed, mode, seconds, folder, discretion=None):
    """The recording of a run: metrics and people. pack: None where the scenario has its own ground."""
    metrics, trajectories = folder / "metrics.csv", folder / "trajectories.csv"
    command = [player, *([pack] if pack else []), "--headless", "--no-draw", "--scenario", scenario, "--adaptation", mode,
               "--metrics", metrics, "--trajectories", trajectories]
    command += ["--seed", seed] if seed is not None else []
    command += ["--seconds", seconds] if seconds is not None else []
    command += ["--discretion", discretion] if discretion is not None else []
    try:
        result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=LONGEST_S, check=False)
    except OSError as error:
        raise Failed(f"{player}: {error.strerror.lower()}; build it, or name it with --player") from error
    except subprocess.TimeoutExpired as error:
        raise Failed(f"the player did not end within {LONGEST_S} s") from error
    if result.returncode != 0:
        raise Failed((result.stderr.strip().splitlines() or [f"the player ended with status {result.returncode}"])[-1])
    return recording.read_metrics(metrics), recording.read_people(trajectories)


def figures_of(metrics, people, facts, free_s):
    """The figures of one run by itself."""
    frames = recording.judged_frames(people)
    counts = measures.candidates(metrics, people, facts["r_high_m"])
    sparse, everywhere = measures.overlapping_pairs(people, frames)
    born, vanished = measures.seen_coming_and_going(people, facts["gates"], facts["last_goals"])
    return {
        "over_budget": int(np.sum(metrics["triangles_people"] > metrics["budget_triangles"])),
        "exceeded": measures.share_exceeded(counts, metrics["limit"], round(free_s / facts["step_s"])),
        "jumps": len(judge.jumps(frames, facts["top_speed_mps"], facts["step_s"])),
        "overlaps": sparse, "overlaps_dense": everywhere, "born": born, "vanished": vanished,
        "unforeseen": len(judge.seen_out_of_nothing(frames)),
        "wrong_view": measures.wrong_views(metrics, people),
        "too_near": measures.too_near(metrics, people),
        "switches": measures.level_switches(people, facts["step_s"]),
        "shortfalls": float(metrics["shortfalls"].mean()),
        "speed_ratio": measures.speed_ratio(metrics),
        "direction_deg": measures.direction_error(metrics, facts["targets"]),
        "control_share": float(metrics["control_ms"].sum() / max(metrics["step_ms"].sum(), 1e-9)),
    }


def thinned(samples):
    return samples[::max(1, len(samples) // MOST_SAMPLES)].astype(np.float32)


def run_and_judge(job):
    """A dict: the job's own keys, `figures`, and what comparing and plotting need. Called in processes of its own."""
    facts = read_scenario(job["scenario"], job["pack_facts"])
    with tempfile.TemporaryDirectory(dir=job["folder"], prefix=".run-") as folder:
        metrics, people = play(job["player"], job["pack"], job["scenario"], job["seed"], job["mode"], job["seconds"],
                               pathlib.Path(folder))
    speeds, turns = measures.visible_motion(people, facts["step_s"])
    rim = measures.rim_densities(metrics, people, facts["r_high_m"])
    return {
        **{key: job[key] for key in ("group", "case", "mode")},
        "figures": figures_of(metrics, people, facts, FREE_SECONDS.get(job["group"], 0)),
        "speeds": thinned(speeds), "turns": thinned(turns), "rim": float(rim.max()), "rim_usual": float(np.quantile(rim, 0.99)),
        "time_s": metrics["time_s"], "candidates": measures.candidates(metrics, people, facts["r_high_m"]),
        "limit": float(metrics["limit"][0]), "r_high_m": facts["r_high_m"], "fov_rad": float(metrics["camera_fov_rad"][0]),
        "map": measures.density_map(metrics, people, MAP_HALF_M, MAP_CELL_M),
        "control_ms": float(metrics["control_ms"].mean()), "step_ms": float(metrics["step_ms"].mean()),
    }


def compare_with_off(runs):
    """Adds the figures that need the same case with off; `runs` are of one scenario."""
    off = {run["case"]: run for run in runs if run["mode"] == "off"}
    cases = list(off)
    following = dict(zip(cases, cases[1:] + cases[:1])) if len(cases) > 1 else {}
    for run in runs:
        figures, base = run["figures"], off.get(run["case"])
        other = base if run["mode"] != "off" else off.get(following.get(run["case"]))
        if other is not None:
            figures["speeds_ks"] = measures.kolmogorov_smirnov(run["speeds"], other["speeds"])
            figures["turns_ks"] = measures.kolmogorov_smirnov(run["turns"], other["turns"])
        if base is None or base is run:
            continue
        figures["exceeded_of_off"] = ratio(figures["exceeded"], base["figures"]["exceeded"])
        figures["adaptation_share"] = (run["control_ms"] - base["control_ms"]) / max(run["step_ms"], 1e-9)
        figures["bunching"] = ratio(run["rim"], base["rim"])
        figures["bunching_usual"] = ratio(run["rim_usual"], base["rim_usual"])
    compare_together(runs)


def compare_together(runs):
    """The distances over all seeds at once: where few people are in view, one seed's distance is mostly chance."""
    off = [run for run in runs if run["mode"] == "off"]
    for mode in {run["mode"] for run in runs if off and run["mode"] != "off"}:
        chosen = [run for run in runs if run["mode"] == mode]
        for key, name in (("speeds", "speeds_ks_together"), ("turns", "turns_ks_together")):
            distance = measures.kolmogorov_smirnov(*(np.concatenate([run[key] for run in some]) for some in (chosen, off)))
            for run in chosen:
                run["figures"][name] = distance


def ratio(value, base):
    """None where both are nothing."""
    if base > 0:
        return value / base
    return None if value == 0 else float("inf")
