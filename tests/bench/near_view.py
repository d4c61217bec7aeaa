#!/usr/bin/env python3
"""Who is near and in the picture, with any part of them, without being a mesh? Random walks in a tour and in made-up towns.

    near_view.py PLAYER [PACK] [--walks N] [--seconds S] [--near M] [--adaptation off|paper|full]

Plays random walks without drawing, half of them in the pack's town (from places on its guided path), half on made-up squares with
houses, and looks at everybody whose figure reaches into the view's wedge, by the angle that their place lies off its axis. How far a figure
reaches is measured in the pack by itself, from the outlines of its impostors. Prints, for each walk, how many such people within
M metres there were (a row a person and step), how many of them were no mesh although the limit and the budget had room, how many counted as outside
the view, and how often the limit or the budget was exceeded; ends with status 1 where anybody near was no mesh or nobody was looked at.
"""
import argparse
import csv
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

PLAIN_LIMIT, PLAIN_TRIANGLES = 12, 6000  # of the figure that walks where there is no pack
EDGE_M = 0.005                           # coordinates are rounded: who reaches in by less is not judged


def tour_of(pack):
    """The pack's extension and its accessor to binary views."""
    data = pack.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    gltf, binary = json.loads(data[20:20 + length]), 20 + length + 8
    view = lambda index: data[binary + gltf["bufferViews"][index].get("byteOffset", 0):][:gltf["bufferViews"][index]["byteLength"]]
    return gltf["extensions"]["FLANEUR_tour"], view


def reaches(pack):
    """{avatar: metres}: the farthest that any of an avatar's pictures shows it from where it stands."""
    tour, view = tour_of(pack)
    out = {}
    for avatar in tour["avatars"]:
        cells = struct.iter_unpack("<6h", view(avatar["impostor"]["cells_view"]))
        most = max(max(abs(c[4] - c[0]), abs(c[0] + c[2] - c[4])) for c in cells)
        out[avatar["name"]] = (most - 1) * avatar["impostor"]["texel_m"]
    return out


def legs(dice, way_m, seconds):
    """A visitor who walks, hurries, turns and stands."""
    text, x, y = "", 0.0, 0.0
    while seconds > 0:
        kind = dice.random()
        if kind < 0.5:
            x, y, speed = dice.uniform(-way_m, way_m), dice.uniform(-way_m, way_m), dice.uniform(0.8, 3.5)
            text += f"[[camera.leg]]\nwalk_to_m = [{{x0}} + {x:.1f}, {{y0}} + {y:.1f}]\nspeed_mps = {speed:.1f}\n"
            seconds -= way_m / speed
        elif kind < 0.85:
            turn, rate = dice.randrange(-300, 301, 10), dice.randrange(20, 121, 10)
            text += f"[[camera.leg]]\nturn_by_deg = {turn}\nrate_dps = {rate}\n"
            seconds -= abs(turn) / rate
        else:
            text += "[[camera.leg]]\nwait_s = 3\n"
            seconds -= 3
    return text


def placed(text, x0, y0):
    """The legs about a place: TOML knows no sums."""
    out = []
    for line in text.splitlines():
        if line.startswith("walk_to_m"):
            x, y = (float(part.split("+")[1]) for part in line[line.index("[") + 1:-1].split(","))
            line = f"walk_to_m = [{x0 + x:.2f}, {y0 + y:.2f}]"
        out.append(line)
    return "\n".join(out) + "\n"


def town_walk(tour, number, seconds, adaptation):
    dice = random.Random(number)
    place = dice.choice(tour["path"])["position_m"]
    return (f'people = 300\nseed = {number}\nseconds = {seconds}\nadaptation = "{adaptation}"\n[camera]\nposition_m = [{place[0]}, {place[1]}]\n'
            f"yaw_deg = {dice.randrange(360)}\n" + placed(legs(dice, 18, seconds), *place))


def square_walk(number, seconds, adaptation):
    """A square with a few houses and strollers with random goals."""
    dice = random.Random(number)
    half, size = 24, dice.uniform(3, 7)
    houses = [(dice.uniform(-18, 18), dice.uniform(-18, 18)) for _ in range(5)]
    free = lambda x, y: all(abs(x - hx) > size / 2 + 1 or abs(y - hy) > size / 2 + 1 for hx, hy in houses)

    def spot():
        while True:
            x, y = dice.uniform(-half + 1, half - 1), dice.uniform(-half + 1, half - 1)
            if free(x, y):
                return round(x, 2), round(y, 2)
    x0, y0 = spot()
    text = (f'seconds = {seconds}\nadaptation = "{adaptation}"\n[limit]\nhigh = {PLAIN_LIMIT}\n[ground]\nmin_m = [{-half}, {-half}]\n'
            f"max_m = [{half}, {half}]\n[camera]\nposition_m = [{x0}, {y0}]\nyaw_deg = {dice.randrange(360)}\n"
            + placed(legs(dice, 18, seconds), 0, 0))
    for x, y in houses:
        text += f"[[obstacle]]\npolygon_m = [[{x - size / 2}, {y - size / 2}], [{x + size / 2}, {y - size / 2}], " \
                f"[{x + size / 2}, {y + size / 2}], [{x - size / 2}, {y + size / 2}]]\n"
    for _ in range(110):
        x, y = spot()
        if math.hypot(x - x0, y - y0) > 1.5:
            goals = ", ".join(f"[{gx}, {gy}]" for gx, gy in (spot() for _ in range(6)))
            text += f"[[person]]\nposition_m = [{x}, {y}]\ngoals_m = [{goals}]\nstay = true\n"
    return text


def beyond_edge_m(dx, dy, yaw, half):
    """How far a place is from the wedge; 0 within."""
    distance = math.hypot(dx, dy)
    angle = abs(math.remainder(math.atan2(dy, dx) - yaw, 2 * math.pi))
    return 0 if angle <= half else distance * math.sin(angle - half) if angle - half < math.pi / 2 else distance


def look(folder, reach_of, near_m):
    """People near and partly in view: [rows, no mesh though there was room, called outside]; frames over limit, over budget."""
    with open(folder / "metrics.csv", encoding="utf-8", newline="") as file:
        metrics = {int(row["frame"]): {key: float(value) for key, value in row.items()} for row in csv.DictReader(file)}
    counts = [0, 0, 0]
    with open(folder / "trajectories.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            m = metrics[int(row["frame"])]
            dx, dy = float(row["x_m"]) - m["camera_x_m"], float(row["y_m"]) - m["camera_y_m"]
            if math.hypot(dx, dy) > near_m:
                continue
            reach = max(reach_of.get(row["avatar"], 0), float(row["radius_m"])) - EDGE_M
            if beyond_edge_m(dx, dy, m["camera_yaw_rad"], m["camera_fov_rad"] / 2) > reach:
                continue
            counts[0] += 1
            has_room = m["high"] < m["limit"] and m["triangles_people"] < 0.9 * m["budget_triangles"]
            counts[1] += has_room and not row["level"].isdigit()
            counts[2] += row["view"] != "visible"
    frames = metrics.values()
    return counts, sum(m["high"] > m["limit"] for m in frames), sum(m["triangles_people"] > m["budget_triangles"] for m in frames)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("player", type=pathlib.Path)
    parser.add_argument("pack", type=pathlib.Path, nargs="?")
    parser.add_argument("--walks", type=int, default=4)
    parser.add_argument("--seconds", type=int, default=30)
    parser.add_argument("--near", type=float, default=8)
    parser.add_argument("--adaptation", choices=("off", "paper", "full"), default="full")
    a = parser.parse_args()
    tour = tour_of(a.pack)[0] if a.pack else None
    reach_of = reaches(a.pack) if a.pack else {}
    total = [0, 0, 0, 0, 0]
    print("walk        near rows   no mesh   not visible   over limit   over budget")
    for number in range(1, a.walks + 1):
        in_town = tour is not None and number % 2 == 1
        text = (town_walk(tour, number, a.seconds, a.adaptation) if in_town else square_walk(number, a.seconds, a.adaptation))
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "walk.toml").write_text(text, encoding="utf-8")
            subprocess.run([str(a.player.resolve()), *([str(a.pack.resolve())] if in_town else []), "--headless", "--no-draw", "--scenario", folder / "walk.toml",
                            "--metrics", folder / "metrics.csv", "--trajectories", folder / "trajectories.csv"],
                           check=True, stdout=subprocess.DEVNULL)
            counts, over_limit, over_budget = look(folder, reach_of, a.near)
        values = [*counts, over_limit, over_budget]
        total = [x + y for x, y in zip(total, values)]
        print(f"{'town' if in_town else 'square':6} {number:3}  {values[0]:9}   {values[1]:7}   {values[2]:11}   {values[3]:10}   {values[4]:11}", flush=True)
    print(f"all         {total[0]:9}   {total[1]:7}   {total[2]:11}   {total[3]:10}   {total[4]:11}")
    return 1 if total[0] == 0 or any(total[1:]) else 0


if __name__ == "__main__":
    sys.exit(main())
