"""Avatars and a town that are not ours, from their files to a walking crowd, judged from outside."""
import csv
import json
import unittest

import judge
from support import ProgramTest, run, shared_data

TOWN = "towns/kaykit-medieval/buildings/blue"
HOUSES = ["home_A", "home_B", "tavern", "blacksmith", "church", "market"]


def tour_of_foreign_parts():
    """Knight, Mage and CesiumMan among six houses of a miniature town, enlarged to fit people."""
    parts = "".join(f"""
[[town.part]]
file = "{shared_data(f'{TOWN}/building_{house}_blue.gltf')}"
position_m = [{-16 + 16 * (i % 3)}, {-10 + 20 * (i // 3)}]
yaw_deg = {90 * (i % 4)}
scale = 5
""" for i, house in enumerate(HOUSES))
    avatars = "".join(f"""
[[avatar]]
name = "{name}"
file = "{shared_data(file)}"
share = 1
{more}
""" for name, file, more in (
        ("knight", "avatars/kaykit/Knight.glb", 'height_m = 1.75\nwalk = "Walking_A"\nidle = "Idle"'),
        ("mage", "avatars/kaykit/Mage.glb", 'height_m = 1.7\nwalk = "Walking_A"\nidle = "Idle"'),
        ("man", "avatars/khronos/CesiumMan.glb", "height_m = 1.75")))
    return f"""
[tour]
name = "foreign"
{parts}
{avatars}
[crowd]
people = 40
[impostor]
directions = 8
height_px = 64
samples = 4
[[place]]
name = "west"
kind = "exit"
position_m = [-24, 0]
[[place]]
name = "east"
kind = "exit"
position_m = [24, 0]
[[stop]]
position_m = [-20, 0]
[[stop]]
position_m = [20, 0]
"""


class ForeignTour(ProgramTest):
    def test_baked_and_played(self):
        (self.folder / "tour.toml").write_text(tour_of_foreign_parts())
        out = self.folder / "out"
        self.assert_succeeds(run("flaneur", "bake", self.folder / "tour.toml", "-o", out, "--allow-outside"))
        pack = out / "foreign.glb"
        self.assert_valid(pack)
        self.check_report(json.loads((out / "report.json").read_text()))
        self.assert_succeeds(run("flaneur", "inspect", pack, "--json"))
        self.check_walk(pack, json.loads((out / "footprints.geojson").read_text()))
        self.check_likeness(pack)
        self.check_second_bake(out, pack)

    def check_likeness(self, pack):
        sheets = self.folder / "sheets"
        self.assert_fails(run("flaneur-likeness", pack, "-o", sheets, "--avatar", "nobody"), "nobody")
        self.assert_succeeds(run("flaneur-likeness", pack, "-o", sheets, "--headings", 4, "--phases", 2, "--suns", 1))
        with open(sheets / "likeness.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for avatar in ("knight", "mage", "man"):
            levels = {row["level"] for row in rows if row["avatar"] == avatar}
            self.assertIn("impostor", levels)
            self.assertGreaterEqual(len(levels), 3)
            self.assertTrue((sheets / f"{avatar}.png").read_bytes().startswith(b"\x89PNG"))
        for row in rows:  # these impostors have 64 px and eight directions only
            self.assertGreater(float(row["iou_mean"]), 0.85, row)
            self.assertLess(float(row["delta_e_mean"]), 10, row)

    def check_report(self, report):
        self.assertEqual(report["version"], 1)
        items = {(s["stage"], s["item"]) for s in report["stages"]}
        for avatar in ("knight", "mage", "man"):
            self.assertIn(("avatar", avatar), items)
            self.assertIn(("impostor", avatar), items)
        for stage in report["stages"]:
            self.assertIsInstance(stage["cached"], bool)
            self.assertGreaterEqual(stage["seconds"], 0)

    def check_walk(self, pack, footprints):
        metrics_file, trajectories_file = self.folder / "metrics.csv", self.folder / "trajectories.csv"
        self.assert_succeeds(run("flaneur-player", pack, "--headless", "--no-draw", "--seconds", 10, "--metrics",
                                 metrics_file, "--trajectories", trajectories_file))
        metrics = judge.read_table(metrics_file, judge.METRICS)
        frames = judge.read_trajectories(trajectories_file)
        self.assertGreaterEqual(len(metrics), 299)
        self.assertEqual(judge.frames_over_budget(metrics), [])
        self.assertEqual(judge.inside_obstacles(frames, footprints), [])
        self.assertEqual(judge.jumps(frames, top_speed_mps=2.5, step_s=1 / 30), [])
        self.assertEqual({row["avatar"] for row in frames[max(frames)].values()}, {"knight", "mage", "man"})

    def check_second_bake(self, out, pack):
        before = pack.read_bytes()
        self.assert_succeeds(run("flaneur", "bake", self.folder / "tour.toml", "-o", out, "--allow-outside"))
        self.assertEqual(pack.read_bytes(), before)
        report = json.loads((out / "report.json").read_text())
        self.assertTrue(all(s["cached"] for s in report["stages"] if s["stage"] in ("avatar", "impostor")))


if __name__ == "__main__":
    unittest.main()
