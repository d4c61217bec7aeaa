"""Do two players play the same, bit for bit?

    same_runs.py OLD_PLAYER NEW_PLAYER PACK [SCENARIO.toml ...] [--seconds S] [--jobs N]

Plays the scenarios (all of tests/scenario and of the demo where none is named) with each adaptation with both players, without
drawing, and compares what they write: all trajectories, and all metrics but the milliseconds that were measured. Prints a hash a run,
and ends with status 1 where any two differ.
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
MEASURED = {"step_ms", "control_ms"}  # draw_ms is a scenario's model here, and must be the same


def run_hash(player, pack, scenario, adaptation, seconds, folder):
    """A hash of what this run writes; its complaint where it ends with one."""
    metrics, trajectories = folder / "metrics.csv", folder / "trajectories.csv"
    command = [player, *pack, "--headless", "--no-draw", "--scenario", scenario, "--adaptation", adaptation,
               "--seconds", str(seconds), "--metrics", metrics, "--trajectories", trajectories]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return "fails: " + done.stderr.strip()
    digest = hashlib.sha256(trajectories.read_bytes())
    with open(metrics, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            digest.update(repr([(key, value) for key, value in row.items() if key not in MEASURED]).encode())
    return digest.hexdigest()[:16]


def compare(players, pack, scenario, adaptation, seconds):
    # A scenario with ground of its own is played without the pack too: there the plain figure walks.
    own_ground = "[ground]" in scenario.read_text(encoding="utf-8")
    hashes = []
    for player in players:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            hashes.append([run_hash(player, chosen, scenario, adaptation, seconds, folder)
                           for chosen in ([[pack], []] if own_ground else [[pack]])])
    return f"{scenario.name} {adaptation}", hashes


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
    different = 0
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for name, (old, new) in pool.map(lambda run: compare(players, a.pack.resolve(), *run, a.seconds), runs):
            same = old == new
            different += not same
            print(f"{'same' if same else 'DIFFERENT'}  {' '.join(new)}  {name}" + ("" if same else f"  (was {' '.join(old)})"), flush=True)
    print(f"{len(runs) - different} of {len(runs)} runs are the same")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
