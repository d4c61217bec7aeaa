"""A GLB's document and its binary data, to change them after Blender's exporter has written them."""

import json
import struct

import numpy as np

FLOAT32 = 5126
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}  # by numbers a row


def read(path):
    """The document as a dictionary, and the binary data as a bytearray."""
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), bytearray(data[20 + length + 8 :])


def write(path, document, binary):
    binary += bytes(-len(binary) % 4)
    document["buffers"] = [{"byteLength": len(binary)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def floats(document, binary, index):
    """An accessor's numbers, a row each, to read and to change."""
    accessor = document["accessors"][index]
    start = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    width = next(count for count, name in TYPES.items() if name == accessor["type"])
    return np.frombuffer(binary, np.float32, accessor["count"] * width, start).reshape(-1, width)


def add_floats(document, binary, rows, bounds=False):
    """Appends an accessor; returns its index."""
    rows = np.asarray(rows, np.float32).reshape(len(rows), -1)
    view = {"buffer": 0, "byteOffset": len(binary), "byteLength": rows.nbytes}
    accessor = {"bufferView": len(document["bufferViews"]), "componentType": FLOAT32, "count": len(rows),
                "type": TYPES[rows.shape[1]]}
    if bounds:
        accessor.update(min=rows.min(axis=0).tolist(), max=rows.max(axis=0).tolist())
    binary += rows.tobytes()
    document["bufferViews"].append(view)
    document["accessors"].append(accessor)
    return len(document["accessors"]) - 1
