"""The skin's picture: a complexion over the source's own detail, and brows, lips, stubble, hairline and age painted
where they lie on the head, so that they follow whatever shape a head has.

`skin` in people.py: tone (sRGB), smooth (0 to 1: without the source's pores), rouge, stubble, age (0 to 1), and brow,
the shape of the eyebrows in millimetres on a head of 230 mm.
"""

import numpy as np

from townspeople import body, materials
from townspeople import surface as sf

SKIN_PX = 1024
BROW = {"rise": 17.5, "arch": 3.0, "inner": -16.0, "outer": 23.0, "half": 2.6, "fall": 3.5, "strength": 0.85}
BEARD_ABOVE = ((0, -47), (12, -46), (22, -40), (30, -33), (45, -29), (60, -25), (76, -13), (92, 4))
BEARD_BELOW = ((0, -66), (40, -62), (62, -53), (78, -38), (92, -14))
SHAVEN = {"upper_edge": BEARD_ABOVE, "lower_edge": BEARD_BELOW}


def places_of_texels(figure, size_px):
    """Where on the head each texel of the skin's picture lies (metres), and whether it is on it."""
    skin = figure.parts["body"]
    head = body.joint_share(figure, skin, ("head", "neck", "lids"))
    places = np.zeros((size_px, size_px, 3))
    there = np.zeros((size_px, size_px), bool)
    starts = sf.corner_starts(skin.faces)
    for index, face in enumerate(skin.faces):
        if head[list(face)].mean() < 0.2:
            continue
        corners = skin.corner_uv[starts[index] : starts[index + 1]] * size_px - 0.5
        points = skin.vertices[list(face)]
        for k in range(1, len(face) - 1):
            _fill(places, there, corners[[0, k, k + 1]], points[[0, k, k + 1]])
    return places, there


def _fill(places, there, corners, points):
    """One triangle, a texel wider than it is, so that no seam stays bare."""
    size = len(places)
    low = np.clip(np.floor(corners.min(axis=0)).astype(int) - 1, 0, size - 1)
    high = np.clip(np.ceil(corners.max(axis=0)).astype(int) + 2, 0, size)
    sides = np.stack([corners[1] - corners[0], corners[2] - corners[0]], axis=1)
    if abs(np.linalg.det(sides)) < 1e-9:
        return
    x, y = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
    share = np.stack([x - corners[0, 0], y - corners[0, 1]], axis=-1) @ np.linalg.inv(sides).T
    margin = 1.0 / np.sqrt(abs(np.linalg.det(sides)))
    inside = (share >= -margin).all(axis=-1) & (share.sum(axis=-1) <= 1.0 + margin)
    clamped = np.clip(share[inside], 0.0, 1.0)
    place = points[0] + clamped @ np.stack([points[1] - points[0], points[2] - points[0]])
    places[y[inside], x[inside]] = place
    there[y[inside], x[inside]] = True


class Head:
    """The head's texels in the painter's coordinates, millimetres on a head of 230 mm: x from the middle outwards, y
    forward and z up from between the eyes; azimuth and elevation in degrees as edges of hair are given (headwear.py).
    """

    def __init__(self, figure, random):
        marks = figure.landmarks
        scale = (marks["crown"][2] - marks["chin"][2]) / 0.230
        places, self.there = places_of_texels(figure, SKIN_PX)
        eyes = eye_centres(figure)
        self.eye_x = 1000.0 * 0.5 * (eyes[0][0] - eyes[1][0]) / scale
        middle = 0.5 * (eyes[0] + eyes[1])
        off = (places - middle) / scale * 1000.0
        self.x, self.y, self.z = np.abs(off[..., 0]), -off[..., 1], off[..., 2]
        self.mouth_z = 1000.0 * (marks["mouth"][2] - middle[2]) / scale
        self.nose_z = 1000.0 * (marks["nose"][2] - middle[2]) / scale
        rays = places - marks["head"]
        flat = np.hypot(rays[..., 0], rays[..., 1])
        self.azimuth = np.degrees(np.abs(np.arctan2(rays[..., 0], -rays[..., 1])))
        self.elevation = np.degrees(np.arctan2(rays[..., 2], np.maximum(flat, 1e-6)))
        self.fine = materials.value_noise(random, SKIN_PX, SKIN_PX, SKIN_PX // 3, SKIN_PX // 3)
        self.locks = materials.value_noise(random, SKIN_PX, SKIN_PX, SKIN_PX // 9, SKIN_PX // 9)

    def spot(self, x, z, radius_x, radius_z, front=True):
        """A soft round patch, the same on both sides."""
        mask = np.exp(-(((self.x - x) / radius_x) ** 2) - ((self.z - z) / radius_z) ** 2)
        return mask * (self.there & ((self.y > -35.0) if front else True))

    def line(self, x, z, width):
        """A soft line through points in the plane of the face."""
        best = np.full(self.x.shape, 1e9)
        for k in range(len(x) - 1):
            way = np.array([x[k + 1] - x[k], z[k + 1] - z[k]])
            t = np.clip(((self.x - x[k]) * way[0] + (self.z - z[k]) * way[1]) / (way @ way), 0, 1)
            best = np.minimum(
                best, np.hypot(self.x - x[k] - t * way[0], self.z - z[k] - t * way[1])
            )
        return np.exp(-((best / width) ** 2)) * (self.there & (self.y > -40.0))


def eye_centres(figure):
    """Middles of the left and the right eye."""
    points = figure.parts["eyes"].vertices
    sides = [points[points[:, 0] * sign > 0] for sign in (1.0, -1.0)]
    return [0.5 * (side.min(axis=0) + side.max(axis=0)) for side in sides]


def complexion(source, tone, smooth):
    """The source's skin in another tone: its light and dark stay, its own reds and yellows by a third."""
    picture = materials.shrunk(source[::-1], SKIN_PX, SKIN_PX)
    if smooth:
        picture = picture * (1 - smooth) + materials.without_speckles(picture) * smooth
    detail = picture / np.median(picture, axis=(0, 1))
    light = detail.mean(axis=2, keepdims=True)
    return np.asarray(tone) * light * (1.0 + 0.35 * (detail / light - 1.0))


def _mixed(picture, share, colour):
    share = np.clip(share, 0.0, 1.0)[..., None]
    return picture * (1.0 - share) + np.asarray(colour) * share


def _brows(head, picture, shape, colour):
    shape = dict(BROW, **shape)
    t = (head.x - head.eye_x - shape["inner"]) / (shape["outer"] - shape["inner"])
    middle = shape["rise"] + shape["arch"] * np.sin(np.pi * np.clip(t * 0.8 + 0.1, 0, 1)) ** 2
    middle = middle - shape["fall"] * np.clip(t - 0.62, 0, 1) ** 1.3 * 3.0
    half = shape["half"] * np.interp(t, [0.0, 0.12, 0.45, 0.8, 1.0], [0.75, 1.0, 0.9, 0.6, 0.25])
    across = (head.z - middle + 0.5 * head.fine) / half
    mask = np.exp(-np.abs(across) ** 3) * sf.smoothstep(-0.04, 0.06, t) * sf.smoothstep(1.04, 0.85, t)
    mask = mask * (head.there & (head.y > -30.0)) * shape["strength"] * (0.85 + 0.3 * head.fine)
    return _mixed(picture, mask, np.asarray(colour) * 0.62)


def _hairline(head, picture, edge, colour, top_deg=90.0):
    """Hair that thins out over some millimetres beyond a shell's edge."""
    low = np.interp(head.azimuth, [e[0] for e in edge], [e[1] for e in edge])
    above = head.elevation - low + 2.0 * head.locks
    mask = sf.smoothstep(-7.0, 2.0, above) * sf.smoothstep(top_deg + 6.0, top_deg - 2.0, head.elevation)
    return _mixed(picture, mask * head.there * 0.9, np.asarray(colour) * 0.8)


def _beard(head, picture, colour, strength, soft=1.0, upper_edge=BEARD_ABOVE, lower_edge=BEARD_BELOW):
    high = np.interp(head.azimuth, *np.array(upper_edge, float).T)
    low = np.interp(head.azimuth, *np.array(lower_edge, float).T)
    noise = 1.8 * head.locks
    mask = sf.smoothstep(3.5 * soft, -2.5 * soft, head.elevation - high + noise)
    mask = mask * sf.smoothstep(-8.0 * soft, 3.0, head.elevation - low + noise) * (head.azimuth < 95)
    lip = head.spot(0.0, head.mouth_z + 15.0, 24.0, 5.0)
    mask = np.maximum(mask, lip) * (1.0 - head.spot(0.0, head.mouth_z, 22.0, 6.0))
    return _mixed(picture, mask * head.there * strength * (0.9 + 0.2 * head.fine), colour)


def _aged(head, picture, age):
    """Furrows of the forehead, crow's feet, folds from nose to mouth, bags under the eyes."""
    e, mouth, nose = head.eye_x, head.mouth_z, head.nose_z
    lines = [([0, 22, 40], [34 + k * 8, 35 + k * 8, 31 + k * 8], 1.1, 0.22) for k in range(3)]
    lines += [([e + 19, e + 29], [2 + k * 3, 6 + k * 6 - 6], 0.9, 0.25) for k in (-1, 0, 1)]
    lines += [([13, 21, 27], [nose + 2, nose - 14, mouth - 4], 1.8, 0.30),
              ([e - 12, e, e + 13], [-11, -14.5, -11], 1.6, 0.26), ([3, 4], [14, 22], 1.0, 0.25)]
    shade = np.zeros(head.x.shape)
    for x, z, width, strength in lines:
        shade = np.maximum(shade, strength * head.line(x, z, width))
    return picture * (1.0 - age * shade[..., None] * np.array([0.8, 1.0, 1.05]))


def _features(head, picture, tone, rouge):
    """Lips, and blood where the skin is thin: cheeks, nose, ears; shade in the eyes' corners, lashes."""
    e, mouth, nose = head.eye_x, head.mouth_z, head.nose_z
    for x, z, rx, rz, share in ((e + 9, nose - 4, 17, 15, 0.20), (0, nose + 3, 9, 8, 0.20), (0, mouth - 26, 12, 9, 0.08)):
        red = share * (0.6 + 0.7 * rouge) * head.spot(x, z, rx, rz)
        picture = picture * (1.0 - red[..., None] * np.array([0.02, 0.62, 0.60]))
    lips = head.spot(0, mouth, 20, 7.5) ** 1.5
    picture = _mixed(picture, (0.50 + 0.38 * rouge) * lips, np.asarray(tone) * np.array([0.88, 0.55, 0.53]))
    socket = head.spot(e - 14, 4, 8, 10) * 0.16
    return picture * (1.0 - socket[..., None] * np.array([0.8, 1.0, 1.0]))


def skin_picture(figure, person, seed):
    """The finished picture (height, width, 3)."""
    random = np.random.default_rng([seed, 99])
    look, hair = person["skin"], np.asarray(person["cloth"]["hair"]["colour"])
    head = Head(figure, random)
    picture = complexion(figure.images["skin"], look["tone"], look.get("smooth", 0.5))
    picture = _features(head, picture, look["tone"], look.get("rouge", 0.0))
    picture = _aged(head, picture, look.get("age", 0.0))
    for wear in person["wear"]:
        if wear["piece"] == "shell" and wear.get("cell", "hair") == "hair":
            picture = _hairline(head, picture, wear["edge"], hair, wear.get("top_deg", 90))
        if wear["piece"] == "beard":
            edges = {key: wear[key] for key in SHAVEN if key in wear}
            picture = _beard(head, picture, hair * 0.85, 0.9, **edges)
    if look.get("stubble"):
        picture = _beard(head, picture, 0.35 * hair + 0.4 * np.asarray(look["tone"]), look["stubble"], 3.0)
    return np.clip(_brows(head, picture, look.get("brow", {}), hair), 0.0, 1.0)
