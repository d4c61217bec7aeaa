"""The skin's picture: a complexion over the source's own detail, and brows, lips, stubble, hairline and age painted
where they lie on the head, so that they follow whatever shape a head has.

`skin` in people.py: tone (sRGB), smooth (0 to 1: without the source's pores), rouge, stubble, age (0 to 1), and brow,
the shape of the eyebrows in millimetres on a head of 230 mm.
"""

import numpy as np

from townspeople import body, materials
from townspeople import surface as sf

SKIN_PX = 1024
FADED = 3.4  # radii of a soft patch: what lies farther out takes less than a 100,000th of its colour
BROW = {"rise": 15.0, "lift": 2.6, "arch": 2.2, "inner": -16.5, "outer": 23.5, "half": 3.0, "fall": 2.6, "strength": 0.85}
BEARD_ABOVE = ((0, -47), (12, -46), (22, -40), (30, -33), (45, -29), (60, -25), (76, -13), (92, 4))
BEARD_BELOW = ((0, -66), (40, -62), (62, -53), (78, -38), (92, -14))
SHAVEN = {"upper_edge": BEARD_ABOVE, "lower_edge": BEARD_BELOW}


def places_of_texels(figure, size_px):
    """The texels of the skin's picture that lie on the head, by number, and where on it each lies (metres)."""
    skin = figure.parts["body"]
    head = body.joint_share(figure, skin, ("head", "neck", "lids"))
    starts = sf.corner_starts(skin.faces)
    vertices, corners = [], []
    for face, start in zip(skin.faces, starts):
        if head[list(face)].mean() >= 0.2:
            for k in range(1, len(face) - 1):
                vertices.append((face[0], face[k], face[k + 1]))
                corners.append((start, start + k, start + k + 1))
    texels, places = _filled(skin.corner_uv[np.array(corners)] * size_px - 0.5, skin.vertices[np.array(vertices)], size_px)
    all_places = np.zeros((size_px * size_px, 3), np.float32)
    all_places[texels] = places  # where triangles overlap, the last one counts
    texels = np.unique(texels)
    return texels, all_places[texels]


def _filled(corners, points, size_px):
    """Texels of all triangles, each a texel wider than it is, so that no seam stays bare, and their places."""
    sides = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
    wide = np.abs(np.linalg.det(sides)) >= 1e-9
    corners, points, sides = corners[wide], points[wide], sides[wide]
    low = np.clip(np.floor(corners.min(axis=1)).astype(int) - 1, 0, size_px - 1)
    high = np.clip(np.ceil(corners.max(axis=1)).astype(int) + 2, 0, size_px)
    across, up = np.maximum(high - low, 0).T
    triangle = np.repeat(np.arange(len(low)), across * up)
    within = np.arange(len(triangle)) - np.repeat(np.cumsum(across * up) - across * up, across * up)
    x, y = low[triangle, 0] + within % across[triangle], low[triangle, 1] + within // across[triangle]
    off = np.stack([x - corners[triangle, 0, 0], y - corners[triangle, 0, 1]], axis=1)
    share = np.einsum("nij,nj->ni", np.linalg.inv(sides)[triangle], off)
    margin = (1.0 / np.sqrt(np.abs(np.linalg.det(sides))))[triangle]
    inside = (share.min(axis=1) >= -margin) & (share.sum(axis=1) <= 1.0 + margin)
    share, triangle = np.clip(share[inside], 0.0, 1.0), triangle[inside]
    ways = np.stack([points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]], axis=1)[triangle]
    places = points[triangle, 0] + share[:, :1] * ways[:, 0] + share[:, 1:] * ways[:, 1]
    return y[inside] * size_px + x[inside], places


class Head:
    """The head's texels, one after another, in the painter's coordinates, millimetres on a head of 230 mm: x from the
    middle outwards, y forward and z up from between the eyes; azimuth and elevation in degrees as edges of hair are
    given (headwear.py).
    """

    def __init__(self, figure, random):
        marks = figure.landmarks
        scale = (marks["crown"][2] - marks["chin"][2]) / 0.230
        self.texels, places = places_of_texels(figure, SKIN_PX)
        eyes = eye_centres(figure)
        self.eye_x = 1000.0 * 0.5 * (eyes[0][0] - eyes[1][0]) / scale
        middle = 0.5 * (eyes[0] + eyes[1])
        off = (places - middle.astype(np.float32)) * np.float32(1000.0 / scale)
        self.x, self.y, self.z = np.abs(off[:, 0]), -off[:, 1], off[:, 2].copy()
        self.mouth_z = 1000.0 * (marks["mouth"][2] - middle[2]) / scale
        self.nose_z = 1000.0 * (marks["nose"][2] - middle[2]) / scale
        rays = places - marks["head"].astype(np.float32)
        flat = np.hypot(rays[:, 0], rays[:, 1])
        self.azimuth = np.degrees(np.abs(np.arctan2(rays[:, 0], -rays[:, 1])))
        self.elevation = np.degrees(np.arctan2(rays[:, 2], np.maximum(flat, 1e-6)))
        self.fine, self.locks = (
            materials.value_noise(random, SKIN_PX, SKIN_PX, SKIN_PX // wide, SKIN_PX // wide).ravel()[self.texels].astype(np.float32)
            for wide in (3, 9)
        )

    def _near(self, x, z, reach_x, reach_z, least_y):
        """Texels of the face within a rectangle: elsewhere what is painted would not be seen."""
        return np.nonzero(
            (self.y > least_y) & (self.x > min(x) - reach_x) & (self.x < max(x) + reach_x)
            & (self.z > min(z) - reach_z) & (self.z < max(z) + reach_z)
        )[0]

    def spot(self, x, z, radius_x, radius_z):
        """A soft round patch, the same on both sides."""
        mask = np.zeros(len(self.x), np.float32)
        near = self._near([x], [z], FADED * radius_x, FADED * radius_z, -35.0)
        mask[near] = np.exp(-np.square((self.x[near] - x) / radius_x) - np.square((self.z[near] - z) / radius_z))
        return mask

    def line(self, x, z, width):
        """A soft line through points in the plane of the face."""
        mask = np.zeros(len(self.x), np.float32)
        near = self._near(x, z, FADED * width, FADED * width, -40.0)
        at_x, at_z, best = self.x[near], self.z[near], np.float32(1e9)
        for k in range(len(x) - 1):
            way_x, way_z = x[k + 1] - x[k], z[k + 1] - z[k]
            t = np.clip(((at_x - x[k]) * way_x + (at_z - z[k]) * way_z) / (way_x**2 + way_z**2), 0, 1)
            best = np.minimum(best, np.square(at_x - x[k] - t * way_x) + np.square(at_z - z[k] - t * way_z))
        mask[near] = np.exp(-best / width**2)
        return mask


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
    detail = picture / np.median(picture.reshape(-1, 3), axis=0)
    light = detail.mean(axis=2, keepdims=True)
    return (0.65 * light + 0.35 * detail) * np.asarray(tone, np.float32)


def _mixed(picture, share, colour):
    share = np.clip(share, 0.0, 1.0)[..., None]
    return picture * (1.0 - share) + np.asarray(colour, np.float32) * share


def _brows(head, picture, shape, colour):
    shape = dict(BROW, **shape)
    t = (head.x - np.float32(head.eye_x + shape["inner"])) / (shape["outer"] - shape["inner"])
    middle = shape["rise"] + shape["arch"] * np.sin(np.pi * np.clip(t * 0.8 + 0.1, 0, 1)) ** 2
    middle = middle + shape["lift"] * np.clip(t / 0.65, 0, 1)  # from the nose upwards: the other way round they look worried
    middle = middle - shape["fall"] * np.clip(t - 0.62, 0, 1) ** 1.3 * 3.0
    half = shape["half"] * np.interp(t, [0.0, 0.12, 0.45, 0.8, 1.0], [0.75, 1.0, 0.9, 0.6, 0.25])
    across = (head.z - middle + 0.5 * head.fine) / half
    mask = np.exp(-np.abs(across) ** 2.4) * sf.smoothstep(-0.04, 0.06, t) * sf.smoothstep(1.04, 0.85, t)
    mask = mask * (head.y > -30.0) * shape["strength"] * (0.85 + 0.3 * head.fine)
    return _mixed(picture, mask, np.asarray(colour) * 0.62)


def _hairline(head, picture, edge, colour, top_deg=90.0):
    """Hair that thins out over some millimetres beyond a shell's edge."""
    low = np.interp(head.azimuth, [e[0] for e in edge], [e[1] for e in edge])
    above = head.elevation - low + 2.0 * head.locks
    mask = sf.smoothstep(-7.0, 2.0, above) * sf.smoothstep(top_deg + 6.0, top_deg - 2.0, head.elevation)
    return _mixed(picture, mask * 0.9, np.asarray(colour) * 0.8)


def _beard(head, picture, colour, strength, soft=1.0, upper_edge=BEARD_ABOVE, lower_edge=BEARD_BELOW):
    high = np.interp(head.azimuth, *np.array(upper_edge, float).T)
    low = np.interp(head.azimuth, *np.array(lower_edge, float).T)
    noise = 1.8 * head.locks
    mask = sf.smoothstep(3.5 * soft, -2.5 * soft, head.elevation - high + noise)
    mask = mask * sf.smoothstep(-8.0 * soft, 3.0, head.elevation - low + noise) * (head.azimuth < 95)
    lip = head.spot(0.0, head.mouth_z + 15.0, 24.0, 5.0)
    mask = np.maximum(mask, lip) * (1.0 - head.spot(0.0, head.mouth_z, 22.0, 6.0))
    return _mixed(picture, mask * strength * (0.9 + 0.2 * head.fine), colour)


def _aged(head, picture, age):
    """Furrows of the forehead, crow's feet, folds from nose to mouth, bags under the eyes."""
    e, mouth, nose = head.eye_x, head.mouth_z, head.nose_z
    lines = [([0, 22, 40], [34 + k * 8, 35 + k * 8, 31 + k * 8], 1.7, 0.15) for k in range(3)]
    lines += [([e + 19, e + 29], [2 + k * 3, 6 + k * 6 - 6], 1.2, 0.16) for k in (-1, 0, 1)]
    lines += [([13, 21, 27], [nose + 2, nose - 14, mouth - 4], 1.8, 0.30),
              ([e - 12, e, e + 13], [-11, -14.5, -11], 1.6, 0.26), ([3.5, 4], [14, 20], 1.4, 0.13)]
    shade = np.zeros(head.x.shape, np.float32)
    for x, z, width, strength in lines:
        shade = np.maximum(shade, strength * head.line(x, z, width))
    return picture * (1.0 - age * shade[..., None] * np.array([0.9, 1.0, 1.0], np.float32))


def _features(head, picture, tone, rouge):
    """Lips, and blood where the skin is thin: cheeks, nose, ears; shade in the eyes' corners, lashes."""
    e, mouth, nose = head.eye_x, head.mouth_z, head.nose_z
    for x, z, rx, rz, share in ((e + 9, nose - 3, 21, 17, 0.15), (0, nose + 3, 9, 8, 0.12), (0, mouth - 26, 12, 9, 0.08)):
        red = share * (0.6 + 0.7 * rouge) * head.spot(x, z, rx, rz)
        picture = picture * (1.0 - red[..., None] * np.array([0.02, 0.62, 0.60], np.float32))
    lips = np.exp(-(np.square(head.x / 24) + np.square((head.z - mouth + 1.5) / 9.5)) ** 2) * (head.y > -35.0)
    picture = _mixed(picture, (0.42 + 0.30 * rouge) * lips, np.asarray(tone) * np.array([0.88, 0.55, 0.53]))
    socket = head.spot(e - 14, 4, 8, 10) * 0.16
    return picture * (1.0 - socket[..., None] * np.array([0.8, 1.0, 1.0], np.float32))


def skin_picture(figure, person, seed):
    """The finished picture (height, width, 3)."""
    random = np.random.default_rng([seed, 99])
    look, hair = person["skin"], np.asarray(person["cloth"]["hair"]["colour"])
    head = Head(figure, random)
    whole = complexion(figure.images["skin"], look["tone"], look.get("smooth", 0.5))
    painted = whole.reshape(-1, 3)[head.texels]
    whole.reshape(-1, 3)[head.texels] = _painted(head, painted, person, look, hair)
    return np.clip(whole, 0.0, 1.0)


def _painted(head, picture, person, look, hair):
    picture = _features(head, picture, look["tone"], look.get("rouge", 0.0))
    if look.get("age"):
        picture = _aged(head, picture, look["age"])
    for wear in person["wear"]:
        if wear["piece"] == "shell" and wear.get("cell", "hair") == "hair":
            picture = _hairline(head, picture, wear["edge"], hair, wear.get("top_deg", 90))
        if wear["piece"] == "beard":
            edges = {key: wear[key] for key in SHAVEN if key in wear}
            picture = _beard(head, picture, hair * 0.85, 0.9, **edges)
    if look.get("stubble"):
        picture = _beard(head, picture, 0.35 * hair + 0.4 * np.asarray(look["tone"]), look["stubble"], 3.0)
    return _brows(head, picture, look.get("brow", {}), hair)
