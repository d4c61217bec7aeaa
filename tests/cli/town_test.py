"""The demo's town: what its script promises about nodes, tags, meshes and light.

python3 town_test.py [TOWN.glb]: of that file, else of the demo's own.
"""
import math
import pathlib
import struct
import sys
import unittest

from support import baked_demo, made_by, split_glb

KINDS = {"building", "wall", "tree", "lamp", "other", "ground", "door", "exit", "loiter", "work", "none"}
GROUNDS = {"carriageway", "pavement", "square", "grass"}
MEGABYTE = 1_000_000


def triangles(gltf, mesh):
    return sum(gltf["accessors"][p["indices"]]["count"] // 3 for p in gltf["meshes"][mesh]["primitives"])


def kind(node):
    return node.get("extras", {}).get("flaneur_kind")


def of_kind(gltf, *kinds):
    return [n for n in gltf["nodes"] if kind(n) in kinds]


def outward(node):
    """The way a door or exit opens, on the ground plane (x east, y north)."""
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    return 2 * (x * z + w * y), -(1 - 2 * (x * x + y * y))


def check_tags(gltf, fail):
    for node in gltf["nodes"]:
        name = node.get("name", "?")
        if kind(node) not in KINDS:
            fail("%s: flaneur_kind is %r" % (name, kind(node)))
        if kind(node) == "ground" and node["extras"].get("flaneur_ground") not in GROUNDS:
            fail("%s: flaneur_ground is %r" % (name, node["extras"].get("flaneur_ground")))
        if kind(node) in ("tree", "lamp") and not 0.02 < node["extras"].get("flaneur_radius_m", 0) < 1:
            fail("%s: no sensible flaneur_radius_m" % name)
        if kind(node) in ("door", "exit") and not 0.6 <= node["extras"].get("flaneur_width_m", 0) <= 12:
            fail("%s: no sensible flaneur_width_m" % name)
        if kind(node) in ("door", "exit", "loiter", "work") and "mesh" in node:
            fail("%s: should be an empty node" % name)
        if kind(node) not in ("door", "exit", "loiter", "work") and "mesh" not in node:
            fail("%s: has no mesh" % name)
    names = [n.get("name") for n in gltf["nodes"]]
    if len(set(names)) != len(names):
        fail("node names are not unique")


def check_counts(gltf, fail):
    names = [n.get("name", "") for n in gltf["nodes"]]

    def at_least(count, what, least):
        if count < least:
            fail("%d %s, at least %d expected" % (count, what, least))

    at_least(sum(n.startswith("house_") for n in names), "houses", 60)
    at_least(sum(n.startswith("market_stall_") for n in names), "market stalls", 6)
    for kinds, least in ((("door",), 30), (("exit",), 4), (("loiter",), 6), (("tree",), 30), (("lamp",), 10), (("wall",), 4)):
        at_least(len(of_kind(gltf, *kinds)), kinds[0] + " nodes", least)
    for name in ("church", "town_hall", "well"):
        if name not in names:
            fail("no node '%s'" % name)
    for ground in GROUNDS:
        if not any(n.get("extras", {}).get("flaneur_ground") == ground for n in gltf["nodes"]):
            fail("no ground of kind '%s'" % ground)


def check_meshes(gltf, size, fail):
    drawn = sum(triangles(gltf, n["mesh"]) for n in gltf["nodes"] if "mesh" in n)
    if not 150_000 <= drawn <= 385_000:
        fail("%d triangles drawn, 150000 to 385000 expected" % drawn)
    if size > 26 * MEGABYTE:
        fail("%.1f MB, at most 26 expected" % (size / MEGABYTE))
    if len(gltf["materials"]) > 16:
        fail("%d materials, at most 16 expected" % len(gltf["materials"]))
    for mesh in gltf["meshes"]:
        for primitive in mesh["primitives"]:
            for attribute in ("POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0"):
                if attribute not in primitive["attributes"]:
                    fail("mesh %s: no %s" % (mesh["name"], attribute))
            if primitive.get("mode", 4) != 4:
                fail("mesh %s: not triangles" % mesh["name"])
    if len(gltf.get("images", [])) < 10:
        fail("fewer than 10 textures")
    for image in gltf.get("images", []):
        if "uri" in image:
            fail("image %s is not embedded" % image.get("name"))


def check_light(gltf, binary, fail):
    """The baked light must vary: dark corners and open places in the houses' vertex colours."""
    for node in gltf["nodes"]:
        if not node.get("name", "").startswith("house_"):
            continue
        values = []
        for primitive in gltf["meshes"][node["mesh"]]["primitives"]:
            if gltf["materials"][primitive["material"]]["name"] != "plaster":
                continue
            accessor = gltf["accessors"][primitive["attributes"]["COLOR_0"]]
            if accessor["componentType"] != 5123:
                continue
            view = gltf["bufferViews"][accessor["bufferView"]]
            offset = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            parts = 4 if accessor["type"] == "VEC4" else 3
            raw = struct.unpack_from("<%dH" % (accessor["count"] * parts), binary, offset)
            values += raw[0::parts]
        if values and max(values) < 1.6 * min(values):
            fail("%s: vertex colours hardly vary, no light baked" % node["name"])


def check_places(gltf, fail):
    """Doors open outwards; exits open towards the middle of the town; all stand apart."""
    exits = of_kind(gltf, "exit")
    middle = [sum(n["translation"][i] for n in exits) / max(1, len(exits)) for i in (0, 2)]
    for node in exits:
        x, y = node["translation"][0] - middle[0], -(node["translation"][2] - middle[1])
        ox, oy = outward(node)
        if ox * x + oy * y > 0:
            fail("%s: does not open into the town" % node["name"])
    doors = of_kind(gltf, "door")
    for i, a in enumerate(doors):
        if abs(math.hypot(*outward(a)) - 1) > 1e-3:
            fail("%s: is tilted" % a["name"])
        for b in doors[:i]:
            if math.dist(a["translation"], b["translation"]) < 0.8:
                fail("%s and %s stand in each other" % (a["name"], b["name"]))


class Town(unittest.TestCase):
    path = None

    @classmethod
    def setUpClass(cls):
        if cls.path is None:
            baked_demo()
            cls.path = made_by("source:town")
        cls.gltf, cls.binary = split_glb(cls.path)

    def assert_kept(self, check, *arguments):
        broken = []
        check(self.gltf, *arguments, broken.append)
        self.assertEqual(broken, [])

    def test_tags(self):
        self.assert_kept(check_tags)

    def test_counts(self):
        self.assert_kept(check_counts)

    def test_meshes(self):
        self.assert_kept(check_meshes, pathlib.Path(self.path).stat().st_size)

    def test_light(self):
        self.assert_kept(check_light, self.binary)

    def test_places(self):
        self.assert_kept(check_places)


if __name__ == "__main__":
    files = [argument for argument in sys.argv[1:] if argument.endswith(".glb")]
    Town.path = files[0] if files else None
    unittest.main(argv=[argument for argument in sys.argv if argument not in files])
