"""Textures: cloth, leather, metal, hair painted with numpy into cells of an atlas (the skin: face.py).

Pictures are (height, width, 3) arrays of sRGB values 0 to 1, top row first. In a cell, u runs from
the front of the body (left) to its back (right), v from the garment's top to its hem.
"""

import os
import tempfile

import bpy
import numpy as np

from common.settings import fail

ATLAS_PX = 512
GUTTER_PX = 8  # keeps the edges of cells clean down to the mip level of an eighth
HEM_DIRT = np.array([0.30, 0.25, 0.19])


def value_noise(random, height, width, cells_down, cells_across):
    """Smooth noise from -1 to 1 with about so many bumps."""
    grid = random.uniform(-1.0, 1.0, (cells_down + 2, cells_across + 2))
    y = np.linspace(0, cells_down, height, endpoint=False)[:, None]
    x = np.linspace(0, cells_across, width, endpoint=False)[None, :]
    y0, x0 = y.astype(int), x.astype(int)
    fy, fx = y - y0, x - x0
    fy, fx = fy * fy * (3 - 2 * fy), fx * fx * (3 - 2 * fx)
    rows = grid[:, x0[0]] * (1 - fx) + grid[:, x0[0] + 1] * fx
    return rows[y0[:, 0]] * (1 - fy) + rows[y0[:, 0] + 1] * fy


def _mottled(random, h, w, amount):
    return amount * (
        0.6 * value_noise(random, h, w, 5, 4) + 0.4 * value_noise(random, h, w, 13, 11)
    )


def _wool(random, h, w):
    fibres = value_noise(random, h, w, max(h // 6, 2), w // 2)
    return 1.0 + _mottled(random, h, w, 0.06) + 0.03 * fibres + 0.05 * random.uniform(-1, 1, (h, w))


def _linen(random, h, w):
    warp, weft = random.uniform(-1, 1, (1, w)), random.uniform(-1, 1, (h, 1))
    return (
        1.0
        + _mottled(random, h, w, 0.05)
        + 0.03 * warp
        + 0.03 * weft
        + 0.02 * random.uniform(-1, 1, (h, w))
    )


def _velvet(random, h, w):
    sheen = value_noise(random, h, w, 2, 5)
    return 1.0 + 0.14 * sheen + _mottled(random, h, w, 0.06) + 0.03 * random.uniform(-1, 1, (h, w))


def _leather(random, h, w):
    creases = np.abs(value_noise(random, h, w, h // 6, w // 6))
    return (
        1.0
        + _mottled(random, h, w, 0.13)
        - 0.09 * (creases < 0.06)
        + 0.05 * random.uniform(-1, 1, (h, w))
    )


def _metal(random, h, w):
    """Polished: the light that runs down a curved sheet is painted, dark beside it."""
    u, v = np.linspace(0, 1, w)[None, :], np.linspace(0, 1, h)[:, None]
    gleam = np.exp(-(((u - 0.17) / 0.05) ** 2)) + 0.6 * np.exp(-(((u - 0.62) / 0.07) ** 2))
    scratches = value_noise(random, h, w, h // 3, max(w // 20, 2))
    return (
        0.82
        + 0.75 * gleam * (0.75 + 0.25 * np.cos(5 * v))
        + 0.05 * scratches
        + _mottled(random, h, w, 0.10)
        + 0.03 * random.uniform(-1, 1, (h, w))
    )


def _hair(random, h, w):
    locks = value_noise(random, h, w, 3, w // 16)
    return (
        1.0
        + 0.20 * locks
        + 0.10 * value_noise(random, h, w, 3, w // 5)
        + 0.16 * value_noise(random, h, w, 4, w // 2)
        + 0.05 * random.uniform(-1, 1, (h, w))
    )


def _straw(random, h, w):
    rings = np.sin(np.linspace(0, h * 0.9, h))[:, None]
    blades = value_noise(random, h, w, h // 3, w // 4)
    return 1.0 + 0.12 * rings + 0.12 * blades + _mottled(random, h, w, 0.08)


def _rope(random, h, w):
    y, x = np.mgrid[0:h, 0:w]
    return (
        1.0 + 0.14 * np.sin((x / w * 4 + y / h * 22) * np.pi) + 0.08 * random.uniform(-1, 1, (h, w))
    )


WEAVES = {
    "wool": _wool,
    "linen": _linen,
    "velvet": _velvet,
    "leather": _leather,
    "metal": _metal,
    "hair": _hair,
    "straw": _straw,
    "rope": _rope,
}


def _blend(picture, mask, colour):
    mask = np.clip(mask, 0.0, 1.0)[..., None]
    return picture * (1 - mask) + np.asarray(colour) * mask


def paint(
    random,
    size_px,
    weave,
    colour,
    hem=0.0,
    folds=0.0,
    trim=(),
    placket=None,
    damask=None,
    seams=True,
    stripes=None,
):
    """One cell's picture.

    hem: strength of the dirt at the lower edge. folds: strength of painted folds. trim: list of
    [v from, v to (1: to the end), colour]. placket: [width in u, colour, number of buttons, button
    colour]. damask: colour of a woven pattern. stripes: [number from front to back, colour].

    From afar a pixel is 1.5 cm wide: stripes narrower than 5 cm, and what is fine and strong in
    contrast, would flicker there.
    """
    w, h = size_px
    if weave not in WEAVES:
        fail("people.py: no weave '%s'" % weave)
    u, v = np.linspace(0, 1, w)[None, :], np.linspace(0, 1, h)[:, None]
    picture = np.ones((h, w, 3)) * np.asarray(colour, float)
    if damask is not None:
        a, b = u * 14 * np.pi, v * 18 * np.pi
        motif = np.sin(a) * np.sin(b) + 0.6 * np.sin(2 * a + np.sin(b)) * np.sin(b * 0.5)
        picture = _blend(picture, 0.8 * (np.clip(motif * 3, 0, 1)), damask)
    if stripes is not None:
        wave = np.sin(u * 2 * np.pi * stripes[0]) - 0.2
        picture = _blend(picture, (0.5 + 8 * wave) * np.ones_like(v), stripes[1])
    for start, end, trim_colour in trim:
        inside = np.minimum(v - start, (end - v) if end < 1 else 1.0)
        picture = _blend(picture, (0.5 + inside * h / 2) * np.ones_like(u), trim_colour)
    if placket is not None:
        picture = _placket(picture, u, v, placket)
    light = WEAVES[weave](random, h, w)
    if folds:
        bent = u + 0.04 * value_noise(random, h, w, 4, 3)
        light = light - 0.5 * folds * (0.5 + 0.5 * np.sin(bent * 2 * np.pi * 7)) ** 2 * v
    if seams:
        light = (
            light - 0.06 * np.exp(-(((v - 1.0) / 0.02) ** 2)) - 0.05 * np.exp(-((v / 0.015) ** 2))
        )
    picture = picture * light[..., None]
    if hem:
        ragged = v + 0.05 * value_noise(random, h, w, 3, 9)
        picture = _blend(picture, hem * np.clip((ragged - 0.80) / 0.2, 0, 1) ** 1.5, HEM_DIRT)
    return np.clip(picture, 0.0, 1.0)


def _placket(picture, u, v, placket):
    width, colour, buttons, button_colour = placket
    picture = _blend(picture, (u < width) * np.ones_like(v), colour)
    edge = np.exp(-(((u - width) / 0.008) ** 2)) * np.ones_like(v)
    picture = picture * (1 - 0.15 * edge[..., None])
    if buttons:
        place = (v * buttons) % 1.0 - 0.5
        dot = (u / 0.016) ** 2 + (place / (0.11)) ** 2 < 1.0
        picture = _blend(picture, dot * 1.0, button_colour)
    return picture


def shrunk(picture, width, height):
    """Box-filtered down to a size that divides the picture's, or nearest where it does not."""
    h, w = picture.shape[:2]
    fy, fx = h // height, w // width
    if fy >= 1 and fx >= 1 and h % height == 0 and w % width == 0:
        rows = sum(picture[k::fy] for k in range(fy))
        return sum(rows[:, k::fx] for k in range(fx)) / np.float32(fy * fx)
    rows = (np.arange(height) + 0.5) * h // height
    columns = (np.arange(width) + 0.5) * w // width
    return picture[rows.astype(int)][:, columns.astype(int)]


def pack_cells(pictures):
    """Packs {name: picture} into one atlas, each where it comes to lie highest; returns it with
    {name: (x, y, width, height)} in px. Around each cell its picture goes on: mirrored across, as u
    is on the body, and as it ends up and down.
    """
    atlas = np.full((ATLAS_PX, ATLAS_PX, 3), 0.4)
    places, taken = {}, np.zeros(ATLAS_PX, int)  # rows, by column
    for name in sorted(pictures, key=lambda key: (-pictures[key].shape[0], key)):
        across = np.pad(pictures[name], ((0, 0), (GUTTER_PX, GUTTER_PX), (0, 0)), "symmetric")
        picture = np.pad(across, ((GUTTER_PX, GUTTER_PX), (0, 0), (0, 0)), "edge")
        h, w = picture.shape[:2]
        y, x = min((int(taken[x : x + w].max()), x) for x in range(ATLAS_PX - w + 1))
        if y + h > ATLAS_PX:
            fail("people.py: the texture cells do not fit into %d px (at '%s')" % (ATLAS_PX, name))
        atlas[y : y + h, x : x + w] = picture
        taken[x : x + w] = y + h
        places[name] = (x + GUTTER_PX, y + GUTTER_PX, w - 2 * GUTTER_PX, h - 2 * GUTTER_PX)
    return atlas, places


def atlas_uv(corner_uv, place):
    """glTF texture coordinates (v down from the top) in the atlas of coordinates in a cell."""
    x, y, w, h = place
    return (np.array([x, y]) + np.clip(corner_uv, 0, 1) * np.array([w, h])) / ATLAS_PX


def without_speckles(picture):
    """Removes dark specks (stubble, pores) but keeps large dark areas: a closing by rank
    filters.
    """

    def around(values, combine):
        """Each texel combined with those two to every side of it: first across, then up and down."""
        for axis in (1, 0):
            old, values = np.moveaxis(values, axis, 0), values.copy()
            new = np.moveaxis(values, axis, 0)
            for ahead in (2, -2):
                combine(new[:-ahead], old[ahead:], out=new[:-ahead])
                combine(new[-ahead:], old[:ahead], out=new[-ahead:])
        return values

    closed = around(around(picture, np.maximum), np.minimum)
    return around(closed, np.add) / np.float32(9)


def blender_image(name, picture, quality=88):
    """A packed JPEG image in Blender."""
    h, w = picture.shape[:2]
    image = bpy.data.images.new(name, w, h)
    values = np.ones((h, w, 4), np.float32)
    values[..., :3] = picture[::-1]
    image.pixels.foreach_set(values.ravel())
    image.update()
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.quality, settings.color_mode = "JPEG", quality, "RGB"
    bpy.context.scene.view_settings.view_transform = "Standard"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name + ".jpg")
        image.save_render(path)
        loaded = bpy.data.images.load(path)
        loaded.pack()
    bpy.data.images.remove(image)
    loaded.name = name
    return loaded


def blender_material(name, image, roughness, metallic):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = False
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    for specular in ("Specular", "Specular IOR Level"):
        if specular in shader.inputs:
            shader.inputs[specular].default_value = 0.5
    return material
