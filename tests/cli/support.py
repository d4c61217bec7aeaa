"""What the tests of the programs share: calling them, finding test data, small files to feed them."""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("FLANEUR_BIN", SOURCE / "build/release/bin"))
SHARED = pathlib.Path(os.environ.get("FLANEUR_SHARED_DIR", SOURCE.parent / "shared"))
VALIDATOR = pathlib.Path(__file__).resolve().parent / "validator"


def run(program, *arguments, **options):
    """Runs a program of ours to its end; the result has returncode, stdout and stderr as text."""
    command = [str(BIN / program), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=1200, **options)


def shared_data(path):
    """A file of the real test data, or a skip that says what is missing."""
    full = SHARED / "data" / path
    if not full.exists():
        raise unittest.SkipTest(f"no {full}: set FLANEUR_SHARED_DIR to the folder with the test data")
    return full


def has_tools(*tools):
    return all(shutil.which(tool) for tool in tools)


def split_glb(path):
    """A GLB's JSON as a dict, and its binary chunk."""
    data = pathlib.Path(path).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[20 + length + 8:]


def write_glb(path, gltf, binary=b""):
    """Writes a GLB from a dict and a binary chunk."""
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    pathlib.Path(path).write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


DEMO_TOUR = SOURCE / "assets_src/wolfenbuettel/tour.toml"


def baked_demo():
    """The folder with the demo tour baked: the one that ./demo uses, so that nobody bakes again what another has."""
    folder = SOURCE / "build_assets/wolfenbuettel"
    result = run("flaneur", "bake", DEMO_TOUR, "-o", folder)
    if result.returncode != 0:
        raise AssertionError(result.stdout + result.stderr)
    return folder


def made_by(step, tour=DEMO_TOUR, output=SOURCE / "build_assets/wolfenbuettel"):
    """The file that holds what a step of a bake has made, such as "source:town"."""
    plan = json.loads(run("flaneur", "plan", tour, "-o", output, "--json").stdout)
    path, = (each["outputs"][0] for each in plan["steps"] if each["name"] == step)
    return pathlib.Path(path)


def run_blender_script(script, output, seed, **options):
    """Runs a script of blender_scripts/ as the pipeline does; a failure shows what Blender said."""
    blender = os.environ.get("FLANEUR_BLENDER") or shutil.which("blender")
    if blender is None:
        raise AssertionError("Blender not found: install the Debian package blender or set FLANEUR_BLENDER")
    settings = pathlib.Path(output).with_suffix(".settings.json")
    settings.write_text(json.dumps({"output": str(output), "seed": seed, "options": options}))
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1",
               "--python", str(SOURCE / "blender_scripts" / script), "--", str(settings)]
    # A distribution's Blender takes its modules from the first python3 on PATH: let that be the one beside it.
    environment = dict(os.environ, PATH=f"{pathlib.Path(blender).parent}:{os.environ['PATH']}", PYTHONDONTWRITEBYTECODE="1")
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if result.returncode != 0:
        raise AssertionError(f"{script} {options} failed:\n{result.stdout[-2000:]}{result.stderr[-2000:]}")


def packages(folder, *components):
    """The Debian packages of these components of the build, made in the folder: {name: path}."""
    if not has_tools("dpkg-shlibdeps"):
        raise unittest.SkipTest("no dpkg-shlibdeps: install the Debian package dpkg-dev")
    command = ["cpack", "--config", BIN.parent / "CPackConfig.cmake", "-B", folder, "-D", f"CPACK_COMPONENTS_ALL={';'.join(components)}"]
    result = subprocess.run(list(map(str, command)), check=False, capture_output=True, text=True)
    if result.returncode != 0:
        raise AssertionError(f"cpack failed:\n{result.stdout}{result.stderr}")
    return {path.name.split("_")[0]: path for path in pathlib.Path(folder).glob("*.deb")}


class ProgramTest(unittest.TestCase):
    """A test with a folder of its own, and the house rules of error reporting as assertions."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="flaneur_cli_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def assert_fails(self, result, *words, status=2):
        """One clear line on stderr that holds the words; the status; no crash."""
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        complaints = [line for line in result.stderr.splitlines() if "error" in line.lower()]
        self.assertEqual(len(complaints), 1, f"one error line wanted, got:\n{result.stderr}")
        for word in words:
            self.assertIn(str(word).lower(), complaints[0].lower())

    def assert_succeeds(self, result):
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def assert_valid(self, *packs):
        """The Khronos validator finds neither error nor warning, and the tour extension follows its schema."""
        if not (VALIDATOR / "node_modules").exists():
            self.fail(f"the validator is not installed: npm ci --prefix {VALIDATOR}")
        schema = SOURCE / "runtime/pack/FLANEUR_tour.schema.json"
        for pack in packs:
            gltf, _ = split_glb(pack)
            arguments = ["--schema", schema] if "FLANEUR_tour" in gltf.get("extensions", {}) else []
            command = ["node", VALIDATOR / "validate.js", *arguments, pack]
            result = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
