"""The command that plays the scenarios and writes the page of figures, as a user calls it."""
import json
import pathlib
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
from support import BIN, ProgramTest, baked_demo  # noqa: E402


def scenarios(*arguments):
    command = [sys.executable, str(HERE / "scenarios.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=1200, check=False)


class Scenarios(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.pack = baked_demo() / "wolfenbuettel.glb"

    def play(self, *arguments):
        return scenarios(self.pack, "-o", self.folder / "out", "--player", BIN / "flaneur-player", *arguments)

    def test_a_page_of_figures(self):
        self.assert_succeeds(self.play("--scenario", "turn-dense", "--scenario", "walkabout-fast", "--seeds", 2, "--seconds", 3,
                                       "--report-only"))
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()), ["figures.json", "index.html"])
        page = (self.folder / "out/index.html").read_text()
        self.assertEqual(page.count("<svg"), 4, "two figures of the paper, a small plot of each scenario")
        for word in ("Figure 10", "Figure 12", "frames exceeded", "</html>"):
            self.assertIn(word, page)
        self.assertNotIn("src=", page, "needs nothing beside it")
        figures = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual(set(figures["scenarios"]), {"turn-dense", "walkabout-fast"})
        for mode in ("off", "paper", "full"):
            walkabout = figures["scenarios"]["walkabout-fast"][mode]
            self.assertEqual(list(walkabout["exceeded"]["cases"]), ["seed 1", "seed 2"])
            self.assertEqual(walkabout["wrong_view"]["worst"], 0)
        self.assertTrue(figures["targets"])

    def test_drawn_paths(self):
        self.assert_succeeds(self.play("--only-paths", "--paths", 3, "--path-seed", 9, "--without-paper", "--seconds", 10, "--report-only"))
        self.assertEqual(len(list((self.folder / "out/paths").glob("*.toml"))), 3)
        facts = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual(facts["runs"], 3 * 2 * 2)
        self.assertEqual(list(facts["scenarios"]), ["drawn paths"])
        full = facts["scenarios"]["drawn paths"]["full"]
        self.assertEqual(full["wrong_view"]["worst"], 0)
        self.assertEqual(len(full["exceeded"]["cases"]), 6)
        page = (self.folder / "out/index.html").read_text()
        for path in facts["paths"]["paths"]:
            self.assertIn(path, page)

    def test_how_much_shows_for_how_much_detail(self):
        self.assert_succeeds(self.play("--only-paths", "--paths", 2, "--path-seed", 4, "--without-paper", "--seconds", 8, "--trade",
                                       "--report-only"))
        facts = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual([p["name"] for p in facts["trade"]], ["off"] + [f"full, discretion {d}" for d in ("0", "0.25", "0.5", "0.75", "1")])
        for point in facts["trade"]:
            self.assertTrue(0 <= point["exceeded"] <= 1)
        self.assertEqual(facts["scenarios"]["drawn paths"]["full"]["exceeded"]["cases"].keys(),
                         facts["scenarios"]["drawn paths"]["off"]["exceeded"]["cases"].keys(), "other discretions are judged apart")

    def test_bad_input(self):
        self.assert_fails(self.play("--scenario", "walkabout"), "walkabout", "there are", "spin")
        self.assert_fails(scenarios(self.folder / "none.glb", "-o", self.folder), "none.glb", "no such file")
        self.assert_fails(scenarios(HERE / "scenarios.py", "-o", self.folder), "scenarios.py", "not a tour pack")
        self.assert_fails(scenarios(self.pack, "-o", self.folder, "--player", self.folder / "none"), "no such file", "--player")
        self.assert_fails(self.play("--seeds", 0), "--seeds")


if __name__ == "__main__":
    unittest.main()
