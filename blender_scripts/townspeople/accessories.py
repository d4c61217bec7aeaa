"""What is worn over the garments: belts, aprons, capes, cloaks, collars. Lengths as in
garments.py.
"""

import numpy as np

from townspeople import clearance
from townspeople import surface as sf
from townspeople import tailor as tl


def belt(tailor, name, at, height=0.04, thickness=0.010, ease=0.004, columns=40, cell="belt"):
    """A band about the waist, over everything worn so far."""
    size, z = tailor.size, tailor.height(at)
    angles = tl.angles_of(columns)
    tree = tl.trunk_tree(tailor, arms=False)
    centre = np.array([0.0, tl.axis_y(tailor, z), z])
    half = 0.5 * height * size
    rings = []
    for dz in (half, 0.0, -half):
        reach = [
            sf.outermost(tree, centre + [0, 0, dz], ray, 0.6) or 0.15
            for ray in tl.direction(angles)
        ]
        rings.append(tl.circular_blur(np.array(reach), 1))
    high, middle, low = (np.maximum(ring, rings[1] - half) + ease * size for ring in rings)
    bevel = 0.12 * half
    shape = (
        (half, high, -0.012),
        (half, high, thickness - 0.003),
        (half - bevel, high, thickness),
        (0.0, middle, thickness),
        (bevel - half, low, thickness),
        (-half, low, thickness - 0.003),
        (-half, low, -0.006),
    )
    points = np.array(
        [
            centre + np.array([0, 0, dz]) + tl.direction(angles) * (reach + out * size)[:, None]
            for dz, reach, out in shape
        ]
    )
    weights = tl.as_worn(tailor, points.reshape(-1, 3)).reshape(len(shape), columns, -1)
    points[1:6] += _room_in_every_pose(tailor, points[1:6], weights[1:6], centre[2])
    tailor.worn["belt " + name] = sf.grid(
        points, weights, cell, sf.mirrored_u(angles), [0.0, 0.15, 0.2, 0.5, 0.8, 0.85, 1.0]
    )


def _room_in_every_pose(tailor, points, weights, z):
    """How far a band's rows have to go out, all alike, for a belly that moves not to come through."""
    size = tailor.size
    worn = tl.beneath(tailor, ("upper", "skirt", "plate"))
    if worn is None:
        return 0.0
    near = sf.face_least(np.abs(worn.vertices[:, 2] - z) < 0.08 * size, worn.faces)
    if not near.any():
        return 0.0
    inner = sf.keep_faces(worn, near)
    ways = tl.outward_of(tailor, points)
    moved = clearance.cleared(points, weights, ways, inner, tailor.poses, 0.003 * size, 0.012 * size)
    return ways * np.linalg.norm(moved - points, axis=-1).max(axis=0)[:, None]


def cord(tailor, name, start, end, angle_deg, radius=0.011, out=0.02, cell="belt"):
    """A rope's hanging ends: a thin tube on the skirt's surface from height `start` to `end`."""
    size, angle = tailor.size, np.radians(angle_deg)
    tree = tl.trunk_tree(tailor, arms=False)
    heights = np.linspace(tailor.height(start), tailor.height(end), 9)
    ray = tl.direction(angle)
    reach = [sf.outermost(tree, (0.0, tl.axis_y(tailor, z), z), ray, 0.8) or 0.15 for z in heights]
    reach = np.maximum.accumulate(np.array(reach)) + out * size
    around = tl.angles_of(6)
    rings = []
    for row, (z, distance) in enumerate(zip(heights, reach)):
        swell = 1.6 if row == len(heights) - 2 else 1.0
        centre = np.array([0.0, tl.axis_y(tailor, z), z]) + ray * distance
        rings.append(centre + tl.direction(around) * radius * size * swell)
    points = np.array(rings)
    weights = tl.as_worn(tailor, points.mean(axis=1))[:, None].repeat(len(around), axis=1)
    tailor.worn["cord " + name] = sf.grid(points, weights, cell, sf.mirrored_u(around))


def pouch(tailor, name, at, angle_deg, width=0.10, depth=0.055, height=0.13, out=0.02, cell="belt"):
    """A purse that hangs on the belt: a rounded box."""
    size, angle, z = tailor.size, np.radians(angle_deg), tailor.height(at)
    tree = tl.trunk_tree(tailor, arms=False)
    ray = tl.direction(angle)
    low = z - height * size
    reach = max(
        sf.outermost(tree, (0.0, tl.axis_y(tailor, y), y), ray, 0.8) or 0.15 for y in (z, low)
    )
    centre = np.array([0.0, tl.axis_y(tailor, z), z]) + ray * (reach + out * size)
    side = np.array([-ray[1], ray[0], 0.0])
    around = tl.angles_of(10)
    rings = []
    for t, scale in ((0.0, 0.55), (0.12, 0.75), (0.5, 0.95), (0.8, 1.0), (0.95, 0.8), (1.0, 0.3)):
        ring = (
            (np.cos(around)[:, None] * side * width + np.sin(around)[:, None] * ray * depth)
            * 0.5
            * scale
        )
        rings.append(centre + ring * size - np.array([0, 0, t * height * size]))
    points = np.array(rings)
    weights = np.tile(tl.as_worn(tailor, centre[None])[0], points.shape[:2] + (1,))
    tailor.worn["pouch " + name] = sf.grid(points, weights, cell, np.full(10, 0.5))


def apron(
    tailor,
    name,
    over,
    hem_row=0.9,
    half_angle_deg=62,
    lift=0.012,
    bib_top=None,
    bib_half_angle_deg=38,
    cell="apron",
):
    """A cloth over the front of a skirt that is worn already, with a bib where `bib_top` is a
    place.
    """
    points, weights, angles = tailor.grids[over]
    size = tailor.size
    signed = (angles + np.pi) % (2 * np.pi) - np.pi
    order = [c for c in np.argsort(signed) if abs(signed[c]) <= np.radians(half_angle_deg)]
    rows = max(int(round(hem_row * (len(points) - 1))), 2) + 1
    cut, weights = points[:rows, order], weights[:rows, order]
    axis = cut.copy()
    axis[..., 0], axis[..., 1] = (
        0.0,
        np.array([tl.axis_y(tailor, z) for z in cut[:, 0, 2]])[:, None],
    )
    outward = (cut - axis) / np.linalg.norm(cut - axis, axis=2, keepdims=True)
    layer = cut + outward * lift * size
    u_columns = sf.mirrored_u(signed[order]) * 180.0 / half_angle_deg
    sheet = sf.grid(
        layer,
        weights,
        cell,
        u_columns,
        np.linspace(0.3 if bib_top else 0.0, 1.0, rows),
        closed=False,
    )
    tailor.worn["skirt apron " + name] = sf.lined(
        sheet, len(order), rows, False, 0.006 * size, cell
    )
    if bib_top:
        _bib(
            tailor,
            name,
            tailor.height(bib_top),
            layer[0, :, 2].mean(),
            bib_half_angle_deg,
            lift,
            cell,
        )


def _bib(tailor, name, top, bottom, half_angle_deg, lift, cell):
    angles = np.radians(np.linspace(-half_angle_deg, half_angle_deg, 13))
    heights = np.linspace(top, bottom - 0.02 * tailor.size, 8)
    tree = tl.trunk_tree(tailor, arms=False)
    rows = []
    for z in heights:
        centre = np.array([0.0, tl.axis_y(tailor, z), z])
        reach = np.array(
            [sf.outermost(tree, centre, ray, 0.6) or 0.12 for ray in tl.direction(angles)]
        )
        reach = tl.circular_blur(reach, 2, closed=False) + lift * tailor.size
        rows.append(centre + tl.direction(angles) * reach[:, None])
    points = np.array(rows)
    weights = tl.transferred(tailor, points.reshape(-1, 3), tailor.figure.parts["shirt"], 1.0)
    weights = weights.reshape(len(rows), len(angles), -1)
    sheet = sf.grid(
        points,
        weights,
        cell,
        sf.mirrored_u(angles) * 180.0 / half_angle_deg,
        np.linspace(0.0, 0.32, len(rows)),
        closed=False,
    )
    bib = sf.lined(sheet, len(angles), len(rows), False, 0.006 * tailor.size, cell)
    loop = [_bib_strap(tailor, tree, points[0, column], lift, cell) for column in (0, -1)]
    tailor.worn["upper bib " + name] = sf.joined([bib] + loop)


def _bib_strap(tailor, tree, corner, lift, cell, half_width=0.011):
    """From a bib's corner over the shoulder until it is beside the neck, under a collar."""
    size, centre = tailor.size, _shoulder_centre(tailor)
    side = np.sign(corner[0])
    start, end = corner - centre, tl.direction(np.radians(side * 88)) + [0, 0, 2.0]
    turns = np.linspace(start / np.linalg.norm(start), end / np.linalg.norm(end), 10)
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    reach = np.array([sf.outermost(tree, centre, ray, 0.6) or 0.12 for ray in turns])
    reach = tl.circular_blur(reach, 1, closed=False) + lift * size * np.linspace(0.7, 0.25, len(turns))
    reach[0] = np.linalg.norm(start)
    spine = centre + turns * reach[:, None]
    across = np.cross(turns, np.gradient(spine, axis=0)) * side
    across *= half_width * size / np.linalg.norm(across, axis=1, keepdims=True)
    points = np.stack([spine + across, spine - across])
    weights = tl.transferred(tailor, points.reshape(-1, 3), tailor.figure.parts["shirt"], 1.0)
    sheet = sf.grid(points, weights.reshape(points.shape[:2] + (-1,)), cell, np.linspace(0.0, 1.0, len(spine)),
                    np.array([0.02, 0.06]), closed=False)
    return sf.lined(sheet, len(spine), 2, False, 0.004 * size, cell)


def _shoulder_centre(tailor):
    z = tailor.height(("shoulder", -0.17))
    return np.array([0.0, tl.axis_y(tailor, z), z])


def cape(
    tailor,
    name,
    top_deg=64,
    bottom_deg=0,
    ease=0.022,
    hem=None,
    open_deg=0,
    flare=0.1,
    folds=9,
    fold_depth=0.02,
    columns=40,
    hang_rows=6,
    calm_arms=0.55,
    stand_off=0.12,
    point=0.0,
    tuck=0.0,
    lining=None,
    cell="cape",
):
    """Cloth draped over the shoulders: collar, shawl, shoulder cape, or cloak.

    It starts at the neck `top_deg` above the chest's middle and comes down to `bottom_deg`; from
    there it hangs to the place `hem`, where given. open_deg: half the opening in front. point:
    lowers front and back. stand_off: how far at most it is pushed off what moves beneath it. tuck: how far
    its upper edge turns in, where a roll lies in it and nobody should look between the two.
    """
    size = tailor.size
    angles = _opened_angles(columns, open_deg)
    centre = _shoulder_centre(tailor)
    elevations = np.linspace(top_deg, bottom_deg, 9)
    eases = size * ease * np.linspace(0.35, 1.0, len(elevations))
    tree = tl.trunk_tree(tailor, arms=True)
    points = tl.star_rows(tree, centre, angles, elevations, eases, 0.2 * size)
    if point:
        share = np.linspace(0.0, 1.0, len(points))[:, None] ** 2
        points[..., 2] -= share * point * size * np.abs(np.cos(angles))[None] ** 3
    if hem is not None:
        points = _hung(
            tailor, points, angles, tailor.height(hem), flare, folds, fold_depth, hang_rows
        )
    closed = open_deg == 0
    kinds = ("upper", "plate", "skirt", "belt", "body")
    tree = sf.tree_of([tl.beneath(tailor, kinds)])
    flat = clearance.pushed_out(points.reshape(-1, 3), tree, 0.4 * ease * size)
    weights = _cape_weights(tailor, flat, calm_arms, hem is not None).reshape(*points.shape[:2], -1)
    points = flat.reshape(points.shape)
    points = clearance.cleared(
        points,
        weights,
        _away(points, centre),
        tl.beneath(tailor, kinds),
        tailor.poses,
        0.022 * size,
        stand_off * size,
        closed,
    )
    tailor.grids[name] = (points, weights, angles)
    if tuck:
        inwards = (points[0].mean(axis=0) - points[0]) * [1, 1, 0]
        inwards *= tuck * size / np.linalg.norm(inwards, axis=1, keepdims=True)
        points = np.concatenate([[points[0] + inwards - [0, 0, 0.4 * tuck * size]], points])
        weights = np.concatenate([weights[:1], weights])
    sheet = sf.grid(points, weights, cell, sf.mirrored_u(angles), closed=closed)
    tailor.worn["cape " + name] = sf.lined(
        sheet, columns, len(points), closed, 0.004 * size, lining or cell
    )


def _away(points, centre):
    """Unit vectors from the chest's middle, level below it."""
    ways = points - centre
    ways[..., 2] = np.maximum(ways[..., 2], 0.0)
    return ways / np.linalg.norm(ways, axis=-1, keepdims=True)


def _opened_angles(columns, open_deg):
    if open_deg == 0:
        return tl.angles_of(columns)
    return np.linspace(np.radians(open_deg), 2 * np.pi - np.radians(open_deg), columns)


def _hung(tailor, points, angles, z_hem, flare, folds, fold_depth, rows):
    """Rows that hang from the last one down to z_hem."""
    size, edge = tailor.size, points[-1]
    behind = angles[0] > np.radians(100)  # the arms are beside it, not under it
    cloud = tl.slice_points(tailor, arms=not behind, skirts=True)
    wave = tl.fold_wave(tailor.random, angles, folds)
    inside = sf.smoothstep(0.0, 0.9, np.minimum(angles - angles[0], angles[-1] - angles))  # of an opening's edges
    loose = inside if angles[0] > 0 else np.ones_like(angles)
    reach = np.linalg.norm(edge[:, :2] - [0.0, tl.axis_y(tailor, edge[:, 2].mean())], axis=1)
    z_edge, added = edge[:, 2].mean(), []
    for t in np.linspace(0.0, 1.0, rows + 1)[1:]:
        z = edge[:, 2] + (z_hem - edge[:, 2]) * t
        outline = tl.slice_radii(tailor, cloud, z.mean(), angles)
        if outline is not None:
            reach = np.maximum(reach * 0.985, outline + 0.02 * size)
        fall = (z_edge - z.mean()) / size
        radii = reach + flare * size * fall * loose
        radii = radii + fold_depth * size * (wave - 0.35) * min(fall / 0.3, 1.0) * (0.3 + 0.7 * loose)
        base = np.stack([np.zeros_like(z), np.full_like(z, tl.axis_y(tailor, z.mean())), z], axis=1)
        added.append(base + tl.direction(angles) * radii[:, None])
    return np.concatenate([points, np.array(added)])


def _cape_weights(tailor, points, calm_arms, hangs):
    worn = sf.joined([tailor.figure.parts["shirt"]])
    weights = tl.transferred(tailor, points, worn, calm_arms)
    if not hangs:
        return weights
    below = (
        1.0
        - sf.smoothstep(tailor.height("chest"), tailor.height("shoulder"), points[:, 2])[:, None]
    )
    skirted = [grid for key, grid in tailor.grids.items() if "skirt " + key in tailor.worn]
    hanging = tl.hanging_weights(tailor, points, 0.55, 0.2)
    if skirted:  # cloth on cloth moves alike
        low = sf.smoothstep(tailor.height("hip"), tailor.height("crotch"), points[:, 2])[:, None]
        hanging = hanging * (1 - low) + tl.as_worn(tailor, points, ("skirt",)) * low
    return weights * (1 - below) + hanging * below


def collar(tailor, name, height=0.045, flare=0.010, cell="collar"):
    """A standing collar about the neck."""
    _neck_rings(
        tailor,
        name,
        [
            (-0.055, 0.010),
            (0.0, 0.006),
            (height, 0.006 + flare),
            (height, flare - 0.006),
            (0.005, -0.004),
        ],
        cell,
    )


def roll(tailor, name, thickness=0.030, cell="cape"):
    """Cloth bunched about the neck: a hood that is down, a kerchief."""
    _neck_rings(
        tailor,
        name,
        [
            (-0.035, thickness * 0.8),
            (-0.012, thickness * 1.35),
            (0.012, thickness * 1.3),
            (0.028, thickness * 0.8),
            (0.022, 0.004),
            (-0.02, 0.0),
        ],
        cell,
    )


def _neck_rings(tailor, name, shape, cell, columns=28):
    """Rings about the neck: (height above its foot, distance from the skin)."""
    size = tailor.size
    angles = tl.angles_of(columns)
    tree = sf.tree_of([tailor.figure.parts["body"]])
    base = tailor.height(("neck", -0.015))
    low, high = tailor.figure.landmarks["shoulder"], tailor.figure.landmarks["neck"]
    neck = np.array([sf.outermost(tree, high, ray, 0.12 * size) or 0.06 * size for ray in tl.direction(angles)])
    rows = []
    for up, out in shape:
        centre = low + (high - low) * ((base + up * size - low[2]) / (high[2] - low[2]))
        tilt = 0.022 * size * np.cos(angles)
        reach = neck
        if up < 0:  # the neck widens towards the shoulders
            own = np.array([sf.outermost(tree, centre - [0, 0, t], ray, 0.12 * size) or 0.0 for t, ray in zip(tilt, tl.direction(angles))])
            reach = np.clip(own, neck, neck + 0.03 * size)
        ring = centre + tl.direction(angles) * (tl.circular_blur(reach, 3) + out * size)[:, None]
        ring[:, 2] = base + up * size - tilt
        rows.append(ring)
    points = np.array(rows)
    weights = np.zeros(points.shape[:2] + (len(tailor.figure.skeleton.names),))
    weights[..., tailor.column("spine01")] = 0.6
    weights[..., tailor.column("neck01")] = 0.4
    tailor.worn["neck " + name] = sf.grid(points, weights, cell, sf.mirrored_u(angles))


def ruff(tailor, name, width=0.062, height=0.032, pleats=22, lift=0.010, cell="collar"):
    """A pleated ruff that lies about the neck: a figure-of-eight frill whose inside begins at the skin."""
    size, columns = tailor.size, pleats * 4
    angles = tl.angles_of(columns)
    tree = sf.tree_of([tailor.figure.parts["body"]])
    low, high = tailor.figure.landmarks["shoulder"], tailor.figure.landmarks["neck"]
    base = high[2] + lift * size
    middle = low + (high - low) * ((base - low[2]) / (high[2] - low[2]))
    reach = [sf.outermost(tree, middle, ray, 0.11 * size) or 0.06 * size for ray in tl.direction(angles)]
    reach = np.clip(tl.circular_blur(np.array(reach), 6), 0.045 * size, 0.075 * size)
    frill = 1.35 * np.sin(pleats * angles + 0.25 * np.pi) * (0.9 + 0.1 * np.cos(7 * angles))
    rows = []
    for t in (0.0, 0.4, 0.75, 1.0):
        radius = reach - 0.004 * size + width * size * t
        ring = middle + tl.direction(angles) * radius[:, None]
        swell = 0.5 * height * min(0.3 + t * 1.3, 1.0) * frill
        droop = 0.006 * t - 0.016 * np.maximum(np.cos(angles), -0.1) * (0.6 + 0.4 * t)  # lower before the chin than behind
        ring[:, 2] = base + (swell + droop) * size
        rows.append(ring)
    points = np.array(rows)
    weights = np.zeros(points.shape[:2] + (len(tailor.figure.skeleton.names),))
    weights[..., tailor.column("spine01")] = 0.5
    weights[..., tailor.column("neck01")] = 0.5
    tailor.worn["neck " + name] = sf.grid(points, weights, cell, sf.mirrored_u(angles))
