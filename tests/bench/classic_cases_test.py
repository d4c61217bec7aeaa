"""The command that plays, times and shows the classic cases of crowds, as a user calls it."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
from support import BIN, ProgramTest  # noqa: E402

NODE = shutil.which("node") or shutil.which("nodejs")
# Just enough of a browser for the page's script; says what is drawn at the beginning and at the end of the case.
BROWSER = """
let drawn = {arc: 0, lineTo: 0};
const pen = new Proxy({}, {set: () => true, get: (_, name) => (...xy) => {
  drawn[name] = (drawn[name] || 0) + 1;
  xy.forEach(v => { if (!isFinite(v)) throw name; });
}});
const nodes = {};
const node = () => ({children: [], classList: {toggle() {}}, append(child) { this.children.push(child); },
                     getContext: () => pen, width: 2200, height: 1300, value: 1});
globalThis.document = {getElementById: id => nodes[id] ||= node(), createElement: node};
globalThis.requestAnimationFrame = () => {};
const script = require('fs').readFileSync(process.argv[2], 'utf8').match(/<script>([^]*)<\\/script>/)[1];
new Function(script)();
const begin = drawn;
drawn = {arc: 0, lineTo: 0};
nodes.time.value = nodes.time.max;
nodes.time.oninput();
console.log(JSON.stringify({begin, end: drawn, clock: nodes.clock.textContent, cases: nodes.cases.children.length}));
"""


def classic_cases(*arguments):
    command = [sys.executable, str(HERE / "classic_cases.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)


class ClassicCases(ProgramTest):
    def play(self, *arguments):
        player = BIN / "flaneur-player"
        return classic_cases(*arguments, "-o", self.folder / "out", "--player", player, "--runs", 2)

    def test_figures_of_each_and_a_page_that_needs_nothing_beside_it(self):
        result = self.play("narrow-lane", "standing-group")
        self.assert_succeeds(result)
        rows = {line.split()[0]: line.split()[1:] for line in result.stdout.splitlines()}
        self.assertEqual((rows["narrow-lane"][0], rows["standing-group"][0]), ("4", "16"))
        for name in ("narrow-lane", "standing-group"):
            people, there_s, gap_cm, step_ms, first_ms = map(float, rows[name])
            self.assertTrue(5 < there_s < 25 and gap_cm > -2 and 0 < step_ms and 0 < first_ms, rows[name])
        self.assertEqual([p.name for p in (self.folder / "out").iterdir()], ["index.html"])
        page = (self.folder / "out/index.html").read_text()
        self.assertIsNone(re.search(r"src=|href=|https?:", page))

    @unittest.skipIf(NODE is None, "no node to run the page with")
    def test_the_page_draws_who_is_there(self):
        self.assert_succeeds(self.play("standing-group", "narrow-lane"))
        result = subprocess.run([NODE, "-", self.folder / "out/index.html"], input=BROWSER, capture_output=True,
                                text=True, timeout=60, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        seen = json.loads(result.stdout)
        self.assertEqual((seen["begin"]["arc"], seen["end"]["arc"]), (16, 4), "at the end only those who stay")
        self.assertEqual((seen["clock"], seen["cases"]), ("25.0 s", 2))

    def test_bad_input(self):
        self.assert_fails(self.play("bottlenek"), "bottlenek", "there are", "bottleneck")
        in_a_tour = HERE.parent / "scenario/spin.toml"
        self.assert_fails(self.play(in_a_tour), "spin.toml", "no [ground]", "flaneur-player")
        broken = self.folder / "broken.toml"
        broken.write_text("peple = 3\n[ground]\nmin_m = [0, 0]\nmax_m = [9, 9]\n")
        self.assert_fails(self.play(broken), "broken.toml:1", "unknown key 'peple'")
        without_player = classic_cases("-o", self.folder, "--player", self.folder / "none")
        self.assert_fails(without_player, "no such file", "--player")
        self.assert_fails(classic_cases("-o", self.folder, "--runs", 0), "--runs")


if __name__ == "__main__":
    unittest.main()
