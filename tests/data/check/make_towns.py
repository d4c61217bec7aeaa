#!/usr/bin/env python3
"""Writes the towns of the check's cases: glTF with everything inside. Run here after a change: ./make_towns.py"""

import base64
import json
import math
import pathlib
import struct

FOLDER = pathlib.Path(__file__).parent
QUADS = {"south": (0, 1, 5, 4), "east": (1, 2, 6, 5), "north": (2, 3, 7, 6), "west": (3, 0, 4, 7),
         "top": (4, 5, 6, 7), "bottom": (3, 2, 1, 0)}


class Town:
    """Boxes on flat ground: metres, x east, y north, z up."""

    def __init__(self):
        self.nodes, self.vertices = [], []
        self.add("ground", {"flaneur_kind": "ground", "flaneur_ground": "square"},
                 [((0, 0, 0), (40, 0, 0), (40, 30, 0)), ((0, 0, 0), (40, 30, 0), (0, 30, 0))])

    def add(self, name, extras, triangles):
        self.nodes.append({"name": name, "extras": extras, "mesh": (len(self.vertices), 3 * len(triangles))})
        self.vertices += [(x, z, -y) for triangle in triangles for x, y, z in triangle]

    def boxes(self, name, boxes, kind="building", without=()):
        triangles = []
        for (x0, y0, z0), (x1, y1, z1) in boxes:
            plan = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            corners = [(x, y, z0) for x, y in plan] + [(x, y, z1) for x, y in plan]
            for side, (a, b, c, d) in QUADS.items():
                if side not in without:
                    a, b, c, d = (corners[i] for i in (a, b, c, d))
                    triangles += [(a, b, c), (a, c, d)]
        self.add(name, {"flaneur_kind": kind}, triangles)
        return self

    def gate(self, name, kind, at, ahead):
        half = math.atan2(ahead[0], -ahead[1]) / 2
        self.nodes.append({"name": name, "extras": {"flaneur_kind": kind}, "translation": [at[0], 0, -at[1]],
                           "rotation": [0, round(math.sin(half), 7), 0, round(math.cos(half), 7)]})
        return self

    def write(self, name):
        data = b"".join(struct.pack("<3f", *vertex) for vertex in self.vertices)
        accessors, meshes = [], []
        for node in self.nodes:
            if "mesh" not in node:
                continue
            first, count = node["mesh"]
            part = self.vertices[first:first + count]
            accessors.append({"bufferView": 0, "byteOffset": 12 * first, "componentType": 5126, "count": count,
                              "type": "VEC3", "min": [min(c) for c in zip(*part)], "max": [max(c) for c in zip(*part)]})
            node["mesh"] = len(meshes)
            meshes.append({"primitives": [{"attributes": {"POSITION": len(accessors) - 1}}]})
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(self.nodes)))}],
                "nodes": self.nodes, "meshes": meshes, "accessors": accessors,
                "bufferViews": [{"buffer": 0, "byteLength": len(data), "byteStride": 12, "target": 34962}],
                "buffers": [{"byteLength": len(data), "uri": uri}]}
        (FOLDER / name).write_text(json.dumps(gltf) + "\n", encoding="utf-8")


def street():
    """A house with a passage under it, a shed, a door and an exit."""
    town = Town()
    town.boxes("house", [((10, 10, -0.3), (13, 16, 8)), ((15, 10, -0.3), (18, 16, 8)), ((13, 10, 3), (15, 16, 8))])
    town.boxes("shed", [((26, 20, -0.3), (29, 23, 3))])
    return town.gate("door_house", "door", (11.5, 10), (0, -1)).gate("exit_west", "exit", (0.5, 15), (1, 0))


street().write("street.gltf")
Town().boxes("barn", [((10, 10, -0.3), (18, 16, 6))], without=("south",)).write("306.gltf")
street().boxes("cart", [((11, 9, 0), (12.5, 10, 1.5))], "other").write("601.gltf")
street().boxes("gate_tower", [((0, 14, -0.3), (2, 16, 9))]).write("602.gltf")
street().boxes("post", [((0.8, 15.25, 0), (1, 15.45, 1.5))], "other").write("603.gltf")
yard = [((20, 2, -0.3), (32, 2.3, 2.5)), ((20, 11.7, -0.3), (32, 12, 2.5)),
        ((20, 2.3, -0.3), (20.3, 11.7, 2.5)), ((31.7, 2.3, -0.3), (32, 11.7, 2.5))]
street().boxes("yard_wall", yard, "wall").gate("door_yard", "door", (26, 7), (0, -1)).write("604.gltf")
