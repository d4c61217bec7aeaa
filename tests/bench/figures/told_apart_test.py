"""The classifier on crowds made up so that one knows whether they can be told apart."""
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from figures import recording, told_apart  # noqa: E402

STEP_S = 1 / 30
FRAMES = 420


def walkers(dice, count, sway_m):
    """A recording of people who walk past a camera at the origin; sway_m: how far they swing aside."""
    time = np.arange(FRAMES) * STEP_S
    columns = {name: [] for name in ("frame", "id", "x_m", "y_m", "heading_rad")}
    for person in range(count):
        speed, side, phase = dice.normal(1.2, 0.1), dice.uniform(-6, 6), dice.uniform(0, 6)
        swing = sway_m * np.sin(2 * time + phase)
        for name, values in (("frame", np.arange(FRAMES)), ("id", np.full(FRAMES, person)), ("x_m", 2 + dice.uniform(0, 4) + 0.3 * speed * time),
                             ("y_m", side + swing), ("heading_rad", np.zeros(FRAMES))):
            columns[name].append(values)
    people = {name: np.concatenate(values) for name, values in columns.items()}
    people["view"] = np.full(len(people["frame"]), b"visible")
    return recording.sorted_people(people)


def camera():
    metrics = {name: np.zeros(FRAMES) for name in ("camera_x_m", "camera_y_m", "camera_yaw_rad", "actual_speed_mps")}
    return {**metrics, "frame": np.arange(FRAMES)}


def sides(sway_m, seed):
    dice = np.random.default_rng(seed)
    return {f"path {k}": told_apart.features(camera(), walkers(dice, 25, sway_m), STEP_S) for k in range(4)}


@unittest.skipIf(told_apart.MISSING, told_apart.MISSING)
class ToldApart(unittest.TestCase):
    def test_features_of_a_straight_walk(self):
        table = told_apart.features(camera(), walkers(np.random.default_rng(1), 10, 0), STEP_S)
        value = dict(zip(told_apart.FEATURES, table.T))
        self.assertGreater(len(table), 40)
        np.testing.assert_allclose(value["straightness"], 1, atol=1e-5)
        self.assertLess(value["turning"].max(), 1e-5)
        self.assertLess(value["braking"].max(), 1e-3)
        self.assertTrue(np.all((value["speed"] > 0.25) & (value["speed"] < 0.5)), "metres a second")
        self.assertTrue(np.all(value["leaves"] > 0), "they walk away")

    def test_only_people_near_and_in_view_all_through_count(self):
        crowd = walkers(np.random.default_rng(1), 4, 0)
        crowd["visible"][(crowd["id"] == 0) & (crowd["frame"] % 60 == 30)] = False
        crowd["x_m"][crowd["id"] == 1] += 40
        self.assertEqual(len(told_apart.features(camera(), crowd, STEP_S)), 2 * (FRAMES // 63))

    def test_equal_crowds_are_not_told_apart(self):
        scores = told_apart.told_apart(sides(0.1, 1), sides(0.1, 2))
        self.assertEqual(len(scores), 4)
        self.assertAlmostEqual(np.mean(list(scores.values())), 0.5, delta=0.08)

    def test_who_sways_more_is_and_turning_tells(self):
        a, b = sides(0.4, 1), sides(0.1, 2)
        self.assertGreater(np.mean(list(told_apart.told_apart(a, b).values())), 0.95)
        told = [name for name, _ in told_apart.what_tells(a, b)]
        self.assertEqual(len(told), len(told_apart.FEATURES))

    def test_too_little_says_nothing(self):
        few = {name: table[:5] for name, table in sides(0.1, 1).items()}
        self.assertEqual(told_apart.told_apart(few, few), {})
        self.assertEqual(told_apart.told_apart({}, {}), {})


if __name__ == "__main__":
    unittest.main()
