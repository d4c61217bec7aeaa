"""Eyes that look and lids that close: two joints in the eyeballs and one for both upper lids, and what the clips do
with them.
"""

from dataclasses import replace

import numpy as np

from townspeople import skeleton as sk
from townspeople import surface as sf

LIDS, EYES = "lids", ("eye_L", "eye_R")
EYEBALL_M = 0.0125  # radius; an eye's surface is a cap of it
CLOSED_DEG = 33.0  # turn of the lids
# Of the upper lids, from the eye's middle: the edge moves wholly, the crease above it hardly.
LID_EDGE_M, LID_CREASE_M = 0.0035, 0.0100
FRAMES_DOWN, FRAMES_CLOSED, FRAMES_UP = 2, 1, 3  # of a blink


def with_eye_joints(figure):
    """The figure in the source's rest pose with joints for the eyes and the lids below the head."""
    points = figure.parts["eyes"].vertices
    sides = [points[points[:, 0] * sign > 0] for sign in (1.0, -1.0)]
    fronts = [0.5 * (side.min(axis=0) + side.max(axis=0)) for side in sides]
    centres = [
        np.array([front[0], side[:, 1].min() + EYEBALL_M, front[2]]) for front, side in zip(fronts, sides)
    ]
    skeleton, head = figure.skeleton, figure.skeleton.index("head")
    heads = np.concatenate([skeleton.heads, [0.5 * (centres[0] + centres[1])], centres])
    names = list(skeleton.names) + [LIDS, *EYES]
    grown = sk.Skeleton(names, list(skeleton.parents) + [head] * 3, heads)
    parts = {key: _more_columns(part) for key, part in figure.parts.items()}
    parts["eyes"] = _held_by_eyes(parts["eyes"], grown)
    parts["body"] = _lidded(parts["body"], grown, fronts)
    walk = np.concatenate([figure.walk, figure.walk[:, [head] * 3]], axis=1)
    return replace(figure, skeleton=grown, parts=parts, walk=walk)


def _more_columns(part):
    return sf.with_parts(part, weights=np.pad(part.weights, ((0, 0), (0, 3))))


def _held_by_eyes(eyes, skeleton):
    weights = np.zeros_like(eyes.weights)
    left = eyes.vertices[:, 0] > 0
    weights[left, skeleton.index(EYES[0])] = 1.0
    weights[~left, skeleton.index(EYES[1])] = 1.0
    return sf.with_parts(eyes, weights=weights)


def _lidded(skin, skeleton, fronts):
    """The skin with the upper lids' share of what the head carried."""
    share = np.zeros(len(skin.vertices))
    for front in fronts:
        off = skin.vertices - front
        across = np.abs(off[:, 0] - np.sign(front[0]) * 0.004) / 0.0195
        above = sf.smoothstep(LID_CREASE_M, LID_EDGE_M, off[:, 2]) * sf.smoothstep(-0.0055, -0.0030, off[:, 2])
        near = (np.abs(off[:, 1]) < 0.030) & (across < 1.0)
        share = np.maximum(share, above * near * sf.smoothstep(1.0, 0.85, across))
    weights = skin.weights * (1.0 - share)[:, None]
    weights[:, skeleton.index(LIDS)] += share
    return sf.with_parts(skin, weights=weights)


def closing(frames, blinks, rest=0.0):
    """By frame how far the lids are closed, 0 to 1; blinks: frames at which they begin to close."""
    shut = np.full(frames, rest)
    ramp = np.concatenate([
        np.linspace(0.0, 1.0, FRAMES_DOWN + 1)[1:], np.ones(FRAMES_CLOSED), np.linspace(1.0, 0.0, FRAMES_UP + 1)[1:]
    ])
    for first in blinks:
        for k, value in enumerate(ramp):
            shut[(first + k) % frames] = max(shut[(first + k) % frames], value)
    return shut


def glances(frames, turns):
    """By frame the eyes' turn in degrees (to the person's left, down); turns: [frame from which on, left, down]."""
    way = np.zeros((frames, 2))
    for first, left, down in turns:
        way[first:] = (left, down)
    soft = way.copy()
    soft[1:] = 0.5 * (way[1:] + way[:-1])  # a jump of the eyes takes two frames
    soft[-1] = soft[0]
    return soft


def animate(skeleton, local, shut, look):
    """Turns eyes and lids of local rotations, frame by frame; lids follow a downward look."""
    lids, eyes = skeleton.index(LIDS), [skeleton.index(name) for name in EYES]
    for frame, closed, (left, down) in zip(local, shut, look):
        frame[lids] = sk.rotation("x", max(closed * CLOSED_DEG, 0.5 * down)) @ frame[lids]
        for eye in eyes:
            frame[eye] = sk.rotation("z", left) @ sk.rotation("x", down) @ frame[eye]
