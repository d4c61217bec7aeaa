"""A run of flaneur-player as columns: metrics by name, trajectories sorted by frame and person."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cli"))
import judge  # noqa: E402

ROW = np.dtype([("frame", "i4"), ("id", "i4"), ("x_m", "f8"), ("y_m", "f8"), ("heading_rad", "f8"), ("radius_m", "f8"),
                ("view", "S8"), ("level", "S8"), ("reach_m", "f8"), ("fading_level", "S8")])
NO_ROW = -1


def read_metrics(path):
    """{column: array}, one entry a frame."""
    rows = judge.read_table(path, judge.METRICS)
    return {name: np.array([float(row[name]) for row in rows]) for name in judge.METRICS}


def read_people(path):
    """{column: array} with one entry a person a frame, sorted by frame and id."""
    with open(path, encoding="utf-8") as file:
        header = file.readline().strip().split(",")
        assert header[:len(judge.TRAJECTORIES)] == judge.TRAJECTORIES, header
        names = [name for name in ROW.names if name in header]  # reach_m and fading_level came later
        row = np.dtype([(name, ROW[name]) for name in names])
        columns = [header.index(name) for name in names]
        table = np.loadtxt(file, delimiter=",", dtype=row, usecols=columns, ndmin=1, comments=None)
    return sorted_people({name: table[name] for name in names})


def sorted_people(people):
    """The columns in order of frame and id, with `visible` (bool) and `before`: each row's person a frame ago, or NO_ROW."""
    order = np.lexsort((people["id"], people["frame"]))
    people = {name: np.asarray(column)[order] for name, column in people.items()}
    people["visible"] = people["view"] == b"visible"
    people["before"] = row_of(people, people["frame"] - 1, people["id"])
    return people


def row_of(people, frame, person):
    """The rows of these people in these frames; NO_ROW where there are none."""
    if len(people["frame"]) == 0:
        return np.full(len(frame), NO_ROW)
    wide = int(people["id"].max()) + 2
    keys = people["frame"].astype(np.int64) * wide + people["id"]
    wanted = np.asarray(frame).astype(np.int64) * wide + person
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[at] == wanted, at, NO_ROW)


def steps(people):
    """Rows (after, before) of everybody who was there in the frame before too."""
    after = np.flatnonzero(people["before"] != NO_ROW)
    return after, people["before"][after]


def judged_frames(people):
    """{frame: {id: person}} as tests/cli/judge.py reads it, of those who are visible now or in the next frame."""
    wanted = people["visible"].copy()
    seen = np.flatnonzero(people["visible"])
    before = people["before"][seen]
    wanted[before[before != NO_ROW]] = True
    frames = {int(frame): {} for frame in np.unique(people["frame"])}
    rows = np.flatnonzero(wanted)
    columns = [people[name][rows].tolist() for name in ("frame", "id", "x_m", "y_m", "radius_m", "view")]
    for frame, person, x, y, radius, view in zip(*columns):
        frames[frame][person] = {"x_m": x, "y_m": y, "radius_m": radius, "view": view.decode()}
    return frames
