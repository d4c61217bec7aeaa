"""A person's textures and materials: the skin, and two atlases of painted cells."""

import numpy as np

from townspeople import face, materials
from townspeople import surface as sf
from townspeople.wardrobe import CELLS

MATERIALS = {"skin": (0.62, 0.0), "cloth": (0.92, 0.0), "trim": (0.70, 0.0)}  # roughness, metallic


EYE_PX = 64
IRIS = (0.36, 0.22, 0.12)  # sRGB; brown
IRIS_RADIUS, PUPIL_RADIUS = 0.18, 0.085  # as shares of the picture's side
GLINT, GLINT_RADIUS = (0.43, 0.42), 0.032  # what an eye mirrors of the sky


def eye_picture(source, iris):
    """The source's eye with an iris of that colour, darker towards its rim, and a glint."""
    picture = materials.shrunk(source[::-1], EYE_PX, EYE_PX)
    y, x = (np.mgrid[0:EYE_PX, 0:EYE_PX] + 0.5) / EYE_PX
    radius = np.hypot(x - 0.5, y - 0.49)
    ring = sf.smoothstep(PUPIL_RADIUS - 0.015, PUPIL_RADIUS + 0.01, radius) * sf.smoothstep(IRIS_RADIUS + 0.01, IRIS_RADIUS - 0.02, radius)
    light = 0.75 + 0.5 * sf.smoothstep(0.40, 0.62, y)  # the light falls through to its lower half
    picture = picture + (np.asarray(iris) * light[..., None] - picture) * (0.85 * ring)[..., None]
    glint = np.exp(-(((x - GLINT[0]) / GLINT_RADIUS) ** 2 + ((y - GLINT[1]) / GLINT_RADIUS) ** 2) ** 2)
    return np.clip(picture + glint[..., None] * (1.0 - picture), 0.0, 1.0)


def paint_cells(figure, person, seed, cells):
    """Pictures of the texture cells in use: {material: {cell: picture}}."""
    pictures = {"cloth": {}, "trim": {}}
    for number, cell in enumerate(sorted(cells)):
        random = np.random.default_rng([seed, number])
        if cell == "eyes":
            pictures["trim"][cell] = eye_picture(figure.images["eye"], person["skin"].get("iris", IRIS))
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
