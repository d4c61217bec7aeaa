"""Renders all views of a person's impostor atlas: every cell one instance, each where it stands.

Run as every script here (see common/settings.py). The settings:

    output          folder (there already) for band_0000.exr, band_0001.exr, ... from the top
    seed            another sample pattern
    geometry        folder with the binary arrays named below
    vertices, triangles, frames     lengths of these arrays
    materials       list of {"texture": file or "", "mask", "cutoff", "double_sided", "tints": [1 or 0, ...]}
    tint_regions    whether to write the layer tints: which of three tints may dye the surface
    directions      around the person
    cells           list of {"frame", "direction", "elevation_deg", "origin_px": [x, y]}: where in
                    the atlas the point between the feet is, from the upper left corner
    width_px, height_px, texel_m    of the atlas
    band_px         rows rendered at once
    options         samples (a pixel), default 16

Arrays, little-endian, without header, axes as in glTF (Y up, the person faces +Z):

    positions.f32 frames x vertices x 3     normals.f32, motions.f32, bends.f32 likewise
    uvs.f32 vertices x 2 (v downward)       colors.f32 vertices x 4 (sRGB, straight alpha)
    indices.u32 triangles x 3               materials.u32 triangles

Each EXR holds float layers: means over all samples of a pixel, so that every value is premultiplied
with the coverage. They are albedo (sRGB), normal, motion and bend (avatar's axes), depth (metres
from the axis towards the camera), coverage and, where wanted, tints (by channel a tint).
"""

import math
import os
import sys

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
from common.settings import fail, load_settings  # noqa: E402

REQUIRED = ("output", "seed", "geometry", "vertices", "triangles", "frames", "materials",
            "directions", "cells", "width_px", "height_px", "texel_m", "band_px",
            "tint_regions")
VECTORS = ("normal", "motion", "bend")  # of a vertex; they differ from frame to frame
COLOR_LAYERS = ("albedo", "tints") + VECTORS
VALUE_LAYERS = ("depth", "coverage")
PATTERN = 32  # of 40 patterns of 16 samples the one that comes nearest to 64 samples on edges


def read_array(settings, name, kind, shape):
    path = os.path.join(settings["geometry"], name)
    try:
        values = np.fromfile(path, dtype=np.dtype(kind).newbyteorder("<"))
    except OSError as error:
        fail("%s: %s" % (path, error.strerror or error))
    if values.size != np.prod(shape):
        fail("%s: holds %d values, expected %d" % (path, values.size, np.prod(shape)))
    return values.reshape(shape)


def read_geometry(settings):
    """The arrays by name; positions in Blender's axes, normals, motions and bends in glTF's."""
    frames, vertices, triangles = settings["frames"], settings["vertices"], settings["triangles"]
    arrays = {
        "positions": read_array(settings, "positions.f32", "f4", (frames, vertices, 3)),
        "normals": read_array(settings, "normals.f32", "f4", (frames, vertices, 3)),
        "motions": read_array(settings, "motions.f32", "f4", (frames, vertices, 3)),
        "bends": read_array(settings, "bends.f32", "f4", (frames, vertices, 3)),
        "uvs": read_array(settings, "uvs.f32", "f4", (vertices, 2)),
        "colors": read_array(settings, "colors.f32", "f4", (vertices, 4)),
        "indices": read_array(settings, "indices.u32", "u4", (triangles, 3)),
        "materials": read_array(settings, "materials.u32", "u4", (triangles,)),
    }
    x, y, z = np.moveaxis(arrays["positions"], 2, 0)
    arrays["positions"] = np.stack((x, -z, y), axis=2)
    return arrays


class Nodes:
    """A material's shader nodes, made by calls that read like the formula they stand for."""

    def __init__(self, tree):
        self.tree = tree

    def _put(self, value, socket):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value

    def node(self, kind, **properties):
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        return node

    def attribute(self, name):
        return self.node("ShaderNodeAttribute", attribute_type="GEOMETRY", attribute_name=name)

    def math(self, operation, a, b):
        node = self.node("ShaderNodeMath", operation=operation)
        self._put(a, node.inputs[0])
        self._put(b, node.inputs[1])
        return node.outputs[0]

    def multiply(self, a, b):
        """Two vectors, component by component."""
        node = self.node("ShaderNodeVectorMath", operation="MULTIPLY")
        self._put(a, node.inputs[0])
        self._put(b, node.inputs[1])
        return node.outputs["Vector"]

    def scale(self, vector, factor):
        node = self.node("ShaderNodeVectorMath", operation="SCALE")
        self._put(vector, node.inputs[0])
        self._put(factor, node.inputs["Scale"])
        return node.outputs["Vector"]

    def write_layer(self, name, value):
        node = self.node("ShaderNodeOutputAOV", name=name)
        if hasattr(node, "aov_name"):  # from Blender 4.2 on; before, the node's own name counts.
            node.aov_name = name
        self._put(value, node.inputs["Color" if name in COLOR_LAYERS else "Value"])


def load_texture(path):
    try:
        image = bpy.data.images.load(path)
    except RuntimeError as error:
        fail("%s: cannot read the texture: %s" % (path, error))
    if not image.has_data and not image.size[0]:
        fail("%s: cannot read the texture" % path)
    image.colorspace_settings.name = "Non-Color"  # stays as it is stored, which is how players multiply and filter it
    image.alpha_mode = "CHANNEL_PACKED"  # colour stays what the file says where alpha is 0.
    return image


def base_color(nodes, texture):
    """Colour as it is stored and alpha: the vertex colour times the texture."""
    vertex = nodes.attribute("person_color")
    if not texture:
        return vertex.outputs["Color"], vertex.outputs["Alpha"]
    image = nodes.node("ShaderNodeTexImage", image=load_texture(texture))
    nodes.tree.links.new(nodes.attribute("person_uv").outputs["Vector"], image.inputs["Vector"])
    return (nodes.multiply(vertex.outputs["Color"], image.outputs["Color"]),
            nodes.math("MULTIPLY", vertex.outputs["Alpha"], image.outputs["Alpha"]))


def visibility(nodes, description, alpha, backfacing):
    """1 where a sample sees the surface, 0 in holes and behind a single-sided surface; None: 1."""
    visible = None
    if description["mask"]:
        hole = nodes.math("LESS_THAN", alpha, description["cutoff"])
        visible = nodes.math("SUBTRACT", 1.0, hole)
    if not description["double_sided"]:
        front = nodes.math("SUBTRACT", 1.0, backfacing)
        visible = front if visible is None else nodes.math("MULTIPLY", visible, front)
    return visible


def constant(nodes, vector):
    node = nodes.node("ShaderNodeCombineXYZ")
    for socket, value in zip(node.inputs, vector):
        socket.default_value = value
    return node.outputs[0]


def make_material(description, tint_regions):
    """Writes the layers at the first visible surface.

    A layer is written at every surface a sample meets, also where the sample then passes through,
    so all are multiplied with the visibility. The surface glows, which ends a path at once; under a
    glow of strength 0 Cycles leaves the layers out. It is no lamp that others would look for.
    """
    material = bpy.data.materials.new("impostor")
    if hasattr(material.cycles, "sample_as_light"):  # up to Blender 3.4
        material.cycles.sample_as_light = False
    else:
        material.cycles.emission_sampling = "NONE"
    material.use_nodes = True
    material.node_tree.nodes.clear()
    nodes = Nodes(material.node_tree)
    geometry = nodes.node("ShaderNodeNewGeometry")
    color, alpha = base_color(nodes, description["texture"])
    visible = visibility(nodes, description, alpha, geometry.outputs["Backfacing"])
    depth = nodes.scale(geometry.outputs["Position"], -1.0)  # the camera looks along +y.
    split = nodes.node("ShaderNodeSeparateXYZ")
    nodes.tree.links.new(depth, split.inputs[0])
    side = nodes.math("SUBTRACT", 1.0, nodes.math("MULTIPLY", geometry.outputs["Backfacing"], 2.0))
    normal = nodes.scale(nodes.attribute("person_normal").outputs["Vector"], side)
    layers = {"albedo": color, "normal": normal}
    if tint_regions:
        layers["tints"] = constant(nodes, description["tints"])
    for name in ("motion", "bend"):
        layers[name] = nodes.attribute("person_" + name).outputs["Vector"]
    for name, vector in layers.items():
        nodes.write_layer(name, vector if visible is None else nodes.scale(vector, visible))
    shader = nodes.node("ShaderNodeEmission").outputs["Emission"]
    if visible is None:
        nodes.write_layer("depth", split.outputs["Y"])
        nodes.write_layer("coverage", 1.0)
    else:
        nodes.write_layer("depth", nodes.math("MULTIPLY", split.outputs["Y"], visible))
        nodes.write_layer("coverage", visible)
        mix = nodes.node("ShaderNodeMixShader")
        nodes.tree.links.new(visible, mix.inputs[0])
        nodes.tree.links.new(nodes.node("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        nodes.tree.links.new(shader, mix.inputs[2])
        shader = mix.outputs[0]
    output = nodes.node("ShaderNodeOutputMaterial")
    nodes.tree.links.new(shader, output.inputs["Surface"])
    return material


def make_mesh(arrays, materials):
    """The person in the first frame. The attributes' names are none that Blender reserves."""
    mesh = bpy.data.meshes.new("impostor")
    mesh.from_pydata(arrays["positions"][0].tolist(), [], arrays["indices"].tolist())
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", arrays["materials"].astype(np.int32))
    uvs = arrays["uvs"]
    uvs = np.stack((uvs[:, 0], 1 - uvs[:, 1], np.zeros(len(uvs))), axis=1).astype(np.float32)
    uv = mesh.attributes.new("person_uv", "FLOAT_VECTOR", "POINT")
    uv.data.foreach_set("vector", uvs.ravel())
    color = mesh.attributes.new("person_color", "FLOAT_COLOR", "POINT")
    color.data.foreach_set("color", arrays["colors"].ravel())
    for name in VECTORS:
        mesh.attributes.new("person_" + name, "FLOAT_VECTOR", "POINT")
    return mesh


def pose(mesh, arrays, frame):
    mesh.vertices.foreach_set("co", arrays["positions"][frame].astype(np.float32).ravel())
    for name in VECTORS:
        mesh.attributes["person_" + name].data.foreach_set("vector", arrays[name + "s"][frame].ravel())
    mesh.update()


def make_frames(arrays, materials, frames):
    """A mesh a frame."""
    first = make_mesh(arrays, materials)
    meshes = [first] + [first.copy() for _ in range(1, frames)]
    for frame, mesh in enumerate(meshes):
        pose(mesh, arrays, frame)
    return meshes


def place_views(settings, meshes):
    """One instance a cell, turned as the cell asks before the camera, which looks along +y."""
    texel, middle = settings["texel_m"], (settings["width_px"] / 2, settings["height_px"] / 2)
    for cell in settings["cells"]:
        x = (cell["origin_px"][0] - middle[0]) * texel
        z = (middle[1] - cell["origin_px"][1]) * texel
        turn = -2 * math.pi * cell["direction"] / settings["directions"]
        view = bpy.data.objects.new("view", meshes[cell["frame"]])
        view.matrix_world = (Matrix.Translation((x, 0, z)) @
                             Matrix.Rotation(math.radians(cell["elevation_deg"]), 4, "X") @
                             Matrix.Rotation(turn, 4, "Z"))
        bpy.context.scene.collection.objects.link(view)


def place_camera(settings, scene, distance):
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.sensor_fit = "HORIZONTAL"
    camera.ortho_scale = settings["width_px"] * settings["texel_m"]
    camera.clip_start, camera.clip_end = 0.01 * distance, 3 * distance
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(scene.camera)


def show_band(settings, scene, distance, first):
    """Rows from `first` on; returns how many."""
    rows = min(settings["band_px"], settings["height_px"] - first)
    z = (settings["height_px"] / 2 - first - rows / 2) * settings["texel_m"]
    scene.camera.matrix_world = (Matrix.Translation((0, -distance, z)) @
                                 Matrix.Rotation(math.pi / 2, 4, "X"))
    scene.render.resolution_y = rows
    return rows


def set_up_cycles(settings, scene):
    """Exact, repeatable samples: a box filter, no adaptive sampling, no denoising, no light."""
    scene.render.engine = "CYCLES"
    scene.world = None
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = settings["options"]["samples"]
    cycles.seed = (PATTERN + settings["seed"]) & 0x7FFFFFFF
    cycles.scrambling_distance = 0  # one good pattern in every pixel instead of many middling ones
    cycles.pixel_filter_type = "BOX"
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.use_auto_tile = False
    cycles.max_bounces = 0
    cycles.transparent_max_bounces = 64
    scene.render.film_transparent = True
    scene.render.use_compositing = False
    scene.render.use_sequencer = False
    scene.view_settings.view_transform = "Raw"


def set_up_output(settings, scene):
    render = scene.render
    render.resolution_x = settings["width_px"]
    render.resolution_percentage = 100
    render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "NONE"  # read once, then gone
    layer = scene.view_layers[0]
    layer.use_pass_z = False
    for names, kind in ((COLOR_LAYERS, "COLOR"), (VALUE_LAYERS, "VALUE")):
        for name in names:
            if name == "tints" and not settings["tint_regions"]:
                continue
            aov = layer.aovs.add()
            aov.name, aov.type = name, kind


def main():
    settings = load_settings(required=REQUIRED, options={"samples": 16})
    scene = bpy.context.scene
    for each in list(scene.collection.all_objects):  # what a new file holds
        bpy.data.objects.remove(each)
    arrays = read_geometry(settings)
    materials = [make_material(each, settings["tint_regions"]) for each in settings["materials"]]
    place_views(settings, make_frames(arrays, materials, settings["frames"]))
    distance = 2 * float(np.abs(arrays["positions"]).max()) + 1
    place_camera(settings, scene, distance)
    set_up_cycles(settings, scene)
    set_up_output(settings, scene)
    first = band = 0
    while first < settings["height_px"]:
        start = first
        first += show_band(settings, scene, distance, first)
        print("flaneur: progress %.4f %.4f" % (start / settings["height_px"], first / settings["height_px"]), flush=True)
        scene.render.filepath = os.path.join(settings["output"], "band_%04d.exr" % band)
        bpy.ops.render.render(write_still=True)
        band += 1


if __name__ == "__main__":
    main()
