"""Tiny glTF files made by hand: a box town, and what is wrong with a file."""
import math
import struct

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


def write_town(path, parts):
    """Writes a GLB of named parts: (name, extras or None, positions, indices)."""
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(parts)))}],
            "nodes": [], "meshes": [], "accessors": [], "bufferViews": []}
    binary = b""
    for name, extras, positions, indices in parts:
        mesh = len(gltf["meshes"])
        node = {"name": name, "mesh": mesh}
        if extras:
            node["extras"] = extras
        gltf["nodes"].append(node)
        first = len(gltf["accessors"])
        for values, fmt, component, kind in (([c for p in positions for c in p], "f", 5126, "VEC3"),
                                             (indices, "I", 5125, "SCALAR")):
            data = struct.pack(f"<{len(values)}{fmt}", *values)
            gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
            accessor = {"bufferView": len(gltf["bufferViews"]) - 1, "componentType": component,
                        "count": len(values) // (3 if kind == "VEC3" else 1), "type": kind}
            if kind == "VEC3":
                finite = [[p[i] for p in positions if math.isfinite(p[i])] or [0.0] for i in range(3)]
                accessor["min"], accessor["max"] = [min(v) for v in finite], [max(v) for v in finite]
            gltf["accessors"].append(accessor)
            binary += data
        gltf["meshes"].append({"primitives": [{"attributes": {"POSITION": first}, "indices": first + 1}]})
    gltf["buffers"] = [{"byteLength": len(binary)}]
    write_glb(path, gltf, binary)


def write_box_town(path, houses=4, spoil=None):
    """A square ground with a row of houses; `spoil` may change a house's positions."""
    parts = [("ground_square", {"flaneur_kind": "ground", "flaneur_ground": "square"}, *quad(30.0))]
    for i in range(houses):
        positions, indices = box(-20.0 + 10 * i, -4.0, 6.0, 8.0, 7.0)
        if spoil and i == houses - 1:
            positions = spoil(positions)
        parts.append((f"house_{i + 1}", {"flaneur_kind": "building"}, positions, indices))
    write_town(path, parts)
