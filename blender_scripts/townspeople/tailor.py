"""What every garment is cut with: body slices, rays onto what is worn already, weights, heights."""

from dataclasses import dataclass, field

import numpy as np

from common.settings import fail
from townspeople import surface as sf
from townspeople.body import LANDMARKS, joint_share

ARM_JOINTS = ("shoulder02", "upperarm", "lowerarm", "wrist", "finger")
HAND_JOINTS = ("wrist", "finger")


@dataclass
class Tailor:
    """A figure and the garments made for it so far."""

    figure: object
    random: object  # numpy.random.Generator
    worn: dict = field(default_factory=dict)  # name -> Surface, in the order of dressing
    grids: dict = field(
        default_factory=dict
    )  # name -> (points, weights, angles) of lofted garments
    size: float = 1.0  # lengths in people.py are for a figure of 1.7 m
    poses: list = field(default_factory=list)  # sampled skinning matrices of all clips
    trunk_trees: dict = field(default_factory=dict)  # arms -> (what is worn, tree): the last ones made

    def height(self, place):
        """z in metres of a landmark name, or of [landmark, offset in m at 1.7 m]."""
        name, shift = (place, 0.0) if isinstance(place, str) else place
        if name not in LANDMARKS:
            fail("people.py: no landmark '%s'" % name)
        return float(self.figure.landmarks[name][2]) + shift * self.size

    def joint(self, name):
        return self.figure.skeleton.head(name)

    def column(self, name):
        return self.figure.skeleton.index(name)


def angles_of(count):
    return np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)


def direction(angles):
    """Horizontal unit vectors; angle 0 is forward, a quarter turn to the person's left."""
    angles = np.asarray(angles, float)
    return np.stack([np.sin(angles), -np.cos(angles), np.zeros_like(angles)], axis=-1)


def axis_y(tailor, z):
    """Front-back position of the trunk's axis."""
    marks = [
        tailor.figure.landmarks[name] for name in ("sole", "knee", "hip", "waist", "chest", "neck")
    ]
    return float(np.interp(z, [mark[2] for mark in marks], [min(mark[1], 0.02) for mark in marks]))


def bare_parts(tailor, covers):
    """Of the figure's own parts those that nothing of these kinds covers: {part: kinds}.

    What is covered is not worn: a belt or skirt over it would stand off a garment that is smoother.
    """
    worn = tuple(tailor.worn)
    return [tailor.figure.parts[part] for part, kinds in covers.items() if not any(name.startswith(kinds) for name in worn)]


def slice_points(tailor, arms, skirts=False):
    """Points all over trunk and legs (and arms down to the elbow, and skirts), as worn so far."""
    figure = tailor.figure
    kinds = ("upper", "trousers", "plate") + (("skirt",) if skirts else ())
    parts = bare_parts(tailor, {"shirt": ("upper",), "trousers": ("trousers",)})
    parts += [tailor.worn[name] for name in tailor.worn if name.startswith(kinds)]
    clouds = []
    for part in parts:
        share = joint_share(figure, part, ARM_JOINTS)
        elbow = joint_share(figure, part, HAND_JOINTS + ("lowerarm",))
        kept = (elbow < 0.3) if arms else (share < 0.35)
        clouds.append(part.vertices[kept])
        clouds.append(sf.face_centres(part)[sf.face_least(kept, part.faces)])
    return np.concatenate(clouds)


def slice_radii(tailor, cloud, z, angles, half_band_m=0.03):
    """Convex outline of the cloud near height z: radii about the trunk's axis, or None."""
    near = cloud[np.abs(cloud[:, 2] - z) < half_band_m * tailor.size]
    if len(near) < 6:
        return None
    return sf.hull_radii(near[:, :2] - np.array([0.0, axis_y(tailor, z)]), angles)


def circular_blur(values, rounds, closed=True):
    for _ in range(rounds):
        if closed:
            values = 0.5 * values + 0.25 * (
                np.roll(values, 1, axis=-1) + np.roll(values, -1, axis=-1)
            )
        else:
            padded = np.concatenate([values[..., :1], values, values[..., -1:]], axis=-1)
            values = 0.5 * values + 0.25 * (padded[..., :-2] + padded[..., 2:])
    return values


def trunk_weights(tailor, points):
    """Spine and root weights by height alone."""
    z = points[:, 2]
    stops = [tailor.joint("root")[2], tailor.height("waist"), tailor.height("chest")]
    weights = np.zeros((len(points), len(tailor.figure.skeleton.names)))
    up = sf.smoothstep(stops[0], stops[1], z)
    top = sf.smoothstep(stops[1], stops[2], z)
    weights[:, tailor.column("root")] = 1.0 - up
    weights[:, tailor.column("spine03")] = up * (1.0 - top)
    weights[:, tailor.column("spine01")] = up * top
    return weights


def hanging_weights(tailor, points, follow=1.0, shin=0.45):
    """Weights of cloth that hangs from the hips: it follows both legs, softly.

    follow: how much of the legs' swing the cloth takes. shin: how much of that is the lower leg's.
    """
    weights = trunk_weights(tailor, points)
    hip, knee, ankle = tailor.height("hip"), tailor.height("knee"), tailor.height("ankle")
    leg = follow * sf.smoothstep(hip + 0.02, tailor.height(("crotch", -0.10)), points[:, 2])
    width = abs(tailor.joint("upperleg02_L")[0]) * 1.7
    left = sf.smoothstep(-width, width, points[:, 0])
    behind = sf.smoothstep(-0.12, 0.15, points[:, 1] - axis_y(tailor, hip))
    low = (
        sf.smoothstep(knee + 0.12 * tailor.size, ankle, points[:, 2]) * shin * (0.5 + 0.7 * behind)
    )
    weights *= (1.0 - leg)[:, None]
    for side, share in (("_L", left), ("_R", 1.0 - left)):
        weights[:, tailor.column("upperleg02" + side)] += leg * share * (1.0 - low)
        weights[:, tailor.column("lowerleg01" + side)] += leg * share * low
    return weights


def transferred(tailor, points, source, calm_arms=0.0):
    """Weights of the nearest vertices of `source`; `calm_arms` of the arms' part goes to the
    chest.
    """
    weights = sf.nearest_weights(points, source.vertices, source.weights)
    if calm_arms:
        for i, name in enumerate(tailor.figure.skeleton.names):
            if name.startswith(ARM_JOINTS):
                moved = weights[:, i] * calm_arms
                weights[:, i] -= moved
                weights[:, tailor.column("spine01")] += moved
    return weights


def as_worn(tailor, points, kinds=("upper", "skirt", "plate")):
    """Weights of the nearest worn garments of the trunk, sleeves left out."""
    sources = [worn for name, worn in tailor.worn.items() if name.startswith(kinds)]
    both = sf.joined(sources or [tailor.figure.parts["shirt"]])
    trunk = joint_share(tailor.figure, both, ARM_JOINTS) < 0.1
    return sf.nearest_weights(points, both.vertices[trunk], both.weights[trunk], 4)


def beneath(tailor, kinds):
    """Everything of these kinds that is worn, as one surface; the skin where kinds names it."""
    parts = [worn for name, worn in tailor.worn.items() if name.startswith(kinds)]
    parts += [tailor.figure.parts[name] for name in ("shoes", "body") if name in kinds]
    return sf.joined(parts) if parts else None


def outward_of(tailor, points):
    """Horizontal unit vectors away from the trunk's axis."""
    ways = points.copy()
    ways[..., 1] -= np.vectorize(lambda z: axis_y(tailor, z))(points[..., 2])
    ways[..., 2] = 0.0
    return ways / np.maximum(np.linalg.norm(ways, axis=-1, keepdims=True), 1e-6)


def trunk_tree(tailor, arms):
    """Rays' target: everything worn on trunk, neck (and upper arms)."""
    figure = tailor.figure
    parts = [worn for name, worn in tailor.worn.items() if not name.startswith(("hair", "head"))]
    parts += bare_parts(tailor, {"body": (), "shirt": ("upper",), "trousers": ("skirt", "trousers")})
    before, tree = tailor.trunk_trees.get(arms, ([], None))
    if len(before) == len(parts) and all(one is other for one, other in zip(before, parts)):
        return tree
    kept = []
    for part in parts:
        share = joint_share(figure, part, HAND_JOINTS + ("lowerarm",) if arms else ARM_JOINTS)
        head = joint_share(figure, part, ("head",))
        kept.append(sf.keep_faces(part, sf.face_least((share < 0.5) & (head < 0.9), part.faces)))
    tailor.trunk_trees[arms] = (parts, sf.tree_of(kept))
    return tailor.trunk_trees[arms][1]


def star_rows(tree, centre, angles, elevations_deg, ease, fallback):
    """Rows of points where rays from `centre` leave the target, plus `ease` (a number a row)."""
    rows = []
    for elevation, extra in zip(
        np.radians(elevations_deg), np.broadcast_to(ease, (len(elevations_deg),))
    ):
        flat = direction(angles) * np.cos(elevation)
        rays = flat + np.array([0.0, 0.0, np.sin(elevation)])
        reach = [sf.outermost(tree, centre, ray) for ray in rays]
        reach = np.array([fallback if value is None else value for value in reach])
        rows.append(centre + rays * (circular_blur(reach, 2) + extra)[:, None])
    return np.array(rows)


def fold_wave(random, angles, folds):
    """Irregular pleats about the body: 0 in the valleys, 1 on the crests."""
    bent = angles + 0.25 * np.sin(2 * angles + random.uniform(0, 6.28)) / 2
    wave = 0.5 + 0.5 * np.cos(folds * bent + random.uniform(0, 6.28))
    slow = 0.5 + 0.5 * np.cos(max(folds // 3, 1) * angles + random.uniform(0, 6.28))
    return wave * (0.55 + 0.45 * slow)
