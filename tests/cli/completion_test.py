"""Versions, and completion in bash: every verb, option and choice of the programs, as they themselves tell them."""
import re
import subprocess
import unittest

from support import BIN, SOURCE, run

COMPLETION = BIN.parent / "packaging/described/completion"


def complete(*words):
    """What bash offers for the last of the words; the first is the program."""
    function = "_" + words[0].replace("-", "_")
    script = f'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); {function}; printf "%s\\n" "${{COMPREPLY[@]}}"'
    result = subprocess.run(["bash", "-c", script, "bash", str(COMPLETION / words[0]), *words], check=True, capture_output=True, text=True)
    return result.stdout.split()


def options(*command):
    """Long options in a program's help, wherever they stand at the beginning of a line."""
    return sorted(set(re.findall(r"^ +(?:-\w, ?)?(--[\w-]+)", run(*command, "--help").stdout, re.MULTILINE)))


class Completion(unittest.TestCase):
    def test_every_option_of_the_player(self):
        said = options("flaneur-player")
        self.assertGreater(len(said), 20)
        self.assertEqual(sorted(complete("flaneur-player", "--")), said)
        self.assertEqual(complete("flaneur-player", "--headless", "--sc"), ["--scenario", "--screenshot"])

    def test_every_verb_and_each_ones_options(self):
        verbs = complete("flaneur", "")
        for verb in ("avatar", "bake", "cache", "check", "footprints", "impostor", "inspect", "plan", "step", "web"):
            self.assertIn(verb, verbs)
            said = options("flaneur", verb)
            self.assertIn("--help", said)
            self.assertEqual(sorted(complete("flaneur", verb, "--")), said)

    def test_choices_follow_their_option(self):
        self.assertEqual(complete("flaneur-player", "--adaptation", ""), ["off", "paper", "full"])
        self.assertEqual(complete("flaneur-player", "--adaptation", "p"), ["paper"])
        self.assertEqual(sorted(complete("flaneur", "check", "town.geojson", "--units", "")), ["auto", "degrees", "metres"])

    def test_files_are_left_to_bash(self):
        self.assertEqual(complete("flaneur-player", "to"), [])
        self.assertEqual(complete("flaneur", "footprints", "town.o"), [])
        self.assertEqual(complete("flaneur", "nonsense", "--"), [])


class Version(unittest.TestCase):
    def test_both_programs_say_the_projects(self):
        version, = re.findall(r"^project\(flaneur .*VERSION ([0-9.]+)\)", (SOURCE / "CMakeLists.txt").read_text(), re.MULTILINE)
        for program in ("flaneur", "flaneur-player"):
            result = run(program, "--version")
            self.assertEqual((result.returncode, result.stdout), (0, f"{program} {version}\n"), result.stderr)
        self.assertIn(f"## {version}", (SOURCE / "CHANGELOG.md").read_text())


if __name__ == "__main__":
    unittest.main()
