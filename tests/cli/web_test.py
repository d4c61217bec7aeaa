"""A tour as a web site, from outside: what is in the folder, and what happens where it cannot be written."""
import gzip
import json
import re
import signal
import subprocess
import unittest
import urllib.error
import urllib.request

from support import BIN, SOURCE, ProgramTest, baked_demo, run

PAGE = SOURCE / "runtime/web/site"


def json_of(pack):
    content = pack.read_bytes()
    return json.loads(content[20:20 + int.from_bytes(content[12:16], "little")])


def described(pack):
    """What each use of an accessor says of it, bounds aside."""
    def use(index):
        return {key: value for key, value in pack["accessors"][index].items() if key not in ("min", "max")}
    for mesh in pack["meshes"]:
        for primitive in mesh["primitives"]:
            yield use(primitive["indices"]), {name: use(a) for name, a in primitive["attributes"].items()}
    for animation in pack["animations"]:
        yield [(use(s["input"]), use(s["output"])) for s in animation["samplers"]]
    for skin in pack["skins"]:
        yield use(skin["inverseBindMatrices"])


class Web(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.pack = baked_demo() / "wolfenbuettel.glb"

    def setUp(self):
        super().setUp()
        self.player = self.folder / "player"  # the page's own files, and something in the player's place
        self.player.mkdir()
        for file in PAGE.iterdir():
            (self.player / file.name).write_bytes(file.read_bytes())
        for name in ("player.js", "player.wasm"):
            (self.player / name).write_text("stands for " + name)
        self.site = self.folder / "site"

    def write(self, *arguments, pack=None):
        return run("flaneur", "web", pack or self.pack, "-o", self.site, "--player", self.player, *arguments)

    def files(self, folder):
        return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}

    def assert_refused(self, result, what):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(what, result.stderr)

    def test_pieces_put_together_are_a_tour_pack(self):
        self.assert_succeeds(self.write())
        site = json.loads((self.site / "tour.json").read_text())
        pack, filled = bytearray(site["bytes"]), bytearray(site["bytes"])
        for piece in site["pieces"]:
            content, at = gzip.decompress((self.site / piece["file"]).read_bytes()), 0
            for offset, length in piece["parts"]:
                self.assertFalse(any(filled[offset:offset + length]), "a byte is in two pieces")
                pack[offset:offset + length], filled[offset:offset + length] = content[at:at + length], b"1" * length
                at += length
            self.assertEqual(at, len(content))
        self.assertTrue(all(filled), "a byte is in no piece")
        joined = self.folder / "joined.glb"
        joined.write_bytes(pack)
        before, after = (json.loads(run("flaneur", "inspect", "--json", p).stdout) for p in (self.pack, joined))
        self.assertEqual(after, before)
        before, after = (json_of(p) for p in (self.pack, joined))
        self.assertEqual(list(described(after)), list(described(before)))
        told = [json.dumps(accessor) for accessor in after["accessors"]]
        self.assertEqual(len(told), len(set(told)), "accessors say the same")
        self.assertLess(len(pack), 0.6 * self.pack.stat().st_size)  # though its atlases are not packed
        first = sum((self.site / p["file"]).stat().st_size for p in site["pieces"][:site["first"]])
        self.assertLess(first, 4_000_000)

    def test_text_files_stand_there_compressed_too_and_the_page_asks_nobody_else(self):
        self.assert_succeeds(self.write())
        element, = (p.name for p in self.site.glob("flaneur-tour-*.js"))
        self.assertRegex(element, r"^flaneur-tour-\d+\.\d+\.\d+\.js$")
        page_files = [p.name for p in PAGE.glob("*.js") if p.name != "flaneur-tour.js"]
        for name in ("index.html", "page.css", "tour.json", element, *page_files):
            text = (self.site / name).read_bytes()
            self.assertEqual(gzip.decompress((self.site / (name + ".gz")).read_bytes()), text)
            self.assertTrue((self.site / (name + ".br")).exists())
            self.assertEqual(re.findall(rb"https?://", text), [], name)
        kept = set(re.findall(r"'([^']+\.(?:js|css))'", (self.site / "worker.js").read_text()))
        self.assertEqual(kept, {"page.css", *page_files} - {"worker.js"}, "without a network a file of the page is missing")
        page = (self.site / "index.html").read_text()
        self.assertIn("default-src 'none'", page)
        self.assertNotRegex(page, "'unsafe-(inline|eval)'|<style|<script>|@[A-Z]+@")

    def test_lines_for_other_pages_are_printed(self):
        result = self.write("--address", "https://museum.example/a&b")
        self.assert_succeeds(result)
        frame, script, element = [line for line in result.stdout.splitlines() if line.startswith("<")]
        self.assertRegex(frame, r'^<iframe src="https://museum\.example/a&amp;b/[^"]*" title="[^"]+" .*></iframe>$')
        name = re.fullmatch(r'<script src="https://museum\.example/a&amp;b/(flaneur-tour-[\d.]+\.js)"></script>', script)[1]
        self.assertTrue((self.site / name).is_file())
        self.assertRegex(element, r'^<flaneur-tour src="https://museum\.example/a&amp;b/"( lang="[a-z]+")? title="[^"]+"></flaneur-tour>$')

    def test_the_same_tour_gives_the_same_site(self):
        self.assert_succeeds(self.write())
        first = self.files(self.site)
        self.assert_succeeds(self.write())
        self.assertEqual(self.files(self.site), first)

    def test_what_was_there_is_lost_only_for_a_whole_new_site(self):
        self.site.mkdir()
        (self.site / "thesis.txt").write_text("mine")
        self.assert_refused(self.write(), "holds files that flaneur web has not written")
        self.assertEqual(self.files(self.site), {"thesis.txt": b"mine"})
        (self.site / "thesis.txt").unlink()
        self.assert_succeeds(self.write())
        before = self.files(self.site)
        broken = self.folder / "broken.glb"
        broken.write_bytes(self.pack.read_bytes()[:100_000])
        self.assert_refused(self.write(pack=broken), "broken.glb: is truncated")
        self.assertEqual(self.files(self.site), before)
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [], "something half-written stays")

    def test_what_is_missing_is_said_in_a_line(self):
        self.assert_refused(self.write(pack=self.folder / "none.glb"), "none.glb")
        (self.player / "player.wasm").unlink()
        self.assert_refused(self.write(), "player.wasm: the page's player is not there")
        self.assertFalse(self.site.exists())

    def test_serve_shows_the_site_and_nothing_beside_it(self):
        (self.folder / "secret.txt").write_text("secret")
        server = subprocess.Popen([BIN / "flaneur", "web", self.pack, "-o", self.site, "--player", self.player, "--serve", "0"],
                                  stdout=subprocess.PIPE, text=True)
        try:
            address = ""
            while not address:
                line = server.stdout.readline()
                self.assertTrue(line, "it ended before it said where it is")
                address = "".join(re.findall(r"http://127\.0\.0\.1:\d+/", line))
            with urllib.request.urlopen(address) as answer:
                self.assertEqual(answer.read(), (self.site / "index.html").read_bytes())
                self.assertEqual(answer.headers["Content-Type"], "text/html; charset=utf-8")
            for path in ("../secret.txt", "%2e%2e/secret.txt", "none.js"):
                with self.assertRaises(urllib.error.HTTPError) as refused:
                    urllib.request.urlopen(address + path)
                self.assertEqual(refused.exception.code, 404)
                refused.exception.close()
        finally:
            server.send_signal(signal.SIGINT)
            server.wait(timeout=20)
            server.stdout.close()


if __name__ == "__main__":
    unittest.main()
