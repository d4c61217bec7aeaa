"""The figures by which a run is judged. Pure functions over the columns of recording.py; metres, seconds, radians."""
import math

import numpy as np

from figures.recording import NO_ROW, judge, row_of, steps

DENSITY_RADIUS_M = 2.0        # local density of an overlapping pair: people within this of its middle, over the disc's area
CROWDED_PM2 = 1.0             # above it overlaps are reported, not judged
GATE_REACH_M = 2.5            # so near a door or exit people may come and go
GOAL_REACH_M = 1.0
KERNEL_M = 1.0                # local density by the kernel exp(-d2 / R2) / (pi R2) (Helbing and Johansson 2007)
RIM_M = (-0.5, 1.5)           # the rim of the camera obstacles: so far inside to so far outside their outline
ROUNDED_M = 2e-3             # places are rounded, and so is what is worked out from them
ROUNDED_YAW_RAD = 2e-6        # likewise the camera's direction
ARRIVED_M = 0.35              # nearer to its target the direction of the way is not judged
SURE_STEP_M = 0.02            # camera steps from this length have a direction in spite of rounded coordinates


def wrapped(angle_rad):
    return (np.asarray(angle_rad) + np.pi) % (2 * np.pi) - np.pi


def camera_at(metrics, frame):
    """x, y and yaw of the camera in each of the frames."""
    index = np.asarray(frame) - int(metrics["frame"][0])
    return metrics["camera_x_m"][index], metrics["camera_y_m"][index], metrics["camera_yaw_rad"][index]


def from_camera(metrics, people):
    """Everybody's place seen from the camera: distance, and angle off its axis."""
    x, y, yaw = camera_at(metrics, people["frame"])
    dx, dy = people["x_m"] - x, people["y_m"] - y
    return np.hypot(dx, dy), wrapped(np.arctan2(dy, dx) - yaw)


def candidates(metrics, people, r_high_m):
    """How many visible people are within the nominal r_high, frame by frame: what the paper's Figures 10 and 11 plot."""
    distance, _ = from_camera(metrics, people)
    near = people["visible"] & (distance <= r_high_m)
    first = int(metrics["frame"][0])
    return np.bincount(people["frame"][near] - first, minlength=len(metrics["frame"]))


def share_exceeded(counts, limits, first=0):
    """Share of the frames from `first` on with more candidates than the limit."""
    over = (counts > limits)[first:]
    return float(over.mean()) if len(over) else 0.0


def beyond_wedge(x, y, apex_x, apex_y, yaw, half_fov):
    """Metres from points to the nearest part of a wedge on the ground; within it less than 0, from the nearer edge's line."""
    dx, dy = x - apex_x, y - apex_y
    ahead, aside = dx * np.cos(yaw) + dy * np.sin(yaw), np.abs(dy * np.cos(yaw) - dx * np.sin(yaw))
    beyond = aside * np.cos(half_fov) - ahead * np.sin(half_fov)
    along = ahead * np.cos(half_fov) + aside * np.sin(half_fov)
    return np.where((beyond <= 0) | (along >= 0), beyond, np.hypot(dx, dy))


def wrong_views(metrics, people):
    """Rows whose `view` contradicts the two wedges: who reaches into the camera's is visible, who reaches only into the one whose
    apex lies behind it is in the boundary, everybody else outside."""
    index = people["frame"] - int(metrics["frame"][0])
    x, y, yaw = camera_at(metrics, people["frame"])
    half, back = metrics["camera_fov_rad"][index] / 2, metrics["outer_apex_back_m"][index]
    inner = beyond_wedge(people["x_m"], people["y_m"], x, y, yaw, half)
    outer = beyond_wedge(people["x_m"], people["y_m"], x - back * np.cos(yaw), y - back * np.sin(yaw), yaw, half)
    reach = people.get("reach_m", np.zeros(len(inner)))
    rounded = ROUNDED_M + ROUNDED_YAW_RAD * np.hypot(people["x_m"] - x, people["y_m"] - y)
    visible, boundary, outside = (people["view"] == name for name in (b"visible", b"boundary", b"outside"))
    wrong = visible & (inner > reach + rounded) | ~visible & (inner < reach - rounded)
    wrong |= boundary & (outer > reach + rounded) | outside & (outer < reach - rounded)
    return int(wrong.sum())


def local_density(people, frame, x, y, radius_m=DENSITY_RADIUS_M):
    """People per square metre in a disc."""
    low, high = np.searchsorted(people["frame"], [frame, frame + 1])
    near = np.hypot(people["x_m"][low:high] - x, people["y_m"][low:high] - y) <= radius_m
    return float(near.sum()) / (math.pi * radius_m**2)


def overlapping_pairs(people, frames):
    """Pairs that overlap by more than 5 cm in some frame: where it isn't crowded, and all."""
    sparse, everywhere = set(), set()
    for frame, a, b, _ in judge.overlaps(frames):
        everywhere.add((a, b))
        middle = [(frames[frame][a][axis] + frames[frame][b][axis]) / 2 for axis in ("x_m", "y_m")]
        if local_density(people, frame, *middle) <= CROWDED_PM2:
            sparse.add((a, b))
    return len(sparse), len(everywhere)


def away_from(x, y, places, reach_m):
    """True where a point is farther than that from every place."""
    if len(places) == 0:
        return np.ones(len(x), bool)
    offsets = np.hypot(np.subtract.outer(x, [p[0] for p in places]), np.subtract.outer(y, [p[1] for p in places]))
    return offsets.min(axis=1) > reach_m


def seen_coming_and_going(people, gates, last_goals):
    """How many are born in view, and how many vanish in view, other than at doors, exits and their last goals."""
    first, last = people["frame"].min(initial=0), people["frame"].max(initial=0)
    born = people["visible"] & (people["before"] == NO_ROW) & (people["frame"] > first)
    after = row_of(people, people["frame"] + 1, people["id"])
    gone = people["visible"] & (after == NO_ROW) & (people["frame"] < last)
    wrong = []
    for which in (born, gone):
        x, y = people["x_m"][which], people["y_m"][which]
        wrong.append(int(np.sum(away_from(x, y, gates, GATE_REACH_M) & away_from(x, y, last_goals, GOAL_REACH_M))))
    return tuple(wrong)


def visible_motion(people, step_s):
    """Speeds (m/s) and turn rates (rad/s, without sign) of those visible in two frames running."""
    after, before = steps(people)
    seen = people["visible"][after] & people["visible"][before]
    after, before = after[seen], before[seen]
    speed = np.hypot(people["x_m"][after] - people["x_m"][before], people["y_m"][after] - people["y_m"][before]) / step_s
    turn = np.abs(wrapped(people["heading_rad"][after] - people["heading_rad"][before])) / step_s
    return speed, turn


def kolmogorov_smirnov(a, b):
    """The two-sample distance: the greatest difference of the cumulative distributions; None without samples."""
    if len(a) == 0 or len(b) == 0:
        return None
    a, b = np.sort(a), np.sort(b)
    both = np.concatenate([a, b])
    share_a = np.searchsorted(a, both, side="right") / len(a)
    share_b = np.searchsorted(b, both, side="right") / len(b)
    return float(np.abs(share_a - share_b).max())


def level_switches(people, step_s):
    """Changes of level that are seen, per visible person and minute: of those visible in two frames running, and of those who come into
    view while one level still fades into another."""
    after, before = steps(people)
    seen = people["visible"][after] & people["visible"][before]
    changes = np.sum(people["level"][after[seen]] != people["level"][before[seen]])
    if "fading_level" in people:
        was_visible = (people["before"] != NO_ROW) & people["visible"][people["before"]]
        changes += np.sum(people["visible"] & ~was_visible & (people["fading_level"] != b"none"))
    minutes = np.sum(people["visible"]) * step_s / 60
    return float(changes / minutes) if minutes else 0.0


def people_over(counts, limits):
    """Candidates beyond the limit, mean over the frames."""
    return float(np.maximum(counts - limits, 0).mean())


def filled(counts, limits, base_counts):
    """Candidates up to the limit, of the limit, mean over those frames in which the base has as many; None where it never has."""
    shared = min(len(counts), len(base_counts))
    full = base_counts[:shared] >= limits[:shared]
    return float((np.minimum(counts, limits)[:shared] / limits[:shared])[full].mean()) if full.any() else None


def ring_densities(metrics, people, most_m):
    """People per square metre in rings of 1 m about the visitor, mean over the frames: the k-th reaches from k to k + 1 metres."""
    distance, _ = from_camera(metrics, people)
    count, edges = np.histogram(distance, bins=np.arange(most_m + 1))
    return count / (len(metrics["frame"]) * math.pi * np.diff(edges.astype(float)**2))


def densest_ring(rings, base_rings, least_m=2):
    """The density of the densest ring that begins so far from the visitor or farther, over the base's there; None where nobody is."""
    densest = least_m + int(np.argmax(rings[least_m:]))
    return float(rings[densest] / base_rings[densest]) if base_rings[densest] > 0 else None


def obstacle_outline(dx, dy, yaw_rad, fov_rad, r_high_m):
    """Signed metres to the outline of the camera obstacles, seen from the camera: circles through it that reach to r_high along
    the view's axis and both its edges."""
    radius = r_high_m / 2
    outside = [np.hypot(dx - radius * np.cos(yaw_rad + turn), dy - radius * np.sin(yaw_rad + turn)) - radius
               for turn in (0, fov_rad / 2, -fov_rad / 2)]
    return np.min(outside, axis=0)


def rim_densities(metrics, people, r_high_m):
    """The highest local density at the rim of the camera obstacles, frame by frame; 0 where nobody is there."""
    highest = np.zeros(len(metrics["frame"]))
    first = int(metrics["frame"][0])
    bounds = np.searchsorted(people["frame"], np.arange(first, first + len(highest) + 1))
    for index, (low, high) in enumerate(zip(bounds, bounds[1:])):
        dx = people["x_m"][low:high] - metrics["camera_x_m"][index]
        dy = people["y_m"][low:high] - metrics["camera_y_m"][index]
        near = np.hypot(dx, dy) < r_high_m + RIM_M[1] + 3 * KERNEL_M
        dx, dy = dx[near], dy[near]
        out = obstacle_outline(dx, dy, metrics["camera_yaw_rad"][index], metrics["camera_fov_rad"][index], r_high_m)
        rim = (out >= RIM_M[0]) & (out <= RIM_M[1])
        if rim.any():
            square = np.subtract.outer(dx[rim], dx)**2 + np.subtract.outer(dy[rim], dy)**2
            highest[index] = np.exp(-square / KERNEL_M**2).sum(axis=1).max() / (math.pi * KERNEL_M**2)
    return highest


def speed_ratio(metrics):
    """The user's way made over the way asked for; None where nothing was asked."""
    asked = metrics["asked_speed_mps"] > 0
    if not asked.any():
        return None
    return float(metrics["actual_speed_mps"][asked].sum() / metrics["asked_speed_mps"][asked].sum())


def direction_error(metrics, targets):
    """The greatest angle (degrees) between the camera's steps and the way to the target of its leg; None where it never walks
    to one.

    Which leg is on stands in no column: it is the first from the last one known whose target lies straight ahead."""
    if not targets:
        return None
    x, y = metrics["camera_x_m"], metrics["camera_y_m"]
    moved = np.hypot(np.diff(x), np.diff(y))
    worst, leg = None, 0
    for k in np.flatnonzero(moved >= SURE_STEP_M):
        course = math.atan2(y[k + 1] - y[k], x[k + 1] - x[k])
        errors = [abs(float(wrapped(math.atan2(ty - y[k], tx - x[k]) - course))) for tx, ty in targets[leg:]]
        ahead = next((n for n, error in enumerate(errors) if error < math.radians(1)), 0)
        leg += ahead
        if math.dist(targets[leg], (x[k], y[k])) >= ARRIVED_M:
            worst = max(worst or 0, math.degrees(errors[ahead]))
    return worst


def too_near(metrics, people):
    """Frames with somebody's centre within r_personal of the camera."""
    distance, _ = from_camera(metrics, people)
    index = people["frame"] - int(metrics["frame"][0])
    return len(np.unique(people["frame"][distance < metrics["r_personal_m"][index] - 1e-3]))



def density_map(metrics, people, half_m, cell_m):
    """People per square metre around the camera, mean over the frames, in a square that turns with it: rows from behind the
    camera to before it, columns from its left to its right."""
    distance, angle = from_camera(metrics, people)
    cells = round(2 * half_m / cell_m)
    edges = np.linspace(-half_m, half_m, cells + 1)
    ahead, right = distance * np.cos(angle), -distance * np.sin(angle)
    count, _, _ = np.histogram2d(ahead, right, bins=(edges, edges))
    return count / (len(metrics["frame"]) * cell_m**2)
