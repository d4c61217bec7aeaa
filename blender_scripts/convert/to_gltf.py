"""Opens or imports a file that glTF tools don't read, and writes it as a GLB.

    blender --background --factory-startup --python-exit-code 1 --python to_gltf.py -- SETTINGS.json

SETTINGS.json: {"output": "person.glb", "options": {"input": "person.fbx"}}. The input is a .blend or
of any kind in IMPORTERS. Custom properties become extras, every action of a rig a clip; what is hidden stays out.
"""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

import bpy  # noqa: E402

from common import gltf  # noqa: E402
from common.settings import fail, load_settings, write_atomically  # noqa: E402


def knows(operators, name):
    return name in dir(operators)  # hasattr finds any name there


def by_operator(module, name, **options):
    """An importer, if this Blender has it: formats come and go with its versions and builds."""
    def read(path):
        operators = getattr(bpy.ops, module)
        if not knows(operators, name):
            raise RuntimeError("this Blender does not read such files; save the model as glTF, FBX or OBJ")
        getattr(operators, name)(filepath=path, **options)
    return read


def import_x3d(path):
    try:  # the one of Blender 3.4 opens files in a way that Python 3.11 no longer knows
        from io_scene_x3d import import_x3d as importer
        importer.open = lambda file, mode="r", **how: open(file, mode.replace("U", ""), **how)
    except ImportError:
        pass
    by_operator("import_scene", "x3d")(path)


def import_fbx(path):
    with open(path, "rb") as file:
        start = file.read(27)  # a name, and the version
    if not start.startswith(b"Kaydara FBX Binary"[:max(1, len(start))]):
        fail("%s: is no binary FBX; save it as one (FBX 7.4), or as glTF" % path)
    if len(start) < 27:
        fail("%s: is cut short; export or download it again" % path)
    by_operator("import_scene", "fbx", use_custom_props=True)(path)


IMPORTERS = {
    ".obj": by_operator("wm", "obj_import") if knows(bpy.ops.wm, "obj_import") else by_operator("import_scene", "obj"),
    ".dae": by_operator("wm", "collada_import"),
    ".fbx": import_fbx,
    ".x3d": import_x3d, ".wrl": import_x3d,
    ".abc": by_operator("wm", "alembic_import", as_background_job=False),
    **{kind: by_operator("wm", "usd_import") for kind in (".usd", ".usda", ".usdc", ".usdz")},
}

BINDING = ("CHILD_OF", "COPY_TRANSFORMS", "COPY_LOCATION", "ARMATURE")  # constraints by which a thing goes with a bone


def open_input(path):
    kind = os.path.splitext(path)[1].lower()
    if kind == ".blend":
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
        return
    if kind not in IMPORTERS:
        fail("%s: neither .blend nor %s" % (path, ", ".join(sorted(IMPORTERS))))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    IMPORTERS[kind](path)


def only_clips_of_rigs():
    """Every action that moves bones gets a track of its own on its rig, so that all of them become clips."""
    rigs = [thing for thing in bpy.context.scene.objects if thing.type == "ARMATURE"]
    for action in bpy.data.actions:
        bones = {path.split('"')[1] for path in (curve.data_path for curve in action.fcurves) if path.startswith("pose.bones")}
        owners = [rig for rig in rigs if bones & set(rig.data.bones.keys())]
        for rig in owners[:1]:
            rig.animation_data_create()
            strips = [strip.action for track in rig.animation_data.nla_tracks for strip in track.strips]
            if action not in strips:
                track = rig.animation_data.nla_tracks.new()
                track.name = action.name
                track.strips.new(action.name, int(action.frame_range[0]), action)
    for rig in rigs:
        if rig.animation_data:
            rig.animation_data.action = None


def stand_at_rest():
    """The exporter brings what hangs on a posed bone back to the rest pose, but amiss where the rig itself was moved,
    turned or scaled; it poses by the clips itself, if the rig isn't held at rest."""
    for rig in bpy.context.scene.objects:
        if rig.type != "ARMATURE":
            continue
        rig.data.pose_position = "POSE"
        if rig.animation_data:
            rig.animation_data.use_nla = False
        for bone in rig.pose.bones:
            bone.matrix_basis.identity()


def bone_held_by(thing):
    """The rig and the bone that a constraint binds a thing to, as artists hang hats and tools; None where there is none, or a skin."""
    if thing.type not in ("MESH", "EMPTY") or any(modifier.type == "ARMATURE" for modifier in thing.modifiers):
        return None
    for constraint in thing.constraints:
        if constraint.mute or not constraint.influence:
            continue
        for target in getattr(constraint, "targets", [constraint]):
            rig, bone = getattr(target, "target", None), getattr(target, "subtarget", "")
            if constraint.type in BINDING and rig and rig.type == "ARMATURE" and bone in rig.data.bones:
                return rig, bone
    return None


def hang_on_bones():
    """What constraints bind to a bone becomes its child: glTF knows no constraints."""
    bpy.context.view_layer.update()
    seen = bpy.context.evaluated_depsgraph_get()
    held = {thing: (bone_held_by(thing), thing.evaluated_get(seen).matrix_world.copy()) for thing in bpy.context.scene.objects if bone_held_by(thing)}
    for thing, ((rig, bone), place) in held.items():
        thing.constraints.clear()
        thing.parent, thing.parent_type, thing.parent_bone = rig, "BONE", bone
        thing.matrix_world = place


def apply_modifiers_beside_shape_keys():
    """The exporter applies modifiers to all meshes or to none, and shapes are lost where it does. Whether it may."""
    meshes = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
    if not any(thing.data.shape_keys for thing in meshes):
        return True
    for thing in meshes:
        changes = [modifier.name for modifier in thing.modifiers if modifier.type != "ARMATURE" and modifier.show_viewport]
        if thing.data.shape_keys or not changes:
            continue
        thing.data = thing.data.copy()  # no other object's
        with bpy.context.temp_override(object=thing):
            for name in changes:
                bpy.ops.object.modifier_apply(modifier=name)
    return False


def in_plain_words(error):
    """What Blender says, without the file's name, which stands before it, and without its own places."""
    said = str(error).replace("Error: ", "")
    if "Couldn't open file" in said:  # so it calls all that it cannot parse
        return "is damaged or cut short; export or download it again"
    for odd in (r" in file '.*'", r" \(see Blender Console\)"):
        said = re.sub(odd, "", said)
    return said


def main():
    settings = load_settings(required=("output",), options={"input": ""})
    path = settings["options"]["input"]
    try:
        open_input(path)
    except RuntimeError as error:
        fail("%s: %s" % (path, in_plain_words(error)))
    if not any(thing.type in ("MESH", "ARMATURE") for thing in bpy.context.scene.objects):
        fail("%s: holds neither a mesh nor a rig" % path)
    only_clips_of_rigs()
    stand_at_rest()
    hang_on_bones()
    apply_all = apply_modifiers_beside_shape_keys()
    write_atomically(settings["output"], lambda out: gltf.export_glb(
        out, use_visible=True, export_apply=apply_all, export_morph=True, export_morph_normal=False, export_morph_animation=False, export_animations=True, export_nla_strips=True,
        export_animation_mode="NLA_TRACKS", export_frame_range=False, export_force_sampling=True, export_skins=True))


main()
