"""Builds one townsperson of about 1600 as a GLB.

    blender --background --factory-startup --python-exit-code 1 --python build.py -- SETTINGS.json

SETTINGS.json: {"output": "monk.glb", "seed": 1, "options": {"person": "monk"}}. The people stand
in people.py.
"""

import gc
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

import numpy as np  # noqa: E402

from common.settings import fail, load_settings, unknown_key, write_atomically  # noqa: E402
from townspeople import accessories, body, clips, garments, headwear, looks  # noqa: E402
from townspeople import occlusion, props, scene, skeleton, skin, work_clips, work_props  # noqa: E402
from townspeople import surface as sf  # noqa: E402
from townspeople.people import PEOPLE  # noqa: E402
from townspeople.tailor import Tailor  # noqa: E402

PIECES = {
    "upper": garments.upper, "plate": garments.plate, "skirt": garments.skirt,
    "trousers": garments.trousers, "legs": garments.leg_pieces, "belt": accessories.belt,
    "cord": accessories.cord, "pouch": accessories.pouch, "apron": accessories.apron,
    "cape": accessories.cape, "standing collar": accessories.collar, "roll": accessories.roll,
    "ruff": accessories.ruff, "shell": headwear.shell, "beard": headwear.beard,
    "moustache": headwear.moustache, "hat": headwear.hat,
    "feather": headwear.feather,
}


def make_figure(person, rig_path):
    figure = body.stood(body.load_figure(rig_path))
    figure = body.proportioned(figure, person["height_m"], person.get("proportions", {}))
    return body.bulged(figure, person.get("bulges", []))


def sampled_poses(figure, moves):
    """Skinning matrices of some frames of each clip."""
    return [
        skeleton.transforms(figure.skeleton, clip.rotations[f], clip.roots[f])
        for clip, every in zip(moves, (2, 24, 12))
        for f in range(0, len(clip.rotations) - 1, every)
    ]


def dress(figure, person, moves, seed):
    """All garments, in the order in which they are put on."""
    tailor = Tailor(
        figure,
        np.random.default_rng(seed),
        size=figure.landmarks["crown"][2] / 1.7,
        poses=sampled_poses(figure, moves),
    )
    for number, wear in enumerate(person["wear"]):
        piece = dict(wear)
        make = PIECES[piece.pop("piece")]
        make(tailor, piece.pop("name", str(number)), **piece)
    return tailor


def assemble(tailor, person):
    """One surface of everything that can be seen, at most four weights a vertex, with ambient
    occlusion.
    """
    parts = [
        skin.visible_skin(tailor, person),
        tailor.figure.parts["eyes"],
        tailor.figure.parts["shoes"],
    ]
    whole = sf.joined(parts + list(tailor.worn.values()))
    whole = sf.with_parts(whole, weights=skeleton.at_most_four(whole.weights))
    return occlusion.with_shade(whole, lightest_for={"eyes": 1.0, "body": 0.8, "hair": 0.65})


def with_props(tailor, person, name_of_person, whole):
    """The person's props and tools by name, with weights and ambient occlusion as on the person."""
    finished = {}
    carried = props.carried(tailor, person) | work_props.tools(tailor, name_of_person)
    for name, prop in carried.items():
        strange = set(prop.surface.cells) - set(whole.cells)
        if strange:
            fail("people.py: prop '%s': no texture cell '%s'" % (name, min(strange)))
        weights = skeleton.at_most_four(prop.surface.weights)
        surface = sf.with_parts(prop.surface, weights=weights)
        surface = occlusion.with_shade(surface, lightest_for={}, beside=[whole])
        finished[name] = props.Prop(surface, prop.tint)
    return finished


def main():
    gc.disable()  # little here goes round in circles, and looking for it takes a tenth of the time
    settings = load_settings(
        required=("output", "seed"), options={"person": "merchant", "human_rig": body.HUMAN_RIG}
    )
    options, seed = settings["options"], settings["seed"]
    if options["person"] not in PEOPLE:
        fail(
            "option 'person': "
            + unknown_key(options["person"], list(PEOPLE)).replace("key", "person")
        )
    person = PEOPLE[options["person"]]

    scene.empty_scene()
    figure = make_figure(person, options["human_rig"])
    manner = clips.Manner(**person.get("manner", {}))
    walk, speed_mps = clips.walk_clip(figure, manner)
    moves = (walk, clips.idle_clip(figure, manner), clips.talk_clip(figure, manner))
    tailor = dress(figure, person, moves, seed)
    surface = assemble(tailor, person)
    made, material_of_cell, places = looks.make_materials(figure, person, seed, set(surface.cells))
    uv = looks.texture_coordinates(surface, places)

    armature = scene.make_armature(figure.skeleton)
    armature["flaneur_walk_speed_mps"] = round(speed_mps, 4)
    joints = figure.skeleton.names
    scene.make_mesh("person_mesh", surface, made, material_of_cell, uv, armature, joints)
    for name, prop in with_props(tailor, person, options["person"], surface).items():
        uv = looks.texture_coordinates(prop.surface, places)
        scene.make_mesh(name, prop.surface, made, material_of_cell, uv, armature, joints, prop.tint)
    moves += tuple(work_clips.work_clips(figure, options["person"], manner))
    write_atomically(settings["output"], lambda path: scene.write_glb(path, armature, figure.skeleton, moves))
    print(
        "townsperson %s: %d triangles, %d joints, walks %.2f m/s"
        % (options["person"], sf.triangle_count(surface), len(figure.skeleton.names), speed_mps)
    )


main()
