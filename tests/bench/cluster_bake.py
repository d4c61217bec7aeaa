"""A tour of many characters through Slurm's single node against `flaneur bake`: time, bytes, memory of the planner.

    python3 tests/bench/cluster_bake.py [--avatars 200] [--cpus 2]

The characters are one simple figure in as many sizes, with impostors as usual. Both start with an empty
cache, one after the other; Slurm's node (munge, slurmctld, slurmd; needs root) has as many cores as the bake may use.
"""
import argparse
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from cluster import CannotStart, Cluster  # noqa: E402
from scenes import write_box_town, write_person  # noqa: E402
from support import BIN, SOURCE  # noqa: E402

TOUR = """
[tour]
name = "many"
[town]
file = "town.glb"
[impostor]
directions = 16
height_px = 128
"""
MADE = ("many.glb", "footprints.geojson", "plan.png")


def write_tour(folder, count):
    write_box_town(folder / "town.glb")
    write_person(folder / "person.glb")
    avatars = (f'[[avatar]]\nname = "person_{i}"\nfile = "person.glb"\nheight_m = {1.5 + i / 1000:.3f}\n' for i in range(count))
    (folder / "tour.toml").write_text(TOUR + "".join(avatars))
    return folder / "tour.toml"


def seconds_of(command, **options):
    start = time.monotonic()
    result = subprocess.run(list(map(str, command)), check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if result.returncode:
        sys.exit(f"{command[0]} failed:\n{result.stdout[-3000:]}")
    return time.monotonic() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--avatars", type=int, default=200)
    parser.add_argument("--cpus", type=int, default=2)
    a = parser.parse_args()
    flaneur, scripts = BIN / "flaneur", SOURCE / "scripts/cluster"
    with tempfile.TemporaryDirectory(prefix="flaneur_cluster_") as text:
        folder = pathlib.Path(text)
        tour = write_tour(folder, a.avatars)
        plan_s = seconds_of([flaneur, "plan", tour, "--json", "--cache", folder / "none"])
        plan_mb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        alone_s = seconds_of([flaneur, "bake", tour, "-j", a.cpus, "--cache", folder / "alone", "-o", folder / "by_itself"])
        try:
            cluster = Cluster(folder / "cluster", cpus=a.cpus)
        except CannotStart as reason:
            sys.exit(f"no Slurm here: {reason}")
        try:
            slurm_s = seconds_of(
                ["snakemake", "--quiet", "-s", scripts / "Snakefile", "--profile", scripts / "slurm", "-j", 3 * a.cpus, "--latency-wait", 10,
                 "--config", f"tours={tour}", f"flaneur={flaneur}", f"options=--cache {folder / 'shared'} -o {folder / 'by_slurm'}"],
                cwd=folder, env=cluster.environment)
        finally:
            cluster.stop()
        same = all((folder / "by_itself" / name).read_bytes() == (folder / "by_slurm" / name).read_bytes() for name in MADE)
    print(f"{a.avatars} characters, {a.cpus} cores: flaneur bake {alone_s:.0f} s, through Slurm {slurm_s:.0f} s, {slurm_s / alone_s:.2f} times; "
          f"same bytes: {'yes' if same else 'NO'}; flaneur plan {plan_s:.1f} s, {plan_mb:.0f} MB")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
