"""Props: small things that some people of one model carry and others do not, each a mesh of its own.

They hang on joints that stay calm (head, chest, pelvis) or go with the hand that holds them; the
garments and the clips know nothing of them. A `stuff` is [texture cell that the person wears
anyway, tint]; the tint multiplies the cell's colour (linear), so that props need no pictures of
their own. Lengths as in garments.py.
"""

from dataclasses import dataclass

import numpy as np

from townspeople import surface as sf
from townspeople import tailor as tl


@dataclass
class Prop:
    """A thing to carry and the tint of each of its vertices."""

    surface: sf.Surface
    tint: np.ndarray  # (n, 3)


def _prop(parts):
    """One prop of [(surface, tint)]."""
    return Prop(
        sf.joined([surface for surface, _ in parts]),
        np.concatenate([np.tile(tint, (len(surface.vertices), 1)) for surface, tint in parts]),
    )


def _held(tailor, points, joint):
    """Weights of what hangs on one joint alone."""
    weights = np.zeros(points.shape[:-1] + (len(tailor.figure.skeleton.names),))
    weights[..., tailor.column(joint)] = 1.0
    return weights


def _disc(ring, weights, cell, upward):
    """A flat end of a tube, with vertices of its own, so that its rim is sharp."""
    order = range(len(ring)) if upward else range(len(ring) - 1, -1, -1)
    angles = tl.angles_of(len(ring))
    uv = 0.5 + 0.4 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return sf.Surface(ring, [tuple(order)], weights, uv[list(order)], [cell])


def _lathe(rings, weights, stuff, top=True, bottom=True, across=False):
    """A tube through rings (rows from the top, columns anticlockwise seen from there), closed with
    discs.

    across: the cell's picture lies sideways, so that its grain runs round the tube.
    """
    cell, tint = stuff
    rings = np.asarray(rings)
    side = sf.grid(rings, weights, cell, sf.mirrored_u(tl.angles_of(rings.shape[1])))
    if across:
        side = sf.with_parts(side, corner_uv=side.corner_uv[:, ::-1])
    parts = [side]
    if top:
        parts.append(_disc(rings[0], weights[0], cell, True))
    if bottom:
        parts.append(_disc(rings[-1], weights[-1], cell, False))
    return sf.joined(parts), tint


def _box(tailor, joint, centre, halves, stuff):
    """A box with sharp edges about `centre`; `halves` are its three half axes, right-handed."""
    cell, tint = stuff
    points, faces, uv = [], [], []
    for axis in range(3):
        a, b, c = (halves[(axis + i) % 3] for i in range(3))
        for sign in (1.0, -1.0):
            faces.append(tuple(range(len(points), len(points) + 4)))
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                points.append(centre + sign * (a + s * b) + t * c)
                uv.append((0.5 + 0.4 * s, 0.5 + 0.4 * t))
    points = np.array(points)
    weights = _held(tailor, points, joint)
    return sf.Surface(points, faces, weights, np.array(uv), [cell] * 6), tint


def _ring(centre, side, front, angles):
    """An ellipse: `front` and `side` are half axes, angle 0 is at `front`."""
    return centre + np.cos(angles)[:, None] * front + np.sin(angles)[:, None] * side


def _strap(tailor, high, low, angles_deg, stuff, columns=14, width=0.035, thickness=0.013):
    """A leather band about the trunk in the plane that holds the points `high` and `low` and
    the forward direction; the angles go from forward (0) by `high` (90) to the back; ends
    that do not meet slip under the garments.
    """
    cell, tint = stuff
    size = tailor.size
    up = (high - low) / np.linalg.norm(high - low)
    ahead = np.array([0.0, -1.0, 0.0]) + up * up[1]
    ahead /= np.linalg.norm(ahead)
    across = np.cross(ahead, up)
    centre = 0.5 * (high + low)
    below_arms, over_sleeves = (tl.trunk_tree(tailor, arms=arms) for arms in (False, True))
    around = tl.angles_of(96)
    edge = 0.5 * width * size * across
    reach = []
    for c, s in zip(np.cos(around), np.sin(around)):
        tree = over_sleeves if s > 0.15 else below_arms
        beneath = [sf.outermost(tree, centre + k * edge, c * ahead + s * up, 0.5 * size) for k in (-1, 0, 1)]
        reach.append(max((r for r in beneath if r), default=0.02))
    flat = np.array(reach)[:, None] * np.stack([np.sin(around), -np.cos(around)], axis=1)
    angles = np.linspace(*np.radians(angles_deg), columns)
    corner = np.cos(0.5 * (angles[1] - angles[0]))  # the sides touch the trunk, not the corners
    taut = sf.hull_radii(flat, angles)[:, None] / corner
    if angles_deg[1] - angles_deg[0] < 360:
        taut[[0, -1]] *= 0.88
    rays = np.cos(angles)[:, None] * ahead + np.sin(angles)[:, None] * up
    outside = centre + rays * (taut + thickness * size)
    inside = centre + rays * (taut - thickness * size)
    points = np.array([outside + edge, outside - edge, inside, outside + edge])
    weights = tl.trunk_weights(tailor, points.reshape(-1, 3)).reshape(points.shape[:2] + (-1,))
    band = sf.grid(points, weights, cell, np.linspace(0.0, 1.0, columns), closed=False)
    return band, tint


def head_basket(tailor, wicker, filling, pad, radius=0.19, height=0.14, sit=0.030):
    """A round basket of linen, borne on the head on a ring of cloth."""
    size, head, angles = tailor.size, tailor.figure.landmarks["head"], tl.angles_of(9)
    tree = sf.tree_of([worn for name, worn in tailor.worn.items() if name.startswith("hair")])
    top = head[2] + sf.outermost(tree, head, (0.0, 0.0, 1.0), 0.5)
    middle = np.array([head[0], head[1] + 0.024 * size, top - sit * size])

    def part(profile, stuff, wave=0.0, **settings):
        """Of (height, radius) from the top; wave: how uneven it is."""
        bumps = 1.0 + wave * np.cos(2 * angles + 0.7)
        rings = np.array(
            [
                middle + [0, 0, z * size] + tl.direction(angles) * (r * size * bumps)[:, None]
                for z, r in profile
            ]
        )
        return _lathe(rings, _held(tailor, rings, "head"), stuff, **settings)

    floor = 0.036
    return _prop(
        [
            part([(floor, 0.085), (0.012, 0.110), (-0.014, 0.100)], pad, top=False, bottom=False),
            part([(floor + 0.75 * height, 0.90 * radius), (floor + height, 0.97 * radius),
                  (floor + 0.93 * height, 1.04 * radius), (floor, 0.66 * radius)], wicker,
                 top=False, across=True),
            part([(floor + 1.34 * height, 0.38 * radius), (floor + 1.16 * height, 0.78 * radius),
                  (floor + 0.80 * height, 0.93 * radius)], filling, wave=0.06, bottom=False),
        ]
    )


def _back_of(tailor, z, x=0.0):
    """How far back the garments reach at a height."""
    start = np.array([x, tl.axis_y(tailor, z), z])
    tree = tl.trunk_tree(tailor, arms=False)
    reach = sf.outermost(tree, start, (0.0, 1.0, 0.0), 0.6 * tailor.size)
    return start[1] + (reach or 0.15 * tailor.size)


def back_basket(tailor, wicker, filling, strap, height=0.44, width=0.17, depth=0.13):
    """A tall basket on the back with a strap about each shoulder: a Kiepe."""
    size = tailor.size
    low, high = tailor.height(("waist", 0.0)), tailor.height(("waist", height))
    angles = tl.angles_of(9)
    back = max(_back_of(tailor, z) for z in np.linspace(low, tailor.height("shoulder"), 6))

    def ring(t, scale):
        """At the share t of the height; the side towards the back stands upright."""
        outermost = 0.66 + 0.37 * t
        away = (depth * outermost - 0.01) * size
        centre = np.array([0.0, back + away, low + t * (high - low)])
        side = np.array([width * scale * size, 0, 0])
        return _ring(centre, side, np.array([0, -depth * scale * size, 0]), angles)

    def part(profile, stuff, **ends):
        rings = np.array([ring(t, scale) for t, scale in profile])
        return _lathe(rings, _held(tailor, rings, "spine01"), stuff, **ends)

    parts = [
        part([(0.90, 0.90), (1.0, 0.95), (0.97, 1.02), (0.0, 0.66)], wicker, top=False, across=True),
        part([(1.10, 0.40), (1.03, 0.78), (0.92, 0.93)], filling, bottom=False),
    ]
    for sign in (1.0, -1.0):
        top, pit = tailor.height("shoulder"), tailor.height(("chest", -0.02))
        over = np.array([sign * 0.075 * size, tl.axis_y(tailor, top), top])
        under = np.array([sign * 0.165 * size, tl.axis_y(tailor, pit), pit])
        parts.append(_strap(tailor, over, under, (-100, 130), strap, columns=11))
    return _prop(parts)


STRAP_DEG = (-90, 270)  # of a strap all round, from the side over the front and the shoulder


def _shoulder_to_side(tailor, sign, low=("waist", 0.0)):
    """Two points for a strap over one shoulder (sign 1: the left) down to the other side."""
    top, side = tailor.height(("shoulder", 0.03)), tailor.height(low)
    return (
        np.array([sign * 0.09 * tailor.size, tl.axis_y(tailor, top), top]),
        np.array([-sign * 0.14 * tailor.size, tl.axis_y(tailor, side), side]),
    )


def sack(tailor, cloth, strap, height=0.50, width=0.17, depth=0.12, lean_deg=14):
    """A full sack on the back, tied at the neck, on a strap over the right shoulder."""
    size, angles = tailor.size, tl.angles_of(9)
    low = tailor.height(("hip", 0.04))
    lean = np.array([-np.sin(np.radians(lean_deg)), 0.0, np.cos(np.radians(lean_deg))])
    rings = []
    for t, wide, deep in ((1.0, 0.30, 0.30), (0.90, 0.22, 0.25), (0.70, 0.72, 0.75),
                          (0.32, 1.0, 1.0), (0.06, 0.84, 0.80), (0.0, 0.45, 0.45)):
        z = low + t * height * size
        back = max(_back_of(tailor, y) for y in (z - 0.06 * size, z, z + 0.06 * size))
        centre = np.array([0.05 * size, 0.0, low]) + lean * t * height * size
        centre[1] = back + (depth * deep - 0.012) * size
        uneven = 1.0 + 0.05 * np.cos(4 * angles + 9 * t)
        rings.append(
            centre
            + (_ring(0.0, np.array([width * wide * size, 0, 0]),
                     np.array([0, -depth * deep * size, 0]), angles) * uneven[:, None])
        )
    rings = np.array(rings)
    high, under = _shoulder_to_side(tailor, -1.0)
    return _prop(
        [
            _lathe(rings, _held(tailor, rings, "spine01"), cloth),
            _strap(tailor, high, under, STRAP_DEG, strap, 18, width=0.026),
        ]
    )


def satchel(tailor, leather, flap, strap, angle_deg=146, width=0.25, height=0.20, depth=0.085):
    """A bag behind the hip, on a strap over the other shoulder."""
    size = tailor.size
    ray = tl.direction(np.radians(angle_deg))
    side = np.array([-ray[1], ray[0], 0.0])
    top = tailor.height(("hip", 0.10))
    tree = tl.trunk_tree(tailor, arms=False)
    reach = max(
        sf.outermost(tree, (0.0, tl.axis_y(tailor, z), z), ray, 0.6) or 0.15
        for z in (top, top - 0.5 * height * size, top - height * size)
    )
    middle = np.array([0.0, tl.axis_y(tailor, top), 0.0]) + ray * (reach + 0.34 * depth * size)
    angles = tl.angles_of(10)

    def bag(profile, stuff, shift=0.0):
        rings = []
        for t, wide, deep in profile:
            swell = np.abs(np.cos(angles)) ** 0.6 * np.sign(np.cos(angles))
            broad = np.abs(np.sin(angles)) ** 0.6 * np.sign(np.sin(angles))
            centre = middle + ray * shift * size + np.array([0, 0, top - t * height * size])
            rings.append(
                centre
                + 0.5 * size * (swell[:, None] * ray * depth * deep
                                + broad[:, None] * side * width * wide)
            )
        rings = np.array(rings)
        return _lathe(rings, _held(tailor, rings, "root"), stuff)

    high, under = _shoulder_to_side(tailor, -np.sign(ray[0]), ("hip", 0.16))
    return _prop(
        [
            bag([(0.0, 0.90, 0.55), (0.55, 1.0, 1.0), (1.0, 0.86, 0.72)], leather),
            bag([(-0.03, 0.94, 0.66), (0.08, 1.02, 0.98), (0.58, 1.04, 1.10)], flap, 0.004),
            _strap(tailor, high, under, (-50, 246), strap),
        ]
    )


def shield(tailor, boards, metal, strap, radius=0.215, bulge=0.045):
    """A round shield slung on the back, with a boss and a rim of metal."""
    size, angles = tailor.size, tl.angles_of(10)
    z = tailor.height(("chest", 0.03))
    places = [(z + dz * size, dx * size) for dz in (-0.15, 0.0, 0.10) for dx in (-0.12, 0.0, 0.12)]
    middle = np.array([0.0, max(_back_of(tailor, *place) for place in places) + 0.026 * size, z])
    around = np.stack([-np.sin(angles), np.zeros_like(angles), np.cos(angles)], axis=1)

    def part(profile, stuff, **ends):
        """Of (distance from the back, radius), the outermost first."""
        rings = np.array(
            [middle + (around * r + [0.0, out, 0.0]) * size for out, r in profile]
        )
        return _lathe(rings, _held(tailor, rings, "spine01"), stuff, **ends)

    high, under = _shoulder_to_side(tailor, -1.0)
    return _prop(
        [
            part([(bulge + 0.055, 0.025), (bulge + 0.035, 0.06), (bulge - 0.01, 0.075)], metal,
                 bottom=False),
            part([(bulge, 0.06), (0.022, radius - 0.03)], boards, top=False, bottom=False),
            part([(0.026, radius - 0.035), (0.020, radius), (0.0, radius - 0.004)], metal, top=False),
            _strap(tailor, high, under, STRAP_DEG, strap, 18),
        ]
    )


def _hand(tailor, side):
    """Frame of a hand at rest: middle of the palm, way of the fingers, and way out
    of the palm.
    """
    wrist, knuckle = tailor.joint("wrist" + side), tailor.joint("finger3-1" + side)
    fingers = (knuckle - wrist) / np.linalg.norm(knuckle - wrist)
    thumb = tailor.joint("finger1-1" + side) - wrist
    thumb -= fingers * (thumb @ fingers)
    thumb /= np.linalg.norm(thumb)
    palm = np.cross(fingers, thumb)
    inward = -1.0 if side == "_L" else 1.0
    return 0.5 * (wrist + knuckle), fingers, palm * np.sign(palm[0] * inward)


def book(tailor, cover, pages, side="_L", width=0.115, height=0.165, thickness=0.034):
    """A book in the hand, its spine towards the fingertips, its face on the palm."""
    palm, fingers, out = _hand(tailor, side)
    half = 0.5 * tailor.size
    across, thick = fingers * width * half, out * thickness * half
    along = np.cross(out, fingers) * height * half
    centre = palm + out * 0.016 * tailor.size + thick

    def box(shift, halves, stuff):
        return _box(tailor, "wrist" + side, centre + shift, halves, stuff)

    return _prop(
        [
            box(thick * 0.85, (across, along, thick * 0.15), cover),
            box(thick * -0.85, (across, along, thick * 0.15), cover),
            box(across * 0.92, (across * 0.08, along, thick), cover),
            box(across * -0.06, (across * 0.88, along * 0.95, thick * 0.8), pages),
        ]
    )


def staff(tailor, wood, side="_R", radius=0.015, above=0.10, spread=0.16, ahead=0.06):
    """A walking stick: the hand holds its upper end, its foot goes with the opposite leg."""
    size, angles = tailor.size, tl.angles_of(6)
    palm, fingers, out = _hand(tailor, side)
    hold = palm + (out * 0.028 + fingers * 0.015) * size
    foot = np.array([hold[0] + np.sign(hold[0]) * spread * size,
                     tailor.joint("foot_L")[1] - ahead * size, 0.012])
    way = (hold - foot) / np.linalg.norm(hold - foot)
    across = np.cross(way, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    front = np.cross(across, way)
    knob = hold + way * above * size
    rows = [(knob, 0.6), (knob - way * 0.015 * size, 1.6), (knob - way * 0.05 * size, 1.1),
            (hold, 1.0), (foot, 0.75)]
    rings = np.array(
        [_ring(p, across * r * radius * size, -front * r * radius * size, angles) for p, r in rows]
    )
    weights = _held(tailor, rings, "wrist" + side)
    other = {"_L": "foot_R", "_R": "foot_L"}[side]
    weights[-1] = _held(tailor, rings[-1], other)
    return _prop([_lathe(rings, weights, wood)])


PIECES = {
    "head basket": head_basket, "back basket": back_basket, "sack": sack, "satchel": satchel,
    "shield": shield, "book": book, "staff": staff,
}


def carried(tailor, person):
    """The person's props by name."""
    made = {}
    for entry in person.get("props", []):
        settings = dict(entry)
        name, make = settings.pop("name"), PIECES[settings.pop("piece")]
        made[name] = make(tailor, **settings)
    return made
