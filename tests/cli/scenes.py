"""Tiny glTF files made by hand: a box town, a box person who walks, and what is wrong with a file."""
import json
import math
import pathlib
import struct
import zlib

from support import write_glb

_BOX_FACES = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4),
              (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]


def box(x, z, width, depth, height):
    """Positions and indices of a box that stands on the ground (glTF axes, Y up)."""
    corners = [(x, z), (x, z + depth), (x + width, z + depth), (x + width, z)]
    positions = [(a, y, b) for y in (0.0, height) for a, b in corners]
    return positions, [i for face in _BOX_FACES for i in face]


def quad(half):
    """A flat square ground, facing up."""
    positions = [(-half, 0.0, -half), (-half, 0.0, half), (half, 0.0, half), (half, 0.0, -half)]
    return positions, [0, 1, 2, 0, 2, 3]


class _Pieces:
    """A glTF under construction: its JSON and its binary chunk."""

    def __init__(self):
        self.binary = b""
        self.gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "accessors": [], "bufferViews": []}

    def accessor(self, rows, fmt="f", component=5126, bounds=False):
        """Adds rows of numbers; the index of their accessor."""
        width = len(rows[0])
        data = struct.pack(f"<{len(rows) * width}{fmt}", *(value for row in rows for value in row))
        self.gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        kind = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 2: "VEC2", 16: "MAT4"}[width]
        accessor = {"bufferView": len(self.gltf["bufferViews"]) - 1, "componentType": component, "count": len(rows),
                    "type": kind}
        if bounds:
            finite = [[row[i] for row in rows if math.isfinite(row[i])] or [0.0] for i in range(width)]
            accessor["min"], accessor["max"] = [min(v) for v in finite], [max(v) for v in finite]
        self.gltf["accessors"].append(accessor)
        self.binary += data + b"\0" * (-len(data) % 4)
        return len(self.gltf["accessors"]) - 1

    def finished(self):
        self.gltf["buffers"] = [{"byteLength": len(self.binary)}]
        return self.gltf


def write_png(path, red, green, blue):
    """A picture of one colour, 4 by 4 pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + bytes((red, green, blue)) * 4) * 4
    header = struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def _person():
    """Three boxes, each on its own joint: a trunk, and two legs that swing about the hip in the clip `walk`."""
    pieces = _Pieces()
    positions, indices, joints = [], [], []
    for joint, (x, width, low, high) in enumerate(((-0.2, 0.4, 0.9, 1.75), (-0.2, 0.15, 0.0, 0.9), (0.05, 0.15, 0.0, 0.9))):
        corners, faces = box(x, -0.1, width, 0.2, high - low)
        indices += [(i + len(positions),) for i in faces]
        positions += [(a, b + low, c) for a, b, c in corners]
        joints += [(joint, 0, 0, 0)] * len(corners)
    primitive = {"attributes": {"POSITION": pieces.accessor(positions, bounds=True),
                                "TEXCOORD_0": pieces.accessor([(0.5, 0.5)] * len(positions)),
                                "JOINTS_0": pieces.accessor(joints, "B", 5121),
                                "WEIGHTS_0": pieces.accessor([(1.0, 0.0, 0.0, 0.0)] * len(positions))},
                 "indices": pieces.accessor(indices, "I", 5125), "material": 0}
    bind = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.9, 0, 1)] * 3
    times = pieces.accessor([(k / 4,) for k in range(5)], bounds=True)
    samplers, channels = [], []
    for leg, sign in ((1, 1), (2, -1)):
        swing = [sign * 0.25 * math.sin(k * math.pi / 2) for k in range(5)]
        turns = pieces.accessor([(math.sin(a), 0.0, 0.0, math.cos(a)) for a in swing])
        channels.append({"sampler": len(samplers), "target": {"node": leg, "path": "rotation"}})
        samplers.append({"input": times, "output": turns})
    gltf = pieces.finished()
    gltf.update({
        "nodes": [{"name": "hips", "translation": [0, 0.9, 0], "children": [1, 2]}, {"name": "leg_l"}, {"name": "leg_r"},
                  {"name": "body", "mesh": 0, "skin": 0}],
        "scenes": [{"nodes": [0, 3]}], "meshes": [{"primitives": [primitive]}],
        "skins": [{"joints": [0, 1, 2], "inverseBindMatrices": pieces.accessor(bind)}],
        "materials": [{"name": "cloth"}],
        "animations": [{"name": "walk", "samplers": samplers, "channels": channels}]})
    return pieces.finished(), pieces.binary


def write_person(path):
    """A GLB of the box person."""
    gltf, binary = _person()
    write_glb(path, gltf, binary)


def write_textured_person(path, picture):
    """The box person as a .gltf with its buffer and picture beside it; `picture` is the name of a PNG file there."""
    gltf, binary = _person()
    path = pathlib.Path(path)
    gltf["buffers"][0]["uri"] = path.stem + ".bin"
    gltf["images"] = [{"uri": picture}]
    gltf["textures"] = [{"source": 0}]
    gltf["materials"][0]["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
    path.with_suffix(".bin").write_bytes(binary)
    path.write_text(json.dumps(gltf))


def write_town(path, parts):
    """Writes a GLB of named parts: (name, extras or None, positions, indices)."""
    pieces = _Pieces()
    gltf = pieces.gltf
    for number, (name, extras, positions, indices) in enumerate(parts):
        node = {"name": name, "mesh": number}
        if extras:
            node["extras"] = extras
        gltf["nodes"].append(node)
        primitive = {"attributes": {"POSITION": pieces.accessor(positions, bounds=True)},
                     "indices": pieces.accessor([(i,) for i in indices], "I", 5125)}
        gltf["meshes"].append({"primitives": [primitive]})
        gltf["scenes"][0]["nodes"].append(number)
    write_glb(path, pieces.finished(), pieces.binary)


def write_box_town(path, houses=4, spoil=None):
    """A square ground with a row of houses; `spoil` may change a house's positions."""
    parts = [("ground_square", {"flaneur_kind": "ground", "flaneur_ground": "square"}, *quad(30.0))]
    for i in range(houses):
        positions, indices = box(-20.0 + 10 * i, -4.0, 6.0, 8.0, 7.0)
        if spoil and i == houses - 1:
            positions = spoil(positions)
        parts.append((f"house_{i + 1}", {"flaneur_kind": "building"}, positions, indices))
    write_town(path, parts)


def cities(path, at, system, scale=(1.0, 1.0), turned=False):
    """A CityJSON town of six houses in two rows, 40 units apart, each of its own size; turned: not along the axes."""
    vertices, objects = [], {}
    for k in range(6):
        w, d, x0, y0 = 7 + 0.5 * k, 9 - 0.7 * k, 40.0 * (k % 3), 30.0 * (k // 3)
        if not turned and k % 3 == 2:
            w, d = 7 + 0.5 * (k - 2), 9 - 0.7 * (k - 2)  # as the first of its row
        first = len(vertices)
        for z in (0, 6):
            for u, v in ((0, 0), (w, 0), (w, d), (0, d)):
                c, s = (0.8, 0.6) if turned else (1, 0)
                x, y = x0 + c * u - s * v, y0 + s * u + c * v
                x, y = (y, x) if scale[0] < scale[1] < 1 else (x, y)  # latitude first
                vertices.append([at[0] + scale[0] * x, at[1] + scale[1] * y, z])
        faces = [[[0, 3, 2, 1]], [[4, 5, 6, 7]]] + [[[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i]] for i in range(4)]
        solid = {"type": "Solid", "lod": "2", "boundaries": [[[[first + i for i in ring] for ring in face] for face in faces]]}
        objects[f"house_{k}"] = {"type": "Building", "geometry": [solid]}
    path.write_text(json.dumps({
        "type": "CityJSON", "version": "2.0", "metadata": {"referenceSystem": system} if system else {}, "vertices": vertices,
        "CityObjects": objects}))
    return path
