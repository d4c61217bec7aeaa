"""Blender's glTF exporter, alike in all its versions."""

import bpy
import numpy as np

# What everything that is exported here has in common.
ALWAYS = {
    "export_format": "GLB", "export_yup": True, "export_extras": True, "export_colors": True,
    "export_vertex_color": "ACTIVE", "export_all_vertex_colors": False, "export_image_format": "AUTO",
    "export_morph": False, "export_lights": False, "export_cameras": False,
}


def fill_empty_material_slots():
    """Blender 3.4's exporter ends where a picture names its UV map and any mesh has a slot without a material."""
    empty = [mesh for mesh in bpy.data.meshes if None in mesh.materials[:]]
    if not empty:
        return
    plain = bpy.data.materials.new("plain")
    for mesh in empty:
        for slot, material in enumerate(mesh.materials[:]):
            if material is None:
                mesh.materials[slot] = plain


def export_glb(path, **wanted):
    """Exports the scene; options that this Blender's exporter does not know are left out."""
    for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
        if name not in np.__dict__:  # Blender 3.4's exporter uses names that numpy 1.24 dropped
            setattr(np, name, kind)
    fill_empty_material_slots()
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    options = {key: value for key, value in {**ALWAYS, **wanted}.items() if key in known}
    if "FINISHED" not in bpy.ops.export_scene.gltf(filepath=path, **options):
        raise RuntimeError("the glTF export failed")
