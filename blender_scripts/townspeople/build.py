"""Builds one townsperson of about 1600 as a GLB.

    blender --background --factory-startup --python-exit-code 1 --python build.py -- SETTINGS.json

SETTINGS.json: {"output": "monk.glb", "seed": 1, "options": {"person": "monk"}}. The people stand in people.py.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

import numpy as np  # noqa: E402

from common.settings import fail, load_settings, unknown_key, write_atomically  # noqa: E402
from townspeople import (accessories, body, clearance, clips, garments, headwear, materials,  # noqa: E402
                         occlusion, scene, skeleton)
from townspeople import surface as sf  # noqa: E402
from townspeople.people import CELLS, PEOPLE  # noqa: E402
from townspeople.tailor import Tailor  # noqa: E402

PIECES = {
    "upper": garments.upper, "skirt": garments.skirt, "trousers": garments.trousers,
    "legs": garments.leg_pieces, "belt": accessories.belt, "cord": accessories.cord,
    "pouch": accessories.pouch, "apron": accessories.apron, "cape": accessories.cape,
    "standing collar": accessories.collar, "ruff": accessories.ruff, "plate": garments.plate,
    "shell": headwear.shell, "beard": headwear.beard, "moustache": headwear.moustache, "brows": headwear.brows,
    "hat": headwear.hat, "feather": headwear.feather,
}
MATERIALS = {"skin": (0.62, 0.0), "cloth": (0.92, 0.0), "trim": (0.70, 0.0)}   # roughness, metallic


def make_figure(person, rig_path):
    figure = body.stood(body.load_figure(rig_path))
    figure = body.proportioned(figure, person["height_m"], person.get("proportions", {}))
    return body.bulged(figure, person.get("bulges", []))


def sampled_poses(figure, moves):
    """Skinning matrices of some frames of each clip."""
    return [skeleton.transforms(figure.skeleton, clip.rotations[f], clip.roots[f])
            for clip, every in zip(moves, (2, 24, 12)) for f in range(0, len(clip.rotations) - 1, every)]


def dress(figure, person, moves, seed):
    """All garments, in the order in which they are put on."""
    tailor = Tailor(figure, np.random.default_rng(seed), size=figure.landmarks["crown"][2] / 1.7,
                    poses=sampled_poses(figure, moves))
    for number, wear in enumerate(person["wear"]):
        piece = dict(wear)
        make = PIECES[piece.pop("piece")]
        make(tailor, piece.pop("name", str(number)), **piece)
    return tailor


def visible_skin(tailor, person):
    """Head, neck and hands: whatever the garments leave to be seen."""
    figure = tailor.figure
    skin = figure.parts["body"]
    centres = sf.face_centres(skin)
    arms = body.joint_share(figure, skin, ("shoulder02", "upperarm", "lowerarm", "wrist", "finger"))
    legs = body.joint_share(figure, skin, ("upperleg", "lowerleg", "foot"))
    keep = []
    for face, centre in zip(skin.faces, centres):
        ids = list(face)
        if legs[ids].mean() > 0.5:
            keep.append(False)
        elif arms[ids].mean() > 0.5:
            side = "_L" if centre[0] > 0 else "_R"
            place = garments.arm_place(tailor, side, centre)
            keep.append(place > person.get("bare_arm_from", 1.7))
        else:
            keep.append(centre[2] > tailor.height(("shoulder", -0.02)))
    return _lengthened_neck(tailor, _tucked(tailor, sf.keep_faces(skin, keep)))


def _tucked(tailor, skin):
    """Skin below the neckline drawn in beneath the cloth."""
    cloth = next(worn for name, worn in tailor.worn.items() if name.startswith("upper"))
    middle = tailor.height("neck")
    line = next(cloth.vertices[loop] for loop in sf.boundary_loops(cloth)
                if abs(cloth.vertices[loop][:, 2].mean() - middle) < 0.12 * tailor.size
                and abs(cloth.vertices[loop][:, 0].mean()) < 0.03)
    gaps = np.linalg.norm(skin.vertices[:, None, :2] - line[None, :, :2], axis=2)
    below = skin.vertices[:, 2] < line[gaps.argmin(axis=1), 2] - 0.006 * tailor.size
    below &= body.joint_share(tailor.figure, skin, ("spine", "clavicle", "neck", "shoulder")) > 0.5
    points = skin.vertices.copy()
    points[below] = clearance.drawn_in(points[below], sf.tree_of([cloth]), 0.008 * tailor.size)
    return sf.with_parts(skin, vertices=points)


def _lengthened_neck(tailor, skin):
    """The neck's open foot drawn down beneath the garments, so that no gap shows at a neckline."""
    loop = next(loop for loop in sf.boundary_loops(skin)
                if abs(skin.vertices[loop][:, 0].mean()) < 0.02 and len(loop) > 12
                and skin.vertices[loop][:, 2].mean() < tailor.height("neck"))
    edge = skin.vertices[loop]
    rings = [edge * [1.02, 1.0, 1.0] - [0, 0, 0.03 * tailor.size], edge * [1.0, 1.0, 1.0] - [0, 0, 0.07 * tailor.size]]
    corners = {v: uv for v, uv in zip((v for face in skin.faces for v in face), skin.corner_uv)}
    uv = np.array([corners[v] for v in loop])
    grown = garments.extruded(skin, loop, np.array(rings), np.array([skin.weights[loop]] * 2),
                              uv[:, 0], [0.0] * 3, "body")
    added = len(grown.corner_uv) - len(skin.corner_uv)
    ring_uv = np.array([uv[i] for c in range(len(loop)) for i in (c, (c + 1) % len(loop), (c + 1) % len(loop), c)])
    grown.corner_uv[-added:] = np.concatenate([ring_uv] * 2)
    return grown


def assemble(tailor, person):
    """One surface of everything that can be seen, at most four weights a vertex, with ambient occlusion."""
    parts = [visible_skin(tailor, person), tailor.figure.parts["eyes"], tailor.figure.parts["shoes"]]
    whole = sf.joined(parts + list(tailor.worn.values()))
    whole = sf.with_parts(whole, weights=skeleton.at_most_four(whole.weights))
    return occlusion.with_shade(whole, lightest_for={"eyes": 1.0, "body": 0.8, "hair": 0.65})


def paint_cells(figure, person, seed, cells):
    """Pictures of the texture cells in use: {material: {cell: picture}}."""
    pictures = {"cloth": {}, "trim": {}}
    for number, cell in enumerate(sorted(cells)):
        random = np.random.default_rng([seed, number])
        if cell == "eyes":
            pictures["trim"][cell] = materials.shrunk(figure.images["eye"][::-1], 64, 64)
        elif cell == "shoes":
            leather = materials.shrunk(figure.images["shoes"][::-1], 128, 128)
            pictures["trim"][cell] = np.clip(leather * np.asarray(person.get("shoe_tint", (0.55, 0.5, 0.5))), 0, 1)
        else:
            material, size = CELLS[cell]
            look = dict(person["cloth"][cell])
            weave, colour = look.pop("weave"), look.pop("colour")
            pictures[material][cell] = materials.paint(random, size, weave, colour, **look)
    return pictures


def face_places(figure):
    """Where lips and cheeks lie in the skin's picture: {name: (centre uv, radius in u and v)}."""
    skin, places = figure.parts["body"], {}
    scale = (figure.landmarks["crown"][2] - figure.landmarks["chin"][2]) / 0.230
    corner_vertices = [v for face in skin.faces for v in face]
    for name, shift, reach in (("lips", (0, 0.004, 0), 0.022), ("cheek_L", (0.042, 0.04, 0.028), 0.024),
                               ("cheek_R", (-0.042, 0.04, 0.028), 0.024)):
        centre = figure.landmarks["mouth"] + np.array(shift) * scale
        near = np.linalg.norm(skin.vertices - centre, axis=1) < reach * scale
        near &= skin.vertices[:, 1] < centre[1] + 0.02 * scale
        uv = np.array([uv for v, uv in zip(corner_vertices, skin.corner_uv) if near[v]])
        if len(uv):
            places[name] = (uv.mean(axis=0), np.maximum(uv.std(axis=0) * 1.6, 0.004))
    return places


def make_materials(figure, person, seed, cells):
    """Blender materials by name, each cell's material, and each cell's place in its atlas."""
    skin = materials.skin_picture(figure.images["skin"], face_places(figure), **person["skin"])
    made = {"skin": materials.blender_material("skin", materials.blender_image("skin", skin), *MATERIALS["skin"])}
    material_of_cell, places = {"body": "skin"}, {}
    for name, pictures in paint_cells(figure, person, seed, cells - {"body"}).items():
        atlas, atlas_places = materials.pack_cells(pictures)
        made[name] = materials.blender_material(name, materials.blender_image(name, atlas), *MATERIALS[name])
        material_of_cell.update({cell: name for cell in pictures})
        places.update(atlas_places)
    return made, material_of_cell, places


def texture_coordinates(surface, places):
    uv = surface.corner_uv.copy()
    starts = sf.corner_starts(surface.faces)
    for index, cell in enumerate(surface.cells):
        if cell in places:
            corners = slice(starts[index], starts[index + 1])
            uv[corners] = materials.atlas_uv(uv[corners], places[cell])
    return uv


def main():
    settings = load_settings(required=("output", "seed"),
                             options={"person": "merchant", "human_rig": body.HUMAN_RIG})
    options, seed = settings["options"], settings["seed"]
    if options["person"] not in PEOPLE:
        fail("option 'person': " + unknown_key(options["person"], list(PEOPLE)).replace("key", "person"))
    person = PEOPLE[options["person"]]

    scene.empty_scene()
    figure = make_figure(person, options["human_rig"])
    manner = clips.Manner(**person.get("manner", {}))
    walk, speed_mps = clips.walk_clip(figure, manner)
    moves = (walk, clips.idle_clip(figure, manner), clips.talk_clip(figure, manner))
    tailor = dress(figure, person, moves, seed)
    surface = assemble(tailor, person)
    made, material_of_cell, places = make_materials(figure, person, seed, set(surface.cells))
    uv = texture_coordinates(surface, places)

    armature = scene.make_armature(figure.skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    scene.make_mesh(surface, made, material_of_cell, uv, armature)
    for clip in moves:
        scene.add_clip(armature, figure.skeleton, clip)
    write_atomically(settings["output"], scene.export_glb)
    print("townsperson %s: %d triangles, %d joints, walks %.2f m/s" % (
        options["person"], sf.triangle_count(surface), len(figure.skeleton.names), speed_mps))


main()
