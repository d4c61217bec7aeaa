"""How near Snakemake's scheduling of a bake's steps comes to the ideal on many nodes.

    python3 tests/bench/cluster_bench.py REPORT.json [--nodes 100] [--steps 2000]

REPORT.json is that of a baked tour. Made-up tours of 50 characters, so many steps in all, need each other's steps as a
tour's do and take as long as its steps did, in turn, but only sleep, each on a node of its own. Ideal is all work divided
by the nodes, or the longest chain where that is more.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile
import time

SNAKEFILE = pathlib.Path(__file__).resolve().parents[2] / "scripts/cluster/Snakefile"
CHARACTERS = 50  # of a tour


def times_of(report):
    """Seconds of work by stage, of all items."""
    times = {}
    for stage in json.loads(report.read_text())["stages"]:
        times.setdefault(stage["stage"], []).append(max(0.05, stage.get("work_s", stage["seconds"])))
    return times


def made_up(times, count):
    steps = []

    def step(stage, item, needs):
        of_stage = times.get(stage, [0.1])
        steps.append({"name": "%s:%s" % (stage, item), "needs": needs, "key": "%s_%s" % (stage, item), "done": False, "provisional": False,
                      "seconds": of_stage[len(steps) % len(of_stage)], "memory_mb": 100})
        return steps[-1]["name"]

    tour = 0
    while len(steps) < count:
        town = step("town", tour, [step("source", "town_%d" % tour, [])])
        needs = [town, step("check", tour, [step("footprints", tour, [town])])]
        for character in range(CHARACTERS):
            item = "%d_%d" % (tour, character)
            avatar = step("avatar", item, [step("source", item, []), town])
            impostor = step("impostor", item, [avatar])
            needs += [impostor, step("tint", item, [avatar, impostor])]
        step("pack", tour, needs)
        tour += 1
    return steps


def longest_chain(steps):
    ends = {}
    for step in steps:
        ends[step["name"]] = step["seconds"] + max((ends[need] for need in step["needs"]), default=0)
    return max(ends.values())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report", type=pathlib.Path)
    parser.add_argument("--nodes", type=int, default=100)
    parser.add_argument("--steps", type=int, default=2000)
    arguments = parser.parse_args()
    steps = made_up(times_of(arguments.report), arguments.steps)
    work, chain = sum(step["seconds"] for step in steps), longest_chain(steps)
    ideal = max(work / arguments.nodes, chain)
    with tempfile.TemporaryDirectory() as folder:
        plan = pathlib.Path(folder) / "plan.json"
        plan.write_text(json.dumps({"version": 1, "steps": steps}))
        start = time.monotonic()
        subprocess.run(["snakemake", "--quiet", "-s", SNAKEFILE, "-j", str(arguments.nodes), "--scheduler", "greedy",
                        "--config", "plan=plan.json", "simulate=1"], cwd=folder, check=True)
        took = time.monotonic() - start
    print("%d steps, %.0f s of work, longest chain %.1f s" % (len(steps), work, chain))
    print("%d nodes: %.1f s, ideal %.1f s: %.0f %% of the ideal speed-up" % (arguments.nodes, took, ideal, 100 * ideal / took))


if __name__ == "__main__":
    main()
