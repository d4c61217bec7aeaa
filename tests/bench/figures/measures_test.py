"""The measures on runs so small that one can count by hand."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from figures import measures, recording, runs, summary  # noqa: E402

STEP_S = 1 / 30
FOV_RAD = math.radians(60)


def people(*rows):
    """Columns of (frame, id, x, y[, view[, level[, heading]]])."""
    filled = [row + (b"visible", b"0", 0.0)[len(row) - 4:] for row in rows]
    frame, person, x, y, view, level, heading = zip(*filled)
    return recording.sorted_people({
        "frame": np.array(frame), "id": np.array(person), "x_m": np.array(x, float), "y_m": np.array(y, float),
        "view": np.array(view), "level": np.array(level), "heading_rad": np.array(heading, float),
        "radius_m": np.full(len(frame), 0.25)})


def metrics(places=((0, 0),), yaw_rad=0.0, asked_mps=0.0, actual_mps=0.0):
    """A camera at these places, one a frame, looking along +x."""
    count = len(places)
    columns = {"camera_x_m": [p[0] for p in places], "camera_y_m": [p[1] for p in places], "camera_yaw_rad": [yaw_rad] * count,
               "camera_fov_rad": [FOV_RAD] * count, "frame": range(count), "asked_speed_mps": [asked_mps] * count,
               "actual_speed_mps": [actual_mps] * count, "r_personal_m": [0.6] * count, "outer_apex_back_m": [2] * count}
    return {name: np.array(list(values), float) for name, values in columns.items()}


class Measures(unittest.TestCase):
    def test_candidates_are_visible_people_within_r_high(self):
        crowd = people((0, 1, 5, 0), (0, 2, 10.5, 0), (0, 3, 5, 1, b"boundary"), (1, 1, 9.9, 0), (1, 2, 9.9, 1))
        counts = measures.candidates(metrics([(0, 0), (0, 0)]), crowd, 10)
        self.assertEqual(list(counts), [1, 2])
        self.assertEqual(measures.share_exceeded(counts, np.array([1, 1])), 0.5)
        self.assertEqual(measures.share_exceeded(counts, np.array([1, 1]), first=1), 1.0)

    def test_view_is_the_cameras_wedge(self):
        crowd = people((0, 1, 5, 0), (0, 2, 5, 4), (0, 3, 5, 4, b"boundary"), (0, 4, 5, 0.5, b"outside"), (0, 5, -5, 0, b"outside"))
        self.assertEqual(measures.wrong_views(metrics(), crowd), 2)

    def test_boundary_is_the_outer_wedge_alone(self):
        """Its apex lies 2 m behind the camera, so that its edges run a metre outside the view's."""
        crowd = people((0, 1, 5, 3.5, b"boundary"), (0, 2, 5, 4.5, b"boundary"), (0, 3, 5, 3.5, b"outside"), (0, 4, -1, 0, b"boundary"),
                       (0, 5, -3, 0, b"boundary"), (0, 6, -3, 0, b"outside"))
        self.assertEqual(measures.wrong_views(metrics(), crowd), 3)
        crowd["reach_m"] = np.full(6, 1.05)
        self.assertEqual(measures.wrong_views(metrics(), crowd), 4, "arms reach farther")

    def test_overlaps_count_pairs_and_leave_out_dense_places(self):
        pair = [(0, 1, 5, 0), (0, 2, 5.4, 0), (1, 1, 5, 0), (1, 2, 5.4, 0)]
        crowd = people(*pair)
        self.assertEqual(measures.overlapping_pairs(crowd, recording.judged_frames(crowd)), (1, 1))
        throng = people(*pair, *((f, 10 + k, 4 + k % 4 * 0.7, 1 - k // 4 * 0.6, b"boundary") for f in (0, 1) for k in range(16)))
        self.assertEqual(measures.overlapping_pairs(throng, recording.judged_frames(throng)), (0, 1))

    def test_people_come_and_go_at_gates_and_last_goals_only(self):
        crowd = people((0, 1, 5, 0), (1, 1, 5, 0), (2, 1, 5, 0),   # there all along
                       (1, 2, 20, 0), (2, 2, 20, 0),               # born in the street
                       (1, 3, 30, 1), (2, 3, 30, 1),               # born at the door
                       (0, 4, 8, 0),                               # gone from the street
                       (0, 5, 40, 0.5), (0, 6, 8, 0, b"outside"))  # gone at the goal; gone unseen
        self.assertEqual(measures.seen_coming_and_going(crowd, [(30, 0)], [(40, 0)]), (1, 1))

    def test_motion_of_those_visible_in_both_frames(self):
        crowd = people((0, 1, 5, 0, b"visible", b"0", 3.1), (1, 1, 5.04, 0.03, b"visible", b"0", -3.1), (0, 2, 5, 0, b"boundary"),
                       (1, 2, 6, 0))
        speed, turn = measures.visible_motion(crowd, STEP_S)
        np.testing.assert_allclose(speed, [1.5])
        np.testing.assert_allclose(turn, [(2 * math.pi - 6.2) * 30])

    def test_kolmogorov_smirnov(self):
        self.assertEqual(measures.kolmogorov_smirnov([1, 2, 3, 4], [1, 2, 3, 4]), 0)
        self.assertEqual(measures.kolmogorov_smirnov([1, 2], [3, 4]), 1)
        self.assertEqual(measures.kolmogorov_smirnov([1, 2, 3, 4], [3, 4, 5, 6]), 0.5)
        self.assertIsNone(measures.kolmogorov_smirnov([], [1]))

    def test_level_switches_per_visible_minute(self):
        crowd = people(*((frame, 1, 5, 0, b"visible", b"0" if frame < 900 else b"1") for frame in range(1800)))
        self.assertAlmostEqual(measures.level_switches(crowd, STEP_S), 1)

    def test_a_fade_that_comes_into_view_is_a_switch(self):
        crowd = people((0, 1, 5, 0, b"boundary", b"none"), (1, 1, 5, 0), (2, 1, 5, 0), (0, 2, 5, 0), (1, 2, 5, 0), (2, 2, 5, 0))
        crowd["fading_level"] = np.array([b"none", b"none", b"impostor", b"none", b"impostor", b"none"])
        self.assertAlmostEqual(measures.level_switches(crowd, 60), 1 / 5, msg="one person, once, in five visible minutes")

    def test_what_the_limit_leaves(self):
        counts, limits = np.array([20, 8, 16, 2]), np.full(4, 16)
        self.assertEqual(measures.people_over(counts, limits), 1)
        self.assertEqual(measures.filled(counts, limits, np.array([17, 30, 3])), 0.75, "of the frames where the base has the limit")
        self.assertIsNone(measures.filled(counts, limits, np.zeros(4)))

    def test_the_densest_ring(self):
        crowd = people((0, 1, 5.5, 0), (0, 2, 0, 5.5), (0, 3, -8.5, 0), (0, 4, 0.5, 0))
        rings = measures.ring_densities(metrics(), crowd, 10)
        self.assertAlmostEqual(rings[5], 2 / (math.pi * 11))
        free = measures.ring_densities(metrics(), people((0, 1, 5.5, 0), (0, 2, 8.5, 0)), 10)
        self.assertAlmostEqual(measures.densest_ring(rings, free), 2)
        self.assertIsNone(measures.densest_ring(rings, np.zeros(10)))

    def test_rim_density_sees_the_rim_alone(self):
        outline = measures.obstacle_outline(np.array([10.0, 5.0, 0.0, 12.0]), np.zeros(4), 0, FOV_RAD, 10)
        np.testing.assert_allclose(outline, [0, -5, 0, 2], atol=1e-9)
        lone = people((0, 1, 10, 0), (0, 2, 5, 0), (0, 3, 5, 0.3))
        np.testing.assert_allclose(measures.rim_densities(metrics(), lone, 10), [1 / math.pi], rtol=1e-3)
        huddle = people((0, 1, 10, 0), (0, 2, 10, 0.5))
        np.testing.assert_allclose(measures.rim_densities(metrics(), huddle, 10), [(1 + math.exp(-0.25)) / math.pi])

    def test_users_speed_and_direction(self):
        way = metrics([(0, 0), (0.1, 0), (0.2, 0), (0.3, 0), (0.3, 0.1)], asked_mps=2, actual_mps=1.5)
        self.assertEqual(measures.speed_ratio(way), 0.75)
        self.assertIsNone(measures.speed_ratio(metrics()))
        self.assertAlmostEqual(measures.direction_error(way, [(10, 0), (0.3, 9)]), 0)
        self.assertAlmostEqual(measures.direction_error(way, [(10, 0)]), 90, delta=1)
        self.assertIsNone(measures.direction_error(way, []))

    def test_personal_space(self):
        self.assertEqual(measures.too_near(metrics([(0, 0)] * 3), people((0, 1, 0.5, 0), (1, 1, 0.61, 0), (2, 1, 0, -0.2))), 2)

    def test_density_map_turns_with_the_camera(self):
        chart = measures.density_map(metrics([(0, 0)], yaw_rad=math.pi / 2), people((0, 1, -1.5, 4.5)), 5, 1)
        self.assertEqual(chart[9, 3], 1)  # 4.5 m ahead, 1.5 m to the left
        self.assertEqual(chart.sum(), 1)


def run(mode, case, exceeded, rim=1.0):
    return {"group": "walkabout-fast", "mode": mode, "case": case, "figures": {"exceeded": exceeded, "jumps": 0},
            "speeds": np.arange(10.0), "turns": np.arange(10.0), "rim": rim, "rim_usual": rim,
            "control_ms": 0.25 if mode == "full" else 0.125, "step_ms": 1.0}


class Summary(unittest.TestCase):
    def test_medians_and_verdicts(self):
        shares = {"off": (0.5, 0.4, 0.3), "full": (0.0, 0.008, 0.3)}
        judged = [run(mode, f"seed {k}", share, rim=2.0 if mode == "full" else 1.0)
                  for mode in shares for k, share in enumerate(shares[mode])]
        runs.compare_with_off(judged)
        table = summary.summarise(judged)
        full = table["walkabout-fast"]["full"]
        self.assertEqual((full["exceeded"]["median"], full["exceeded"]["worst"]), (0.008, 0.3))
        self.assertEqual(full["exceeded_of_off"]["cases"]["seed 2"], 1.0)
        self.assertEqual(full["bunching"]["median"], 2.0)
        self.assertEqual(full["adaptation_share"]["median"], 0.125)
        verdict = {v["figure"]: v for v in summary.verdicts(table)}
        self.assertTrue(verdict["exceeded"]["reached"], "the median counts")
        self.assertEqual(verdict["bunching"]["missed_in"], ["walkabout-fast full"])
        self.assertIn("MISSED in 1", summary.terminal_table(list(verdict.values())))

    def test_what_never_may_happen_is_judged_by_every_seed(self):
        judged = [run("full", f"seed {k}", 0.0) for k in range(3)]
        judged[1]["figures"]["jumps"] = 1
        verdict = {v["figure"]: v for v in summary.verdicts(summary.summarise(judged))}
        self.assertFalse(verdict["jumps"]["reached"])


if __name__ == "__main__":
    unittest.main()
