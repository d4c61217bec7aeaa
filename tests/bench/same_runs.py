"""Do two players play the same, bit for bit?

    same_runs.py OLD_PLAYER NEW_PLAYER PACK [SCENARIO.toml ...] [--seconds S] [--jobs N]

Plays the scenarios (all of tests/scenario and of the demo where none is named) with each adaptation with both players, without
drawing, and compares what they write: all trajectories, levels of detail, and metrics but the milliseconds that were measured. Prints a hash of each
run's trajectories and which metrics differ, and ends with status 1 where anything does.
"""
import argparse
import concurrent.futures
import csv
import hashlib
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEVEL = 9  # the column of the trajectories
MEASURED = {"step_ms", "control_ms"}  # draw_ms is a scenario's model here, and must be the same


def run_hashes(player, pack, scenario, adaptation, seconds, folder):
    """A hash of the trajectories, one of the levels and one of each column of the metrics; or its complaint where the run ends with one."""
    metrics, trajectories = folder / "metrics.csv", folder / "trajectories.csv"
    command = [player, *pack, "--headless", "--no-draw", "--scenario", scenario, "--adaptation", adaptation,
               "--seconds", str(seconds), "--metrics", metrics, "--trajectories", trajectories]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return {"complaint": done.stderr.strip()}
    # The level is the control's: apart from where people walk. Columns that came later are not compared.
    people = [line.split(",") for line in trajectories.read_text(encoding="utf-8").splitlines()]
    hashes = {}
    for name, part in (("trajectories", slice(0, LEVEL)), ("levels", slice(LEVEL, LEVEL + 1))):
        hashes[name] = hashlib.sha256("\n".join(",".join(line[part]) for line in people).encode()).hexdigest()[:16]
    with open(metrics, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for name in set(rows[0]) - MEASURED:
        hashes[name] = hashlib.sha256("\n".join(row[name] for row in rows).encode()).hexdigest()[:16]
    return hashes


def compare(players, pack, scenario, adaptation, seconds):
    """The run's name, its trajectories' hash, and the names of what differs."""
    # A scenario with ground of its own is played without the pack too: there the plain figure walks.
    own_ground = "[ground]" in scenario.read_text(encoding="utf-8")
    differs, shown = set(), ""
    for chosen in ([[pack], []] if own_ground else [[pack]]):
        with tempfile.TemporaryDirectory() as name:
            old, new = (run_hashes(player, chosen, scenario, adaptation, seconds, pathlib.Path(name)) for player in players)
        differs |= {key for key in old.keys() | new.keys() if old.get(key) != new.get(key)}
        shown = new.get("trajectories", "fails")
    return f"{scenario.name} {adaptation}", shown, sorted(differs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old_player", type=pathlib.Path)
    parser.add_argument("new_player", type=pathlib.Path)
    parser.add_argument("pack", type=pathlib.Path)
    parser.add_argument("scenarios", type=pathlib.Path, nargs="*")
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--jobs", type=int, default=2)
    a = parser.parse_args()
    scenarios = a.scenarios or sorted([*ROOT.glob("tests/scenario/**/*.toml"), *ROOT.glob("assets_src/wolfenbuettel/**/*.toml")])
    scenarios = [s for s in scenarios if s.name != "tour.toml"]
    players = [a.old_player.resolve(), a.new_player.resolve()]
    runs = [(s, adaptation) for s in scenarios for adaptation in ("off", "paper", "full")]
    count = {"same": 0, "same trajectories": 0, "DIFFERENT": 0}
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for name, trajectories, differs in pool.map(lambda run: compare(players, a.pack.resolve(), *run, a.seconds), runs):
            verdict = "same" if not differs else "DIFFERENT" if {"trajectories", "complaint"} & set(differs) else "same trajectories"
            count[verdict] += 1
            print(f"{verdict:17}  {trajectories}  {name}" + (f": {', '.join(differs)} differ" if differs else ""), flush=True)
    print(f"of {len(runs)} runs {count['same']} are the same, {count['same trajectories']} differ in levels or metrics alone")
    return 1 if count["same"] < len(runs) else 0


if __name__ == "__main__":
    sys.exit(main())
