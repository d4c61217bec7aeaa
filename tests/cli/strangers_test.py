"""A stranger's tour: scripts run only where they may, and then where they can do no harm; no files from elsewhere."""
import json
import os
import pathlib
import pty
import subprocess
import unittest

from small_tour import SmallTourTest
from scenes import write_png
from support import BIN, has_tools

WRITES = """
import json, os, shutil, socket, sys
settings = json.load(open(sys.argv[-1]))
found = []
for what, path in (("read", {secret!r}), ("write", {outside!r})):
    try:
        open(path, "r" if what == "read" else "w").close()
        found.append(what)
    except OSError:
        pass
try:
    socket.create_connection(("127.0.0.1", {port}), timeout=2).close()
    found.append("network")
except OSError:
    pass
if found:
    raise ValueError("could " + " ".join(found))
shutil.copy({town!r}, settings["output"])
"""


class Scripts(SmallTourTest):
    def setUp(self):
        super().setUp()
        self.script = self.tour.parent / "build.py"
        self.home = self.folder / "home"
        self.home.mkdir()
        self.ran = self.tour.parent / "ran"
        self.script.write_text(f"open({str(self.ran)!r}, 'w').close()\n")
        self.tour.write_text(self.tour.read_text().replace('"town.glb"', '"build.py"'))

    def environment(self, **variables):
        return dict(super().environment(**variables), HOME=str(self.home), XDG_CONFIG_HOME=str(self.home / "config"))

    def test_none_runs_without_a_word(self):
        result = self.bake()
        self.assert_fails(result, "tour.toml:5", "town.file", "build.py", "--allow-scripts")
        self.assertFalse(self.ran.exists())
        self.assertFalse(self.out.exists())

    def ask(self, answer):
        """A bake on a terminal, where somebody answers."""
        owner, terminal = pty.openpty()
        command = [str(BIN / "flaneur"), "bake", str(self.tour), "-o", str(self.out)]
        bake = subprocess.Popen(command, stdin=terminal, stderr=terminal, stdout=subprocess.DEVNULL, env=self.environment())
        os.close(terminal)
        os.write(owner, answer)
        text = b""
        while True:
            try:
                text += os.read(owner, 1000)
            except OSError:
                break
            if bake.poll() is not None and not text:
                break
        os.close(owner)
        return bake.wait(timeout=60), text.decode()

    def test_a_terminal_is_asked_once(self):
        status, text = self.ask(b"n\n")
        self.assertIn("Trust everything in", text)
        self.assertEqual(status, 2)
        status, text = self.ask(b"y\n")
        self.assertNotIn("--allow-scripts", text)
        trusted = (self.home / "config/flaneur/trusted_folders").read_text()
        self.assertEqual(trusted, f"{self.tour.parent.resolve()}\n")
        status, text = self.ask(b"")
        self.assertNotIn("Trust everything in", text)

    def test_it_sees_nothing_but_the_tour(self):
        if not has_tools("bwrap") or subprocess.run(["bwrap", "--ro-bind", "/", "/", "--unshare-all", "true"], check=False).returncode:
            self.skipTest("bubblewrap is not installed or may not work here: install the Debian package bubblewrap")
        secret = self.home / "secret"
        secret.write_text("mine")
        with subprocess.Popen(["python3", "-u", "-c", "import socket\ns = socket.create_server(('127.0.0.1', 0))\nprint(s.getsockname()[1])\nwhile True: s.accept()"],
                              stdout=subprocess.PIPE, text=True) as server:
            try:
                port = int(server.stdout.readline())
                self.script.write_text(WRITES.format(secret=str(secret), outside=str(self.tour.parent / "more"), port=port,
                                                     town=str(self.tour.parent / "town.glb")))
                self.assert_succeeds(self.bake("--allow-scripts"))
            finally:
                server.kill()


class FilesElsewhere(SmallTourTest):
    def elsewhere(self):
        there = self.folder / "elsewhere"
        there.mkdir()
        (self.tour.parent / "plain.glb").rename(there / "plain.glb")
        return there / "plain.glb"

    def test_named_by_the_tour(self):
        for path in ("../elsewhere/plain.glb", str(self.elsewhere())):
            with self.subTest(path):
                self.write_tour()
                self.tour.write_text(self.tour.read_text().replace('"plain.glb"', f'"{path}"'))
                self.assert_fails(self.bake(), "tour.toml:", "avatar.file", "outside the tour's folder", "--allow-outside")
                self.assert_succeeds(self.bake("--allow-outside"))

    def test_by_a_link(self):
        (self.tour.parent / "plain.glb").symlink_to(self.elsewhere())
        self.assert_fails(self.bake(), "outside the tour's folder")

    def test_named_by_a_model(self):
        """A picture that the house's glTF takes from elsewhere must not get into the pack."""
        secret = self.folder / "secret.png"
        write_png(secret, 1, 2, 3)
        for uri in ("../secret.png", str(secret)):
            with self.subTest(uri):
                gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
                        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
                        "textures": [{"source": 0}], "images": [{"uri": uri}],
                        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                                      {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}],
                        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
                        "buffers": [{"byteLength": 48, "uri": "house.bin"}]}
                (self.tour.parent / "house.gltf").write_text(json.dumps(gltf))
                pathlib.Path(self.tour.parent / "house.bin").write_bytes(b"\0" * 36 + bytes([0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]))
                self.write_tour('[[town.part]]\nfile = "house.gltf"\n')
                self.assert_fails(self.bake(), "secret.png", "outside the tour's folder", "--allow-outside")


if __name__ == "__main__":
    unittest.main()
