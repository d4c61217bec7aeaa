"""Blender's decimate modifier on a skinned glTF binary: weld, collapse, write the same skin again.

blender --background --factory-startup --python-exit-code 1 --python decimate_in_blender.py -- SETTINGS.json
The settings: input, outputs (a list of ratio and path), weld_m.
"""
import json
import pathlib
import struct
import sys

import bmesh
import bpy
import numpy

if not hasattr(numpy, "bool"):  # Blender 3.4's importer uses what numpy 1.24 dropped
    numpy.bool = bool


def split_glb(path):
    data = pathlib.Path(path).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[20 + length + 8:]


def write_glb(path, gltf, binary):
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    total = 28 + len(text) + len(binary)
    pathlib.Path(path).write_bytes(
        struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
        + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def import_welded(path, weld_m):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    # The importer makes a sphere for bones to be drawn as.
    skinned = [o for o in bpy.data.objects if o.type == "MESH" and len(o.vertex_groups) > 0]
    for item in skinned:
        item.modifiers.clear()
        edited = bmesh.new()
        edited.from_mesh(item.data)
        bmesh.ops.remove_doubles(edited, verts=edited.verts, dist=weld_m)
        edited.to_mesh(item.data)
        edited.free()
    return skinned


def decimated(item, ratio):
    """Positions (glTF axes), joint names and weights by vertex, triangles."""
    modifier = item.modifiers.new("decimate", "DECIMATE")
    modifier.ratio = ratio
    modifier.use_collapse_triangulate = True
    mesh = item.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    mesh.calc_loop_triangles()
    names = [group.name for group in item.vertex_groups]
    positions = [(v.co.x, v.co.z, -v.co.y) for v in mesh.vertices]
    weights = [sorted(((g.weight, names[g.group]) for g in v.groups), reverse=True)[:4]
               for v in mesh.vertices]
    triangles = [tuple(t.vertices) for t in mesh.loop_triangles]
    item.modifiers.remove(modifier)
    return positions, weights, triangles


def write_level(source, path, positions, weights, triangles):
    gltf, binary = split_glb(source)
    skin = gltf["skins"][0]
    index = {gltf["nodes"][j]["name"]: i for i, j in enumerate(skin["joints"])}
    joints = numpy.zeros((len(positions), 4), numpy.uint16)
    shares = numpy.zeros((len(positions), 4), numpy.float32)
    for v, groups in enumerate(weights):
        for i, (weight, name) in enumerate(groups):
            joints[v, i], shares[v, i] = index[name], weight
    shares /= numpy.maximum(shares.sum(axis=1, keepdims=True), 1e-9)
    points = numpy.array(positions, numpy.float32)
    arrays = [(points, 5126, "VEC3"), (joints, 5123, "VEC4"), (shares, 5126, "VEC4"),
              (numpy.array(triangles, numpy.uint32).ravel(), 5125, "SCALAR")]
    first = len(gltf["accessors"])
    for array, component, kind in arrays:
        binary += b"\0" * (-len(binary) % 4)
        view = {"buffer": 0, "byteOffset": len(binary), "byteLength": array.nbytes}
        gltf["bufferViews"].append(view)
        binary += array.tobytes()
        gltf["accessors"].append({"bufferView": len(gltf["bufferViews"]) - 1, "type": kind,
                                  "componentType": component, "count": len(array)})
    gltf["accessors"][first].update(min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist())
    attributes = {"POSITION": first, "JOINTS_0": first + 1, "WEIGHTS_0": first + 2}
    gltf["meshes"] = [{"primitives": [{"attributes": attributes, "indices": first + 3}]}]
    gltf["buffers"] = [{"byteLength": len(binary)}]
    write_glb(path, gltf, binary)


def main():
    settings = json.loads(pathlib.Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    items = import_welded(settings["input"], settings["weld_m"])
    for ratio, path in settings["outputs"]:
        positions, weights, triangles = [], [], []
        for item in items:
            more, shares, corners = decimated(item, ratio)
            triangles += [tuple(len(positions) + i for i in t) for t in corners]
            positions += more
            weights += shares
        write_level(settings["input"], path, positions, weights, triangles)


main()
