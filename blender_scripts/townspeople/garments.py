"""Garments over trunk, arms and legs. Each function takes the tailor and plain data, and adds
Surfaces to what is worn. Lengths are metres on a figure of 1.7 m.
"""

import numpy as np

from townspeople import clearance
from townspeople import skeleton as sk
from townspeople import surface as sf
from townspeople import tailor as tl
from townspeople.body import joint_share


WAISTBAND_M = 0.10  # below a skirt's top, within which it comes to hang freely
WIDE_HEM_M = 0.06  # radius of a sleeve's end that one can look into


def upper(
    tailor, name, bottom, ease=0.008, smooth=8, sleeve=None, cell="upper", sleeve_cell="sleeve"
):
    """Bodice, doublet or the top of a tunic: from the neck to `bottom`, with sleeves.

    sleeve: list of [place, radius] along the arm; place 0 shoulder, 1 elbow, 2 wrist. None:
    sleeveless.
    """
    figure, size = tailor.figure, tailor.size
    base = sf.offset(sf.smoothed(figure.parts["shirt"], smooth), ease * size)
    arm = joint_share(figure, base, tl.ARM_JOINTS)
    z_bottom = tailor.height(bottom)
    keep = base_above(base, z_bottom)
    if sleeve is None:
        keep &= sf.face_means(arm, base.faces) < 0.5
    base = sf.keep_faces(base, keep)
    is_arm = sf.face_means(joint_share(figure, base, tl.ARM_JOINTS), base.faces) > 0.5
    base = _trunk_mapping(tailor, base, is_arm, z_bottom, cell, sleeve_cell)
    if sleeve is not None:
        for side in ("_L", "_R"):
            base = _with_sleeve(tailor, base, side, sleeve, sleeve_cell)
    skin = sf.tree_of([figure.parts["body"]])
    base = sf.with_parts(
        base, vertices=clearance.pushed_out(base.vertices, skin, 0.4 * ease * size, 0.03)
    )
    tailor.worn["upper " + name] = base


def plate(tailor, name, bottom, ease=0.012, smooth=25, cell="plate"):
    """A cuirass: the trunk of the shirt, smooth and stiff, over what is worn already."""
    under = [worn for key, worn in tailor.worn.items() if key.startswith("upper")]
    worn = dict(tailor.worn)
    upper(tailor, name, bottom, ease, smooth, None, cell)
    armour = tailor.worn["upper " + name]
    tailor.worn = worn
    if under:
        points = clearance.pushed_out(armour.vertices, sf.tree_of(under), ease * tailor.size)
        armour = sf.smoothed(sf.with_parts(armour, vertices=points), 3)
        points = clearance.pushed_out(armour.vertices, sf.tree_of(under), 0.5 * ease * tailor.size)
        armour = sf.with_parts(armour, vertices=points)
    rim = sf.boundary_loops(armour)
    for loop in rim:
        centre = armour.vertices[loop].mean(axis=0)
        edge = armour.vertices[loop]
        inner = edge + (centre - edge) * 0.10
        armour = extruded(
            armour,
            loop,
            inner[None],
            armour.weights[loop][None],
            np.full(len(loop), 0.5),
            [0.02, 0.0],
            cell,
        )
    tailor.worn["plate " + name] = armour


def _trunk_mapping(tailor, base, is_arm, z_bottom, cell, sleeve_cell):
    """Cylindrical texture coordinates: about the trunk, and about the arms for the sleeves'
    faces.
    """
    top = tailor.height("neck")
    corner_uv, cells = [], []
    for face, on_arm in zip(base.faces, is_arm):
        points = base.vertices[list(face)]
        if on_arm:
            side = "_L" if points[:, 0].mean() > 0 else "_R"
            place, angle, _ = _arm_coordinates(tailor, side, points)
            corner_uv.append(np.stack([sf.mirrored_u(angle), place / 2.05], axis=1))
        else:
            axis = np.array([tl.axis_y(tailor, z) for z in points[:, 2]])
            angle = np.arctan2(points[:, 0], -(points[:, 1] - axis))
            v = (top - points[:, 2]) / (top - z_bottom)
            corner_uv.append(np.stack([sf.mirrored_u(angle), v], axis=1))
        cells.append(sleeve_cell if on_arm else cell)
    return sf.with_parts(base, corner_uv=np.clip(np.concatenate(corner_uv), 0, 1), cells=cells)


def _arm_path(tailor, side):
    return np.array([tailor.joint(name + side) for name in ("shoulder02", "lowerarm01", "wrist")])


def _arm_frame(tailor, side, place):
    """Centre, direction and two normals (front, outside) at a place on the arm (0 to 2 and
    beyond).
    """
    path = _arm_path(tailor, side)
    upper_way, lower_way = path[1] - path[0], path[2] - path[1]
    centre = path[0] + upper_way * min(place, 1.0) + lower_way * max(place - 1.0, 0.0)
    bend = sf.smoothstep(0.75, 1.25, place)
    way = (
        upper_way / np.linalg.norm(upper_way) * (1 - bend)
        + lower_way / np.linalg.norm(lower_way) * bend
    )
    way /= np.linalg.norm(way)
    outside = np.array([1.0 if side == "_L" else -1.0, 0.0, 0.0])
    outside -= way * (outside @ way)
    outside /= np.linalg.norm(outside)
    front = sk.cross(way, outside)
    front *= -np.sign(front[1]) if abs(front[1]) > 1e-6 else 1.0
    return centre, way, front, outside


def _arm_coordinates(tailor, side, points):
    """Place along the arm, angle about it (0 outside) and distance from it, of points."""
    place = _arm_places(tailor, side, points)
    angles, distances = [], []
    for point, at in zip(points, place):
        centre, _, front, outside = _arm_frame(tailor, side, float(np.clip(at, 0.0, 2.2)))
        a, b = (point - centre) @ outside, (point - centre) @ front
        angles.append(np.arctan2(b, a))
        distances.append(np.hypot(a, b))
    return place, np.array(angles), np.array(distances)


def _arm_places(tailor, side, points):
    path = _arm_path(tailor, side)
    upper_way, lower_way = path[1] - path[0], path[2] - path[1]
    along_upper = ((points - path[0]) @ upper_way) / (upper_way @ upper_way)
    along_lower = ((points - path[1]) @ lower_way) / (lower_way @ lower_way)
    return np.where(along_lower > 0, 1.0 + along_lower, np.minimum(along_upper, 1.0))


def arm_size(tailor, side="_L"):
    path = _arm_path(tailor, side)
    return np.linalg.norm(path[1] - path[0]) / 0.2406


def _arm_weights(tailor, side, place):
    weights = np.zeros(len(tailor.figure.skeleton.names))
    elbow, twist = sf.smoothstep(0.82, 1.18, place), sf.smoothstep(1.25, 1.75, place)
    weights[tailor.column("upperarm02" + side)] = 1.0 - elbow
    weights[tailor.column("lowerarm01" + side)] = elbow * (1.0 - twist)
    weights[tailor.column("lowerarm02" + side)] = elbow * twist
    return weights


def _with_sleeve(tailor, base, side, profile, cell):
    """Extrudes the shirt's sleeve hem along the arm."""
    sign = 1.0 if side == "_L" else -1.0
    loops = [
        loop
        for loop in sf.boundary_loops(base)
        if base.vertices[loop][:, 0].mean() * sign > 0.15 * tailor.size
    ]
    if not loops:
        return base
    loop = loops[0]
    place, angle, distance = _arm_coordinates(tailor, side, base.vertices[loop])
    size = arm_size(tailor)
    ends = [stop[0] for stop in profile]
    rows = np.linspace(place.mean(), ends[-1], 11)[1:]
    rings, weights, v_rows = [], [], [place.mean() / 2.05]
    first = base.weights[loop]
    # The hem turned in; a wide sleeve's inside goes on to the arm, so that nobody looks into a hollow.
    inner = [(rows[-1], 0.86), (rows[-1] - 0.12, 0.8)]
    if profile[-1][1] > WIDE_HEM_M:
        inner[1:] = [(rows[-1] - 0.06, 0.82), (max(rows[-1] - 0.26, 1.70), 0.034 / profile[-1][1])]
    for k, (at, share) in enumerate([(row, 1.0) for row in rows] + inner):
        centre, _, front, outside = _arm_frame(tailor, side, at)
        radius = np.interp(at, ends, [stop[1] for stop in profile]) * size
        blend = min((k + 1) / 3.0, 1.0)
        if k >= len(rows):
            radius = profile[-1][1] * size
        radii = (distance * (1 - blend) + radius * blend) * share
        rings.append(
            centre
            + np.cos(angle)[:, None] * outside * radii[:, None]
            + np.sin(angle)[:, None] * front * radii[:, None]
        )
        weights.append(first * (1 - blend) + blend * _arm_weights(tailor, side, at))
        v_rows.append(min(at, 2.0) / 2.05)
    return extruded(
        base, loop, np.array(rings), np.array(weights), sf.mirrored_u(angle), v_rows, cell
    )


def extruded(base, loop, rings, weights, u_columns, v_rows, cell):
    """`base` with rings of new vertices grown from a boundary loop."""
    count, start = len(loop), len(base.vertices)
    ids = [list(loop)] + [
        list(range(start + k * count, start + (k + 1) * count)) for k in range(len(rings))
    ]
    faces, corner_uv = list(base.faces), [base.corner_uv]
    for k in range(len(rings)):
        for c in range(count):
            d = (c + 1) % count
            faces.append((ids[k][c], ids[k][d], ids[k + 1][d], ids[k + 1][c]))
            corner_uv.append(
                np.array(
                    [
                        (u_columns[c], v_rows[k]),
                        (u_columns[d], v_rows[k]),
                        (u_columns[d], v_rows[k + 1]),
                        (u_columns[c], v_rows[k + 1]),
                    ]
                )
            )
    points = np.concatenate([base.vertices] + list(rings))
    return sf.with_parts(
        base,
        vertices=points,
        faces=faces,
        corner_uv=np.concatenate(corner_uv),
        weights=np.concatenate([base.weights] + list(weights)),
        cells=base.cells + [cell] * (count * len(rings)),
    )


def skirt(
    tailor,
    name,
    top,
    hem,
    ease=0.012,
    flare=0.10,
    folds=12,
    fold_depth=0.03,
    columns=48,
    rows=12,
    gather=0.35,
    front_flare=0.6,
    follow=1.0,
    shin=0.45,
    cling=0.0,
    cell="skirt",
    hidden=False,
):
    """Cloth that hangs from `top` (a place on the trunk) to `hem`: tunic skirt, habit, gown.

    flare: extra radius at the hem for a fall of 1 m. gather: how soon the folds reach full depth.
    cling: how much of the way back to the legs it falls in a row, from the hips down: what hangs
    straight from the belly lies a hand above the thighs of who sits.
    hidden: only a form for an apron to be laid over.
    """
    size = tailor.size
    angles = tl.angles_of(columns)
    z_rows = np.linspace(tailor.height(top), tailor.height(hem), rows)
    cloud = tl.slice_points(tailor, arms=False)
    wave = tl.fold_wave(tailor.random, angles, folds)
    facing = 0.5 + 0.5 * np.cos(angles)
    points, reach = [], None
    hip = tailor.height("hip")
    for z in z_rows:
        fall = (z_rows[0] - z) / size
        outline = tl.slice_radii(tailor, cloud, z, angles, 0.015 if reach is None else 0.03)
        outline = reach if outline is None else tl.circular_blur(outline, 2)
        if reach is None or z >= hip + 0.1:
            reach = outline
        else:
            reach = np.maximum(outline, reach + (outline - reach) * (cling if z < hip else 0.0))
        depth = fold_depth * size * min(fall / gather, 1.0) if gather > 0 else fold_depth * size
        spread = flare * size * max(fall, 0.0) * (1.0 - (1.0 - front_flare) * facing)
        loose = ease * size * (0.25 + 0.75 * min(fall / 0.08, 1.0))
        radii = reach + loose + spread + depth * wave
        centre = np.array([0.0, tl.axis_y(tailor, z), z])
        points.append(centre + tl.direction(angles) * radii[:, None])
    points = _over_upper(tailor, np.array(points))
    flat = points.reshape(-1, 3)
    weights = tl.hanging_weights(tailor, flat, follow, shin)
    top_share = sf.smoothstep(hip, tailor.height("waist"), flat[:, 2])[:, None]
    worn_weights = tl.transferred(tailor, flat, tailor.figure.parts["shirt"], 1.0)
    weights = (weights * (1 - top_share) + worn_weights * top_share).reshape(rows, columns, -1)
    legs = tl.beneath(tailor, ("legs", "trousers", "skirt", "shoes"))
    if legs is not None:
        cleared = clearance.cleared(
            points,
            weights,
            tl.outward_of(tailor, points),
            legs,
            tailor.poses,
            0.008 * size,
            0.08 * size,
        )
        held = sf.smoothstep(0.0, WAISTBAND_M * size, z_rows[0] - z_rows)  # 0 where a band holds it
        points += (cleared - points) * held[:, None, None]
    tailor.grids[name] = (points, weights, angles)
    if not hidden:
        tailor.worn["skirt " + name] = _with_hem(points, weights, angles, cell, size)


def _over_upper(tailor, points):
    """The skirt's points pushed off the bodice or tunic whose end they cover."""
    under = tl.beneath(tailor, ("upper",))
    if under is None:
        return points
    flat = clearance.pushed_out(
        points.reshape(-1, 3), sf.tree_of([under]), 0.005 * tailor.size, 0.03
    )
    return flat.reshape(points.shape)


def _with_hem(points, weights, angles, cell, size):
    """The loft with its lowest row turned in, so that the cloth shows a thickness."""
    centre = points[-1].mean(axis=0)
    inward = points[-1] + (centre - points[-1]) * 0.06
    lifted = points[-2] * 0.5 + points[-1] * 0.5
    lifted = lifted + (centre - lifted) * np.array([0.12, 0.12, 0.0])
    v_rows = list(np.linspace(0.0, 0.985, len(points))) + [1.0, 0.95]
    points = np.concatenate([points, inward[None], lifted[None]])
    weights = np.concatenate([weights, weights[-1:], weights[-1:]])
    return sf.grid(points, weights, cell, sf.mirrored_u(angles), v_rows)


def trousers(tailor, name, bottom, ease=0.004, puff=0.0, smooth=6, cell="trousers"):
    """Breeches from the waist to `bottom`; puff widens the thighs."""
    size = tailor.size
    base = sf.smoothed(tailor.figure.parts["trousers"], smooth)
    low, top = tailor.height(bottom), tailor.height("waist")
    base = sf.keep_faces(base, base_above(base, low))
    place = np.clip((base.vertices[:, 2] - low) / (tailor.height("crotch") - low), 0.0, 1.3)
    gathered = 1.0 - sf.smoothstep(1.0, 1.25, place)
    base = sf.offset(
        base,
        size * (ease + gathered * puff * np.clip(np.sin(np.pi * np.minimum(place, 1.0) * 0.8), 0, 1)),
    )
    corner_uv = []
    for face in base.faces:
        points = base.vertices[list(face)]
        side = np.sign(points[:, 0].mean())
        axis = np.array([tl.axis_y(tailor, z) for z in points[:, 2]])
        around = np.arctan2((points[:, 0] - side * 0.12 * size) * side, -(points[:, 1] - axis))
        corner_uv.append(
            np.stack([sf.mirrored_u(around), (top - points[:, 2]) / (top - low)], axis=1)
        )
    base = sf.with_parts(
        base, corner_uv=np.clip(np.concatenate(corner_uv), 0, 1), cells=[cell] * len(base.faces)
    )
    for loop in sf.boundary_loops(base):
        if base.vertices[loop][:, 2].mean() < low + 0.1 * size:
            base = _knee_band(base, loop, size, cell)
    _tucked_in(tailor, base, low)
    tailor.worn["trousers " + name] = base


def _tucked_in(tailor, cloth, low):
    """Stockings above `low` lie beneath the cloth and move with it, so that no bent knee shows them."""
    tree = sf.tree_of([cloth])
    for name, worn in tailor.worn.items():
        hidden = worn.vertices[:, 2] > low
        if not name.startswith("legs ") or not hidden.any():
            continue
        vertices, weights = worn.vertices.copy(), worn.weights.copy()
        vertices[hidden] = clearance.drawn_in(vertices[hidden], tree, 0.01 * tailor.size, 0.08)
        apart = np.linalg.norm(vertices[hidden][:, None] - cloth.vertices[None], axis=2)
        weights[hidden] = cloth.weights[apart.argmin(axis=1)]
        tailor.worn[name] = sf.with_parts(worn, vertices=vertices, weights=weights)


def base_above(base, z):
    return sf.face_means(base.vertices[:, 2], base.faces) > z


def _knee_band(base, loop, size, cell):
    """Gathers an open leg into a band."""
    level = base.vertices.copy()
    level[loop, 2] = level[loop, 2].mean()
    base = sf.with_parts(base, vertices=level)
    edge = level[loop]
    centre = edge.mean(axis=0)
    rings = []
    for shrink, drop in ((0.80, 0.012), (0.74, 0.03), (0.60, 0.035)):
        ring = centre + (edge - centre) * shrink
        ring[:, 2] = centre[2] - drop * size
        rings.append(ring)
    weights = np.array([base.weights[loop]] * 3)
    return extruded(
        base, loop, np.array(rings), weights, np.full(len(loop), 0.5), [0.97, 0.98, 0.99, 1.0], cell
    )


LEG_PROFILE = [
    [0.0, 0.088],
    [0.5, 0.076],
    [0.85, 0.060],
    [1.0, 0.056],
    [1.15, 0.058],
    [1.35, 0.064],
    [1.6, 0.050],
    [1.8, 0.041],
    [1.92, 0.039],
    [2.0, 0.040],
]


def leg_pieces(tailor, name, start, end, profile=None, ease=0.0, columns=14, rows=14, cell="hose"):
    """Hose, stockings or boot legs: tubes about both legs. Places: 0 hip, 1 knee, 2 ankle."""
    profile = profile or LEG_PROFILE
    angles = tl.angles_of(columns)
    parts = []
    for side in ("_L", "_R"):
        path = np.array(
            [tailor.joint(joint + side) for joint in ("upperleg02", "lowerleg01", "foot")]
        )
        thick = tailor.figure.leg_thickness
        rings, weights = [], []
        for place in np.linspace(start, end, rows):
            at = (
                path[0]
                + (path[1] - path[0]) * min(place, 1.0)
                + (path[2] - path[1]) * max(place - 1.0, 0.0)
            )
            radius = (
                np.interp(place, [p[0] for p in profile], [p[1] for p in profile]) + ease
            ) * thick
            calf = 0.017 * np.exp(-(((place - 1.35) / 0.22) ** 2)) + 0.008 * sf.smoothstep(
                1.5, 2.0, place
            )
            rings.append(at + np.array([0.0, calf * thick, 0.0]) + tl.direction(angles) * radius)
            weights.append(_leg_weights(tailor, side, place, columns))
        parts.append(sf.grid(np.array(rings), np.array(weights), cell, sf.mirrored_u(angles)))
    tailor.worn["legs " + name] = sf.joined(parts)


def _leg_weights(tailor, side, place, columns):
    weights = np.zeros((columns, len(tailor.figure.skeleton.names)))
    hip = 1.0 - sf.smoothstep(-0.1, 0.2, place)
    knee = sf.smoothstep(0.88, 1.12, place)
    weights[:, tailor.column("root")] = hip
    weights[:, tailor.column("upperleg02" + side)] = (1 - hip) * (1 - knee)
    weights[:, tailor.column("lowerleg01" + side)] = (1 - hip) * knee
    return weights


def arm_place(tailor, side, point):
    """Where along the arm a point lies: 0 shoulder, 1 elbow, 2 wrist."""
    return float(_arm_places(tailor, side, point[None])[0])
