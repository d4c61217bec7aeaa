"""A person's textures and materials: the skin, and two atlases of painted cells."""

import numpy as np

from townspeople import face, materials
from townspeople import surface as sf
from townspeople.wardrobe import CELLS

MATERIALS = {"skin": (0.62, 0.0), "cloth": (0.92, 0.0), "trim": (0.70, 0.0)}  # roughness, metallic


def paint_cells(figure, person, seed, cells):
    """Pictures of the texture cells in use: {material: {cell: picture}}."""
    pictures = {"cloth": {}, "trim": {}}
    for number, cell in enumerate(sorted(cells)):
        random = np.random.default_rng([seed, number])
        if cell == "eyes":
            pictures["trim"][cell] = materials.shrunk(figure.images["eye"][::-1], 64, 64)
        elif cell == "shoes":
            leather = materials.shrunk(figure.images["shoes"][::-1], 128, 128)
            leather = 0.6 * leather + 0.4 * np.median(leather, axis=(0, 1))
            pictures["trim"][cell] = np.clip(
                leather * np.asarray(person.get("shoe_tint", (0.52, 0.52, 0.54))), 0, 1
            )
        else:
            material, size = CELLS[cell]
            look = dict(person["cloth"][cell])
            weave, colour = look.pop("weave"), look.pop("colour")
            pictures[material][cell] = materials.paint(random, size, weave, colour, **look)
    return pictures


def make_materials(figure, person, seed, cells):
    """Blender materials by name, each cell's material, and each cell's place in its atlas."""
    skin = face.skin_picture(figure, person, seed)
    made = {
        "skin": materials.blender_material(
            "skin", materials.blender_image("skin", skin), *MATERIALS["skin"]
        )
    }
    material_of_cell, places = {"body": "skin"}, {}
    dyes = person.get("dyes", {})
    for name, pictures in paint_cells(figure, person, seed, cells - {"body"}).items():
        atlas, atlas_places = materials.pack_cells(pictures)
        image = materials.blender_image(name, atlas)
        for cell in pictures:  # what is dyed by itself is a material by itself, of the same picture
            own = next((dye for dye, cells in dyes.items() if cell in cells), name)
            material_of_cell[cell] = own
            if own not in made:
                made[own] = materials.blender_material(own, image, *MATERIALS[name])
        places.update(atlas_places)
    return made, material_of_cell, places


def texture_coordinates(surface, places):
    uv = surface.corner_uv.copy()
    cells = np.repeat(np.array(surface.cells), np.diff(sf.corner_starts(surface.faces)))
    for cell in set(surface.cells) & set(places):
        uv[cells == cell] = materials.atlas_uv(uv[cells == cell], places[cell])
    return uv
