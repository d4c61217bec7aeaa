"""Blender objects from the gathered meshes, and the GLB."""

import math
import os

import bpy
import numpy as np

import textures
from common import glb, gltf
from mesh import unique_rows


def make_materials(names, pixels, seed, folder):
    """One material a name: base colour = texture times vertex colour."""
    made = {}
    for name in names:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        material.use_backface_culling = name not in ("leaves", "twigs")
        shader = material.node_tree.nodes["Principled BSDF"]
        if name in textures.TEXTURES:
            image = _image(name, pixels, seed, folder)
            node = material.node_tree.nodes.new("ShaderNodeTexImage")
            node.image = image
            material.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
            if image.depth == 32:
                material.node_tree.links.new(node.outputs["Alpha"], shader.inputs["Alpha"])
                material.blend_method, material.alpha_threshold = "CLIP", 0.4
            shader.inputs["Roughness"].default_value = textures.TEXTURES[name][2]
        else:
            shader.inputs["Base Color"].default_value = (1, 1, 1, 1)
            shader.inputs["Roughness"].default_value = 0.5
            shader.inputs["Metallic"].default_value = 0.0
        made[name] = material
    return made


def _image(name, pixels, seed, folder):
    """The texture as a file, which the exporter embeds as it is: JPEG, or PNG where it is cut out."""
    values = textures.make(name, pixels, seed)
    size = values.shape[0]
    cut_out = values.shape[2] == 4
    image = bpy.data.images.new(name, size, size, alpha=cut_out)
    rgba = np.ones((size, size, 4), np.float32)
    rgba[..., :values.shape[2]] = values
    image.pixels.foreach_set(rgba.ravel())
    path = os.path.join(folder, name + (".png" if cut_out else ".jpg"))
    image.filepath_raw = path
    image.file_format = "PNG" if cut_out else "JPEG"
    bpy.context.scene.render.image_settings.quality = 82
    image.save()
    bpy.data.images.remove(image)
    loaded = bpy.data.images.load(path)
    loaded.name = name
    return loaded


def make_blender_mesh(name, mesh, part, colors, materials):
    """A Blender mesh with flat normals unless given, texture coordinates and vertex colours.

    Corners share a point only if they share its colour and normal too. So colours can be stored by point (the exporter
    of Blender 3.4 mixes up those stored by corner), and walls come out flat although every point has one normal, which
    lets the exporter share points within a wall.
    """
    keep = part.area > 1e-6
    corner_kept = keep[part.face]
    points = part.points[corner_kept]
    normals = part.normals[corner_kept]
    key = np.concatenate([np.round(points * 10000), np.round(colors[corner_kept] * 4095), np.round(normals * 100)], axis=1)
    key = key.astype(np.int64)
    chosen, inverse = unique_rows(key)
    sizes = part.sizes[keep]
    data = bpy.data.meshes.new(name)
    data.vertices.add(len(chosen))
    data.vertices.foreach_set("co", points[chosen].astype(np.float32).ravel())
    data.loops.add(len(points))
    data.loops.foreach_set("vertex_index", inverse.astype(np.int32))
    data.polygons.add(len(sizes))
    data.polygons.foreach_set("loop_start", np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int32))
    if not bpy.types.MeshPolygon.bl_rna.properties["loop_total"].is_readonly:   # later versions find it themselves
        data.polygons.foreach_set("loop_total", sizes.astype(np.int32))
    used = sorted(set(mesh.materials))
    for material in used:
        data.materials.append(materials[material])
    slot = {material: i for i, material in enumerate(used)}
    indices = np.array([slot[m] for m in mesh.materials], np.int32)[keep]
    data.polygons.foreach_set("material_index", indices)
    data.polygons.foreach_set("use_smooth", np.ones(len(sizes), bool))
    data.update(calc_edges=True)
    layer = data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", np.array(mesh.uvs, np.float32)[corner_kept].ravel())
    attribute = data.color_attributes.new("Color", "BYTE_COLOR", "POINT")
    rgba = np.ones((len(chosen), 4), np.float32)
    rgba[:, :3] = colors[corner_kept][chosen]
    attribute.data.foreach_set("color", rgba.ravel())
    data.color_attributes.active_color = attribute
    data.color_attributes.render_color_index = 0
    if mesh.normals:
        if hasattr(data, "use_auto_smooth"):   # gone from Blender 4.1 on, where custom normals need no switch
            data.use_auto_smooth, data.auto_smooth_angle = True, math.pi
        data.normals_split_custom_set_from_vertices([tuple(n) for n in normals[chosen].tolist()])
    return data


def add_object(name, data, extras, location=(0, 0, 0), yaw=0.0, scale=1.0):
    """An object of the scene; its custom properties become the node's extras."""
    thing = bpy.data.objects.new(name, data)
    thing.location = location
    thing.rotation_euler = (0, 0, yaw)
    thing.scale = (scale, scale, scale)
    for key, value in extras.items():
        thing[key] = value
    bpy.context.scene.collection.objects.link(thing)
    return thing


def write_glb(path):
    """Exports the scene."""
    gltf.export_glb(path, export_apply=False, export_active_vertex_color_when_no_material=True, export_animations=False,
                    export_skins=False, export_tangents=False)
    _snap_normals(path)


def _snap_normals(path):
    """Rounds the file's normals: Blender sums them on several threads, so that their last bits differ between runs."""
    document, binary = glb.read(path)
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            own = glb.floats(document, binary, primitive["attributes"]["NORMAL"])
            normals = np.round(own.astype(np.float64) * 4096) / 4096 + 0.0
            own[:] = normals / np.linalg.norm(normals, axis=1)[:, None]
    glb.write(path, document, binary)
