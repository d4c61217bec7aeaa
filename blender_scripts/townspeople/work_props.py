"""Tools of those who work, each a prop of its own (props.py), in the right hand or in the lap.

The hand's grip at rest (work_clips.hand_frame) tells where a tool is; the clip turns the hand.
"""

import numpy as np

from townspeople import props, work_clips
from townspeople import surface as sf
from townspeople import tailor as tl

# By person: the prop's name, and its settings: cells that they wear, with a tint.
TOOLS = {
    "merchant": {"open_book": {"cover": ["collar", (0.32, 0.11, 0.07)], "pages": ["collar", (1.0, 0.94, 0.80)]}},
    "farmer": {"broom": {"wood": ["belt", (1.0, 0.9, 0.75)], "twigs": ["belt", (0.8, 0.62, 0.36)]}},
    "craftsman": {"broom": {"wood": ["belt", (1.0, 0.9, 0.75)], "twigs": ["belt", (0.8, 0.62, 0.36)]}},
    "maid": {
        "broom": {"wood": ["coif", (0.42, 0.27, 0.14)], "twigs": ["coif", (0.34, 0.24, 0.11)]},
        "bucket": {"wood": ["coif", (0.30, 0.19, 0.10)], "rope": ["coif", (0.55, 0.45, 0.28)]},
    },
}


def _rod(tailor, rows, way, stuff, sides=6):
    """A tube about [(point, radius)] that goes `way`, on the right wrist."""
    across = np.cross(way, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    front, angles = np.cross(across, way), tl.angles_of(sides)
    rings = np.array([props._ring(p, across * r, -front * r, angles) for p, r in rows])
    return props._lathe(rings, props._held(tailor, rings, "wrist_R"), stuff)


def broom(tailor, wood, twigs):
    size = tailor.size
    palm, _, up = work_clips.hand_frame(tailor.figure.skeleton, "_R")
    top, down = palm + 0.14 * size * up, -up

    def at(along):
        return top + down * along * size

    foot = np.linalg.norm(work_clips.broom_line(0.0, 1.0)[0] - np.array([-0.05, -0.67, 0.05]))
    stick = [(at(0.0), 0.012 * size), (at(foot - 0.30), 0.012 * size)]
    brush = [(at(foot - 0.36), 0.016 * size), (at(foot - 0.26), 0.038 * size),
             (at(foot + 0.02), 0.085 * size)]
    return props._prop([_rod(tailor, stick, up, wood), _rod(tailor, brush, up, twigs, 8)])


def bucket(tailor, wood, rope):
    """At the end of a rope."""
    size = tailor.size
    palm, _, up = work_clips.hand_frame(tailor.figure.skeleton, "_R")
    line = [(palm + up * 0.55 * size, 0.011 * size), (palm - up * 0.62 * size, 0.011 * size)]
    staves = [(palm - up * 0.60 * size, 0.13 * size), (palm - up * 0.86 * size, 0.11 * size)]
    return props._prop([_rod(tailor, line, up, rope, 5), _rod(tailor, staves, up, wood, 9)])


def open_book(tailor, cover, pages, width=0.10, height=0.16, thickness=0.02):
    """On the thighs of who sits: at rest it stands before them. Its two halves rise a little outwards."""
    size = tailor.size
    hip, knee = tailor.height("hip"), tailor.height("knee")
    tree = tl.trunk_tree(tailor, arms=False)
    places = [(sign * 0.09 * size, 0.02, hip + share * (knee - hip)) for sign in (1, -1) for share in (0.45, 0.65)]
    front = max(sf.outermost(tree, place, (0.0, -1.0, 0.0), 0.6) or 0.1 for place in places)
    spine = np.array([0.0, 0.02 - front - 0.02 * size, hip + 0.72 * (knee - hip)])
    along, parts = np.array([0.0, 0.0, 0.5 * height * size]), []
    for sign in (1.0, -1.0):
        side, out = np.array([sign * 0.985, -0.17, 0.0]), np.array([-sign * 0.17, -0.985, 0.0])
        half, up = side * 0.5 * width * size, along * sign
        for from_m, thick_m, scale, stuff in ((0.0, 0.004, 1.0, cover), (0.004, thickness, 0.94, pages)):
            middle = spine + half + out * (from_m + 0.5 * thick_m) * size
            parts.append(props._box(tailor, "root", middle, (half * scale, up * scale, np.cross(half, up) / np.linalg.norm(half)
                                                             / np.linalg.norm(up) * 0.5 * thick_m * size), stuff))
    made = props._prop(parts)
    weights = 0.5 * (props._held(tailor, made.surface.vertices, "upperleg02_L") + props._held(tailor, made.surface.vertices, "upperleg02_R"))
    return props.Prop(sf.with_parts(made.surface, weights=weights), made.tint)


MAKERS = {"broom": broom, "bucket": bucket, "open_book": open_book}


def tools(tailor, person):
    """The tools of whom a name stands for, by name."""
    return {name: MAKERS[name](tailor, **settings)
            for name, settings in TOOLS.get(person, {}).items()}
