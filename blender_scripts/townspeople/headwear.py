"""Hair, beards, coifs, hoods and hats: shells about the head. Lengths as in garments.py.

Edges are given as [azimuth, elevation] pairs in degrees as seen from the head's middle: azimuth 0
is forward and 180 behind (both sides alike), elevation 90 the crown.
"""

import numpy as np

from townspeople import clearance
from townspeople import surface as sf
from townspeople import tailor as tl
from townspeople.face import BEARD_ABOVE, BEARD_BELOW


def _head_size(tailor):
    """Head height against the source's."""
    marks = tailor.figure.landmarks
    return (marks["crown"][2] - marks["chin"][2]) / 0.230


def _head_tree(tailor):
    body = tailor.figure.parts["body"]
    return sf.tree_of(
        [
            sf.keep_faces(
                body,
                [
                    body.vertices[list(face), 2].max() > tailor.height(("neck", -0.08))
                    for face in body.faces
                ],
            )
        ]
    )


def _dressed_head_tree(tailor):
    """The head with the hair on it: what a coif or hood goes over."""
    hair = [worn for name, worn in tailor.worn.items() if name.startswith("hair")]
    body = tailor.figure.parts["body"]
    low = tailor.height(("neck", -0.08))
    head = sf.keep_faces(body, [body.vertices[list(face), 2].max() > low for face in body.faces])
    return sf.tree_of([head] + hair)


def _edge(pairs, angles):
    azimuth = np.degrees(sf.mirrored_u(angles) * np.pi)
    return np.interp(azimuth, [pair[0] for pair in pairs], [pair[1] for pair in pairs])


def _carried(tailor, points, neck_below=True):
    """Weights: all on the head; below the chin more and more on the neck."""
    weights = np.zeros(points.shape[:-1] + (len(tailor.figure.skeleton.names),))
    share = np.ones(points.shape[:-1])
    if neck_below:
        share = sf.smoothstep(
            tailor.height(("neck", -0.02)), tailor.height(("chin", 0.02)), points[..., 2]
        )
    weights[..., tailor.column("head")] = share
    weights[..., tailor.column("neck01")] = (1 - share) * 0.5
    weights[..., tailor.column("spine01")] = (1 - share) * 0.5
    return weights


def shell(
    tailor,
    name,
    edge,
    thickness,
    crown_thickness=None,
    rows=8,
    columns=32,
    roughness=0.0,
    tuck=0.012,
    peak=0.0,
    nape=0.0,
    drop=0.0,
    top_deg=90,
    cell="hair",
):
    """A cap that follows the head from `edge` to the crown: hair, coif, hood.

    thickness at the edge, crown_thickness on top; roughness: height of random locks; peak
    lengthens the top backwards; nape pushes the lower back outwards; drop lengthens sides and back
    straight down; below 90, top_deg leaves the crown bald down to that elevation.
    """
    size = _head_size(tailor)
    crown_thickness = thickness if crown_thickness is None else crown_thickness
    angles = tl.angles_of(columns)
    centre, tree = tailor.figure.landmarks["head"], _dressed_head_tree(tailor)
    low = _edge(edge, angles)
    random_rows = tailor.random.uniform(-1.0, 1.0, (rows + 1, columns))
    points = []
    for r, t in enumerate(np.linspace(0.0, 1.0, rows + 1)):
        elevation = np.radians(top_deg + (low - top_deg) * t)
        rays = tl.direction(angles) * np.cos(elevation)[:, None]
        rays[:, 2] = np.sin(elevation)
        reach = np.array([sf.outermost(tree, centre, ray, 0.5) or 0.09 * size for ray in rays])
        reach = tl.circular_blur(reach, 2)
        back = np.clip(-np.cos(angles), 0.0, 1.0)
        extra = crown_thickness + (thickness - crown_thickness) * t**1.5
        extra = extra + roughness * random_rows[r] + peak * back * np.sin(np.pi * min(t * 1.6, 1.0))
        extra = extra + nape * back * t**2
        if top_deg < 90 and r == 0:
            extra = np.full(columns, -0.004)
        points.append(centre + rays * (reach + extra * size)[:, None])
    if drop:
        away = tl.direction(angles) * 0.4
        share = (
            0.05
            + 0.95 * sf.smoothstep(45.0, 80.0, np.degrees(sf.mirrored_u(angles) * np.pi))[:, None]
        )
        for t in (0.33, 0.67, 1.0):
            points.append(
                points[rows] + share * drop * size * t * (away * t - np.array([0.0, 0.0, 1.0]))
            )
    last = points[-1]
    inward = (centre - last) / np.linalg.norm(centre - last, axis=1, keepdims=True)
    points.append(last + inward * (thickness + tuck) * size * 0.8 + np.array([0, 0, 0.004]) * size)
    points = np.array(points)
    if top_deg == 90:
        points[0] = points[0].mean(axis=0)
    tailor.worn["hair " + name] = sf.grid(
        points, _carried(tailor, points), cell, sf.mirrored_u(angles), pole=top_deg == 90
    )


def beard(
    tailor,
    name,
    thickness=0.013,
    length=0.0,
    upper_edge=BEARD_ABOVE,
    lower_edge=BEARD_BELOW,
    cell="hair",
):
    """Hair over jaw and chin; `length` draws the chin's part down."""
    size = _head_size(tailor)
    angles = np.radians(np.linspace(-92, 92, 25))
    centre, tree = tailor.figure.landmarks["head"], _head_tree(tailor)
    high, low = _edge(upper_edge, angles), _edge(lower_edge, angles)
    random_rows = tailor.random.uniform(-1.0, 1.0, (7, len(angles)))
    front = np.clip(np.cos(angles), 0.0, 1.0) ** 3
    points = []
    for r, t in enumerate(np.linspace(0.0, 1.0, 7)):
        elevation = np.radians(high + (low - high) * t)
        rays = tl.direction(angles) * np.cos(elevation)[:, None]
        rays[:, 2] = np.sin(elevation)
        reach = np.array([sf.outermost(tree, centre, ray, 0.5) or 0.09 * size for ray in rays])
        bump = np.sqrt(np.sin(np.pi * t) * np.sin(np.pi * np.linspace(0.0, 1.0, len(angles))))
        extra = thickness * 1.1 * bump + 0.002 * random_rows[r] * bump - 0.003
        evened = tl.circular_blur(reach, 1, closed=False)
        reach += np.minimum(2.5 * bump, 1.0) * (evened - reach)  # edges sink into the very skin
        ring = centre + rays * (reach + extra * size)[:, None]
        ring[:, 2] -= length * size * front * t**1.5
        ring[:, 1] -= 0.3 * length * size * front * t
        points.append(ring)
    points = np.array(points)
    tailor.worn["hair " + name] = sf.grid(
        points, _carried(tailor, points, False), cell, sf.mirrored_u(angles), closed=False
    )


def moustache(tailor, name, thickness=0.010, cell="hair"):
    """A strip between nose and mouth."""
    size = _head_size(tailor)
    angles = np.radians(np.linspace(-26, 26, 11))
    centre, tree = tailor.figure.landmarks["head"], _head_tree(tailor)
    droop = 8.0 * (np.abs(angles) / angles[-1]) ** 2
    points = []
    for t in np.linspace(0.0, 1.0, 4):
        elevation = np.radians(-30.5 - 6.0 * t - droop)
        rays = tl.direction(angles) * np.cos(elevation)[:, None]
        rays[:, 2] = np.sin(elevation)
        reach = np.array([sf.outermost(tree, centre, ray, 0.5) or 0.09 * size for ray in rays])
        taper = 1.0 - 0.75 * (np.abs(angles) / angles[-1]) ** 2
        extra = thickness * np.sin(np.pi * (0.15 + 0.7 * t)) * taper - 0.002
        points.append(centre + rays * (reach + extra * size)[:, None])
    points = np.array(points)
    tailor.worn["hair " + name] = sf.grid(
        points, _carried(tailor, points, False), cell, sf.mirrored_u(angles), closed=False
    )


def _raised(points, covers, band, size):
    """The crown lifted off the hair: each ring moves evenly, so that the hat stays round."""
    above = [
        sf.keep_faces(
            part,
            [part.vertices[list(face), 2].min() > band[2] + 0.01 * size for face in part.faces],
        )
        for part in covers
    ]
    moved = clearance.pushed_out(
        points.reshape(-1, 3), sf.tree_of(above), 0.006 * size, 0.09
    ).reshape(points.shape)
    ways = points - band
    ways[..., 2] = np.maximum(ways[..., 2], 0.0) + 1e-6
    ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
    lift = np.maximum(((moved - points) * ways).sum(axis=-1), 0.0).max(axis=1)
    lift[points[..., 2].mean(axis=1) < band[2] + 0.01 * size] = 0.0
    lift = np.maximum(lift, np.concatenate([lift[1:], [0.0]]) * 0.7)
    return points + ways * lift[:, None, None]


def hat(
    tailor, name, profile, sit=0.030, tilt_deg=-4, ease=0.012, columns=28, wave=0.0, cell="hat"
):
    """A hat or helmet turned about the head's axis.

    profile: [fraction of the head's outline, extra radius, height above the hat band] from the
    crown's middle outwards and down. sit: height of the hat band above the brow.
    """
    size = _head_size(tailor)
    angles = tl.angles_of(columns)
    brow, centre = tailor.figure.landmarks["brow"], tailor.figure.landmarks["head"]
    band = np.array([0.0, centre[1], brow[2] + sit * size])
    body = tailor.figure.parts["body"]
    covers = [body] + [worn for key, worn in tailor.worn.items() if key.startswith("hair")]
    cloud = np.concatenate([part.vertices for part in covers])
    near = cloud[np.abs(cloud[:, 2] - band[2]) < 0.02 * size]
    outline = tl.circular_blur(sf.hull_radii(near[:, :2] - band[:2], angles), 2) + ease * size
    rings = []
    for fraction, extra, up in profile:
        ring = band + tl.direction(angles) * (outline * fraction + extra * size)[:, None]
        ring[:, 2] += up * size + wave * size * np.cos(2 * angles) * min(extra / 0.1, 1.0)
        rings.append(ring)
    points = np.array(rings)
    angle = np.radians(tilt_deg)
    turn = np.array(
        [[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]]
    )
    points = (points - band) @ turn.T + band
    points = _raised(points, covers, band, size)
    pole = profile[0][0] == 0 and profile[0][1] == 0
    weights = np.zeros(points.shape[:2] + (len(tailor.figure.skeleton.names),))
    weights[..., tailor.column("head")] = 1.0
    tailor.worn["head " + name] = sf.grid(points, weights, cell, sf.mirrored_u(angles), pole=pole)


def feather(tailor, name, azimuth_deg=75, length=0.26, sit=0.03, width=0.065, cell="collar"):
    """A plume on the hat's side, swept back over the brim."""
    size, angle = _head_size(tailor), np.radians(azimuth_deg)
    brow, centre = tailor.figure.landmarks["brow"], tailor.figure.landmarks["head"]
    foot = np.array([0.0, centre[1], brow[2] + sit * size]) + tl.direction(angle) * 0.118 * size
    rows = []
    for t in np.linspace(0.0, 1.0, 9):
        bend = 1.9 * t
        spine = (
            foot
            + np.array(
                [
                    0.015 * t,
                    length * (0.25 * t + 0.6 * t * t),
                    length * 0.55 * np.sin(bend) * (1.0 - 0.25 * t),
                ]
            )
            * size
        )
        half = 0.5 * width * size * np.sin(np.pi * (0.10 + 0.84 * t)) ** 0.7
        across = np.array([0.35, -np.sin(bend) * 0.6, 0.9])
        across /= np.linalg.norm(across)
        rows.append(
            [spine + across * half, spine + np.array([0.014, 0, 0]) * size, spine - across * half]
        )
    points = np.array(rows)
    weights = np.zeros(points.shape[:2] + (len(tailor.figure.skeleton.names),))
    weights[..., tailor.column("head")] = 1.0
    tailor.worn["head " + name] = sf.grid(
        points, weights, cell, np.array([0.2, 0.5, 0.8]), closed=False
    )
