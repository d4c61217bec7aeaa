"""Can a classifier tell one crowd from another by how its visible people walk? A classifier two-sample test (Lopez-Paz and Oquab,
2017): it learns on some paths and is asked about others; the area under its ROC curve is 0.5 where nobody can tell, 1 where one always
can. What it sees of a person are pieces of 2 s, looked at ten times a second.

Learning needs scikit-learn (Debian: python3-sklearn); where it is missing MISSING says so, and the test is left out."""
import os

import numpy as np

from figures.measures import camera_at, wrapped

os.environ.setdefault("OMP_NUM_THREADS", "1")  # threads that wait for each other learn slower where the machine is busy
try:
    from scipy.spatial import cKDTree
    from sklearn.ensemble import HistGradientBoostingClassifier
    from sklearn.metrics import roc_auc_score
    MISSING = None
except ImportError as error:
    MISSING = f"{error.name or 'scikit-learn'} not found: install the Debian package python3-sklearn"

SAMPLES_HZ, PIECE_S = 10, 2
NEAR_M = 15               # pieces beyond, in the mean, are not looked at: the visitor cannot tell either
MOST_PIECES = 1000        # of a path and side, so that none outweighs the others
LEAST_PIECES = 20         # of a path on either side, to say anything about it
FOLDS = 5
WALKING_MPS = 0.2         # below, a person has no course
STANDING_MPS = 0.1
ALONE_M = 10.0            # who is farther than this is nobody's neighbour
PERSONAL_M = 8            # the foreground

# What is known of a piece, of the walking itself and of where it is seen from.
WALKING = ("speed", "speed_spread", "slowest", "fastest", "change_of_speed", "speeding_up", "braking", "turning", "sharpest_turn", "turned",
           "sideways_jerk", "curvature", "straightness", "stands", "body_off_course", "neighbour", "nearest_neighbour", "neighbour_leaves")
SEEN = ("distance", "leaves", "off_axis", "heads_here", "turns_here", "turns_away", "visitor_speed", "foreground")
FEATURES = WALKING + SEEN


def neighbour_distances(people):
    """Metres from each row's person to the nearest other one in that frame, at most ALONE_M."""
    nearest = np.full(len(people["frame"]), ALONE_M)
    places = np.column_stack([people["x_m"], people["y_m"]])
    starts = np.flatnonzero(np.diff(people["frame"], prepend=-1))
    for low, high in zip(starts, np.append(starts[1:], len(places))):
        if high - low > 1:
            distance, _ = cKDTree(places[low:high]).query(places[low:high], k=2)
            nearest[low:high] = np.minimum(distance[:, 1], ALONE_M)
    return nearest


def pieces_of(people, every):
    """Rows (piece, sample) of people visible all through a piece; `every`: frames between samples. Pieces share no sample."""
    length = PIECE_S * SAMPLES_HZ + 1
    order = np.lexsort((people["frame"], people["id"]))
    order = order[people["visible"][order]]
    person, frame = people["id"][order], people["frame"][order]
    broken = np.flatnonzero((np.diff(person) != 0) | (np.diff(frame) != every)) + 1
    starts = np.concatenate([np.arange(low, high - length + 1, length)
                             for low, high in zip(np.r_[0, broken], np.r_[broken, len(order)])] or [[]]).astype(int)
    return order[starts[:, None] + np.arange(length)]


def features(metrics, people, step_s):
    """One row of FEATURES a piece, of those within NEAR_M; at most MOST_PIECES, evenly of all."""
    every = round(1 / (SAMPLES_HZ * step_s))
    thin = people["frame"] % every == 0
    people = {name: column[thin] for name, column in people.items()}
    rows = pieces_of(people, every)
    if len(rows) == 0:
        return np.zeros((0, len(FEATURES)), np.float32)
    x, y, heading = people["x_m"][rows], people["y_m"][rows], people["heading_rad"][rows]
    neighbour = neighbour_distances(people)[rows]
    camera_x, camera_y, yaw = camera_at(metrics, people["frame"][rows])
    visitor_mps = metrics["actual_speed_mps"][people["frame"][rows] - int(metrics["frame"][0])]
    table = piece_features(x, y, heading, neighbour, camera_x, camera_y, yaw, visitor_mps, 1 / SAMPLES_HZ)
    table = table[table[:, FEATURES.index("distance")] < NEAR_M].astype(np.float32)
    return table[np.linspace(0, len(table) - 1, min(len(table), MOST_PIECES)).astype(int)]


def piece_features(x, y, heading, neighbour, camera_x, camera_y, yaw, visitor_mps, sample_s):
    """FEATURES by piece; every argument has a row a piece and a column a sample."""
    vx, vy = np.diff(x) / sample_s, np.diff(y) / sample_s
    speed = np.hypot(vx, vy)
    course = np.arctan2(vy, vx)
    walks = speed > WALKING_MPS
    turn = np.where(walks[:, 1:] & walks[:, :-1], wrapped(np.diff(course)), 0) / sample_s
    change = np.diff(speed) / sample_s
    here_x, here_y = camera_x - x, camera_y - y
    distance = np.hypot(here_x, here_y)
    heads = np.where(walks, (vx * here_x[:, 1:] + vy * here_y[:, 1:]) / np.maximum(speed * distance[:, 1:], 1e-6), 0)
    visitor_left = np.sign(vx * here_y[:, 1:] - vy * here_x[:, 1:])[:, 1:]  # 1: the visitor is to the walker's left
    walked = speed.sum(1) * sample_s
    straight = np.hypot(x[:, -1] - x[:, 0], y[:, -1] - y[:, 0])
    by_name = {
        "speed": speed.mean(1), "speed_spread": speed.std(1), "slowest": speed.min(1), "fastest": speed.max(1),
        "change_of_speed": np.abs(change).mean(1), "speeding_up": change.max(1), "braking": -change.min(1),
        "turning": np.abs(turn).mean(1), "sharpest_turn": np.abs(turn).max(1), "turned": np.abs(turn.sum(1)) * sample_s,
        "sideways_jerk": np.abs(np.diff(turn * speed[:, 1:])).mean(1) / sample_s,
        "curvature": np.abs(turn).sum(1) * sample_s / np.maximum(walked, 0.2),
        "straightness": np.where(walked > 0.2, straight / np.maximum(walked, 0.2), 1),
        "stands": (speed < STANDING_MPS).mean(1),
        "body_off_course": (np.abs(wrapped(heading[:, 1:] - course)) * walks).mean(1),
        "neighbour": neighbour.mean(1), "nearest_neighbour": neighbour.min(1), "neighbour_leaves": neighbour[:, -1] - neighbour[:, 0],
        "distance": distance.mean(1), "leaves": distance[:, -1] - distance[:, 0],
        "off_axis": np.abs(wrapped(np.arctan2(-here_y, -here_x) - yaw)).mean(1),
        "heads_here": heads.mean(1), "turns_here": heads[:, -1] - heads[:, 0], "turns_away": -(turn * visitor_left).sum(1) * sample_s,
        "visitor_speed": visitor_mps.mean(1), "foreground": (distance < PERSONAL_M).mean(1)}
    return np.column_stack([by_name[name] for name in FEATURES])


def learnt(sides):
    """A classifier that has seen [(pieces, label)]; each of them weighs as much as any other."""
    table = np.concatenate([pieces for pieces, _ in sides])
    labels = np.concatenate([np.full(len(pieces), label) for pieces, label in sides])
    weights = np.concatenate([np.full(len(pieces), len(table) / len(pieces) / len(sides)) for pieces, _ in sides])
    model = HistGradientBoostingClassifier(max_iter=100, learning_rate=0.08, max_leaf_nodes=24, min_samples_leaf=60,
                                           l2_regularization=1, early_stopping=False, random_state=0)
    return model.fit(table, labels, sample_weight=weights)


def told_apart(a, b):
    """{path: AUC} of {path: pieces} against {path: pieces}: each path is judged by a classifier that has not seen it. Paths with too
    few pieces are left out; fewer than two are nothing to learn from."""
    paths = sorted(path for path in set(a) & set(b) if min(len(a[path]), len(b[path])) >= LEAST_PIECES)
    folds = [paths[k::FOLDS] for k in range(min(FOLDS, len(paths)))] if len(paths) > 1 else []
    found = {}
    for held_out in folds:
        model = learnt([side for path in paths if path not in held_out for side in ((a[path], 1), (b[path], 0))])
        for path in held_out:
            labels = np.r_[np.ones(len(a[path])), np.zeros(len(b[path]))]
            found[path] = float(roc_auc_score(labels, model.predict_proba(np.concatenate([a[path], b[path]]))[:, 1]))
    return found


def what_tells(a, b):
    """[(feature, how much of the AUC is lost without it)], most first: a feature's values are dealt anew among all pieces of each
    held-out fold, as in a permutation test."""
    paths = sorted(path for path in set(a) & set(b) if min(len(a[path]), len(b[path])) >= LEAST_PIECES)
    dice, losses = np.random.default_rng(0), np.zeros(len(FEATURES))
    for held_out in (paths[::2], paths[1::2]) if len(paths) > 1 else ():
        model = learnt([side for path in paths if path not in held_out for side in ((a[path], 1), (b[path], 0))])
        table = np.concatenate([side[path] for side in (a, b) for path in held_out])
        labels = np.repeat([1, 0], [sum(len(side[path]) for path in held_out) for side in (a, b)])
        pick = dice.permutation(len(table))[:4000]
        table, labels = table[pick], labels[pick]
        whole = roc_auc_score(labels, model.predict_proba(table)[:, 1])
        for k in range(len(FEATURES)):
            dealt = table.copy()
            dealt[:, k] = dice.permutation(dealt[:, k])
            losses[k] += (whole - roc_auc_score(labels, model.predict_proba(dealt)[:, 1])) / 2
    return sorted(zip(FEATURES, losses.tolist()), key=lambda item: -item[1])
