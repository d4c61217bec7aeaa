"""Tools of those who work, each a prop of its own (props.py) in the right hand.

The hand's grip at rest (work_clips.hand_frame) tells where the tool is; the clip turns the hand.
"""

import numpy as np

from townspeople import props, work_clips
from townspeople import tailor as tl

# By person: the prop's name, and its settings: cells that they wear, with a tint.
TOOLS = {
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


MAKERS = {"broom": broom, "bucket": bucket}


def tools(tailor, person):
    """The tools of whom a name stands for, by name."""
    return {name: MAKERS[name](tailor, **settings)
            for name, settings in TOOLS.get(person, {}).items()}
