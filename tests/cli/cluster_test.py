"""A tour of twelve people baked by Snakemake: on this machine, and through Slurm, where a node is taken away in the middle."""
import json
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

from cluster import PATH, Cluster, CannotStart
from small_tour import SmallTourTest
from support import BIN, SOURCE, has_tools

SCRIPTS = SOURCE / "scripts/cluster"
MADE = ("small.glb", "footprints.geojson", "plan.png")


@unittest.skipUnless(os.environ.get("FLANEUR_CLUSTER"), "FLANEUR_CLUSTER=1 starts a cluster of one node")
class OfTwelve(SmallTourTest):
    avatars = tuple(f"person_{i}" for i in range(12))

    def setUp(self):
        super().setUp()
        if not has_tools("snakemake"):
            self.skipTest("no snakemake: install the Debian package snakemake")
        for number, name in enumerate(self.avatars):  # twelve sizes, so that none is another's
            self.tour.write_text(self.tour.read_text().replace(f'"{name}.glb"', f'"{name}.glb"\nheight_m = {1.5 + number / 50}'))

    def command(self, *options, out="out", cache="cache"):
        places = f"--cache {self.folder / cache} -o {self.folder / out}"
        return list(map(str, ["snakemake", "--quiet", "-s", SCRIPTS / "Snakefile", *options, "--config", f"tours={self.tour}",
                              f"options={places}", f"flaneur={BIN / 'flaneur'}"]))

    def made(self, out):
        return {name: (self.folder / out / name).read_bytes() for name in MADE}

    def test_the_same_bytes_and_only_what_was_lost_again(self):
        try:
            cluster = Cluster(self.folder / "cluster", cpus=2)
        except CannotStart as reason:
            self.skipTest(f"no Slurm here: {reason}")
        self.addCleanup(cluster.stop)
        self.assert_succeeds(self.bake())
        profile = ["--profile", SCRIPTS / "slurm", "-j", "4", "--latency-wait", "10"]
        with subprocess.Popen(self.command(*profile, out="slurm"), cwd=self.folder, env=cluster.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True) as engine:
            marks = self.folder / ".flaneur_cluster/marks"
            deadline = time.monotonic() + 200
            while len(list(marks.rglob("*.done"))) < 8 and engine.poll() is None and time.monotonic() < deadline:
                time.sleep(0.2)
            # What steps took is noted when they are done. Slurm may not have heard of the last ones and start them again; those
            # find their results.
            notes = {note: note.stat().st_mtime_ns for note in (self.folder / "cache/taken").glob("*.json")}
            for job in cluster.jobs():  # what a node that goes away does to them
                cluster.run("scancel", "--signal=KILL", "--full", job)
            cluster.end("slurmd")
            cluster.start_node()
            output = engine.communicate(timeout=300)[0]
        self.assertEqual(engine.returncode, 0, output[-3000:])
        self.assertEqual(self.made("slurm"), self.made("out"))
        self.assertGreaterEqual(len(notes), 6)
        self.assertEqual({note: note.stat().st_mtime_ns for note in notes}, notes, "what was done is not done again")
        again = subprocess.run(self.command("-j", "2", out="slurm"), cwd=self.folder, env=dict(cluster.environment), check=False,
                               capture_output=True, text=True)
        self.assertEqual(again.returncode, 0, again.stderr)
        plan = json.loads((self.folder / ".flaneur_cluster/plan.json").read_text())
        self.assertEqual(plan, [], "all is there")


@unittest.skipUnless(os.environ.get("FLANEUR_CLUSTER"), "FLANEUR_CLUSTER=1 has Snakemake bake a tour")
class OfOne(SmallTourTest):
    def test_on_this_machine(self):
        if not has_tools("snakemake"):
            self.skipTest("no snakemake: install the Debian package snakemake")
        places = f"--cache {self.folder / 'cache'} -o {self.folder / 'snake'}"
        command = ["snakemake", "--quiet", "-s", SCRIPTS / "Snakefile", "-j", "2", "--config", f"tours={self.tour}", f"options={places}",
                   f"flaneur={BIN / 'flaneur'}"]
        result = subprocess.run(list(map(str, command)), cwd=self.folder, env=self.environment(PATH=PATH), check=False,
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_succeeds(self.bake())
        for name in MADE:
            self.assertEqual((self.folder / "snake" / name).read_bytes(), (self.out / name).read_bytes())


@unittest.skipUnless(has_tools("snakemake"), "no snakemake: install the Debian package snakemake")
class OfTwoTours(unittest.TestCase):
    def test_a_step_that_both_need_is_done_once(self):
        """However much longer one of them waits for it: it was done for each."""
        def step(name, key, needs, seconds):
            return {"name": name, "key": key, "needs": needs, "seconds": seconds, "memory_mb": 100, "done": False}
        with tempfile.TemporaryDirectory() as text:
            folder = pathlib.Path(text)
            for tour, seconds in (("one", 0.1), ("two", 40)):
                steps = [step("source:x", "shared", [], 0.1), step("pack:" + tour, tour, ["source:x"], seconds)]
                (folder / f"{tour}.json").write_text(json.dumps({"steps": steps}))
            plans = folder / "plans"  # answers as flaneur plan
            plans.write_text('#!/bin/sh\ncat "$2"\n')
            plans.chmod(0o755)
            subprocess.run(["snakemake", "--quiet", "-s", SCRIPTS / "Snakefile", "-j", "2", "--config", "tours=one.json two.json",
                            f"flaneur={plans}", "simulate=0.001"], cwd=folder, check=True, capture_output=True)
            self.assertEqual(sorted(done.stem for done in (folder / ".flaneur_cluster/marks").rglob("*.done")), ["one", "shared", "two"])


if __name__ == "__main__":
    unittest.main()
