"""Judges a run from outside, by its metrics and trajectories alone."""
import collections
import csv
import math
import sys

METRICS = ("frame,time_s,camera_x_m,camera_y_m,camera_yaw_rad,camera_fov_rad,outer_apex_back_m,asked_speed_mps,"
           "actual_speed_mps,people,visible,boundary,outside,high,low,limit,r_personal_m,r_high_m,r_unimportant_m,"
           "exceeded,shortfalls,triangles_people,triangles_town,budget_triangles,level_switches_in_view,step_ms,"
           "control_ms,draw_ms,triangles_shadows,triangles_people_shadows").split(",")
TRAJECTORIES = "frame,id,avatar,x_m,y_m,z_m,heading_rad,radius_m,view,level".split(",")


def read_table(path, columns):
    """The rows as dicts, once the columns stand as agreed (more may follow)."""
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        assert reader.fieldnames[:len(columns)] == columns, reader.fieldnames
        return list(reader)


def read_trajectories(path):
    """{frame: {id: person}} with what the judges need of each person; long runs have millions of rows."""
    frames = collections.defaultdict(dict)
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.reader(file)
        header = next(rows)
        assert header[:len(TRAJECTORIES)] == TRAJECTORIES, header
        for frame, person, avatar, x, y, _, _, radius, view, *_ in rows:
            frames[int(frame)][int(person)] = {"avatar": sys.intern(avatar), "x_m": float(x), "y_m": float(y),
                                               "radius_m": float(radius), "view": sys.intern(view)}
    return dict(sorted(frames.items()))


def frames_over_budget(metrics):
    return [r["frame"] for r in metrics
            if float(r["triangles_people"]) + float(r["triangles_people_shadows"]) > float(r["budget_triangles"])]


def jumps(frames, top_speed_mps, step_s):
    """(frame, id, metres) of visible people who moved farther in a step than they can walk."""
    found = []
    numbers = list(frames)
    for before, after in zip(numbers, numbers[1:]):
        for person, row in frames[after].items():
            last = frames[before].get(person)
            if last is None or row["view"] != "visible":
                continue
            moved = math.hypot(row["x_m"] - last["x_m"], row["y_m"] - last["y_m"])
            if moved > top_speed_mps * step_s * 1.001 + 1e-4:
                found.append((after, person, moved))
    return found


def overlaps(frames, tolerance_m=0.05):
    """(frame, id, id, metres) of visible pairs that overlap by more than the tolerance."""
    found = []
    for frame, people in frames.items():
        visible = [(i, r) for i, r in people.items() if r["view"] == "visible"]
        visible.sort(key=lambda item: item[1]["x_m"])
        for index, (i, a) in enumerate(visible):
            for j, b in visible[index + 1:]:
                reach = a["radius_m"] + b["radius_m"]
                if b["x_m"] - a["x_m"] > reach:
                    break
                depth = reach - math.hypot(a["x_m"] - b["x_m"], a["y_m"] - b["y_m"])
                if depth > tolerance_m:
                    found.append((frame, i, j, depth))
    return found


def seen_out_of_nothing(frames):
    """(frame, id) of people who are visible without having been in the boundary, or visible, in the step before."""
    found = []
    numbers = list(frames)
    for before, after in zip(numbers, numbers[1:]):
        for person, row in frames[after].items():
            last = frames[before].get(person)
            if row["view"] == "visible" and (last is None or last["view"] == "outside"):
                found.append((after, person))
    return found


def inside_ring(x, y, ring):
    inside = False
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            inside = not inside
    return inside


def boxed_obstacles(footprints):
    """(name, box, rings or circle) of each obstacle: boxes keep the search over a town short."""
    obstacles = []
    for feature in footprints["features"]:
        geometry, name = feature["geometry"], feature["properties"]["name"]
        if geometry["type"] == "Point":
            x, y = geometry["coordinates"][:2]
            radius = feature["properties"]["radius_m"]
            obstacles.append((name, (x - radius, y - radius, x + radius, y + radius), (x, y, radius)))
            continue
        rings = [[tuple(p[:2]) for p in ring] for ring in geometry["coordinates"]]
        xs, ys = [p[0] for p in rings[0]], [p[1] for p in rings[0]]
        obstacles.append((name, (min(xs), min(ys), max(xs), max(ys)), rings))
    return obstacles


def inside_obstacles(frames, footprints, every=10):
    """(frame, id, obstacle) of people whose centre is inside an obstacle of a footprints GeoJSON."""
    found = []
    obstacles = boxed_obstacles(footprints)
    for frame in list(frames)[::every]:
        for person, row in frames[frame].items():
            x, y = row["x_m"], row["y_m"]
            for name, (west, south, east, north), shape in obstacles:
                if not (west <= x <= east and south <= y <= north):
                    continue
                if isinstance(shape, tuple):
                    inside = math.hypot(x - shape[0], y - shape[1]) < shape[2]
                else:
                    inside = sum(inside_ring(x, y, ring) for ring in shape) % 2
                if inside:
                    found.append((frame, person, name))
    return found
