#!/usr/bin/env python3
"""Writes tests/scenario/random-walk-*.toml: a visitor who strolls, hurries, turns and waits anywhere in the demo town.

    python3 tests/bench/random_walks.py build_assets/wolfenbuettel/footprints.geojson

The files are part of the project; run this again where the demo town changes. The same town gives the same files.
"""
import argparse
import json
import math
import pathlib
import random
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/cli"))
import judge  # noqa: E402

WALKS = 10
SECONDS = 90
CLEARANCE_M = 0.8           # between the visitor's way and walls
AREA_M = (-70, -45, 60, 45)  # within the town's walls
LEG_M = (8, 30)
STROLL_MPS, HURRY_MPS = (0.8, 1.9), (2.0, 3.8)
HURRY_SHARE = 0.2
HEADER = "# A random walk of the visitor through the town; written by tests/bench/random_walks.py.\n"


def segment_distance(p, a, b):
    """Metres from a point to a segment."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    t = max(0, min(1, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2)) if length2 else 0
    return math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy)


def cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def segments_distance(a, b, c, d):
    """Metres between two segments; 0 where they cross."""
    if cross(a, b, c) * cross(a, b, d) < 0 and cross(c, d, a) * cross(c, d, b) < 0:
        return 0
    return min(segment_distance(a, c, d), segment_distance(b, c, d), segment_distance(c, a, b), segment_distance(d, a, b))


def is_free(a, b, obstacles, clearance_m=CLEARANCE_M):
    """Whether one can walk straight from a to b that far from every obstacle of judge.boxed_obstacles()."""
    for _, (west, south, east, north), shape in obstacles:
        if (max(a[0], b[0]) < west - clearance_m or min(a[0], b[0]) > east + clearance_m
                or max(a[1], b[1]) < south - clearance_m or min(a[1], b[1]) > north + clearance_m):
            continue
        if isinstance(shape, tuple):
            if segment_distance(shape[:2], a, b) < shape[2] + clearance_m:
                return False
            continue
        if sum(judge.inside_ring(*a, ring) for ring in shape) % 2:
            return False
        for ring in shape:
            if any(segments_distance(a, b, c, d) < clearance_m for c, d in zip(ring, ring[1:])):
                return False
    return True


def way_on(dice, place, obstacles):
    """A place that one can walk to straight from here, or None after many tries."""
    for _ in range(500):
        angle, length_m = dice.uniform(0, 2 * math.pi), dice.uniform(*LEG_M)
        to = (round(place[0] + length_m * math.cos(angle), 1), round(place[1] + length_m * math.sin(angle), 1))
        inside = AREA_M[0] < to[0] < AREA_M[2] and AREA_M[1] < to[1] < AREA_M[3]
        if inside and is_free(place, to, obstacles):
            return to
    return None


def start(dice, obstacles):
    """Somewhere free on the market or in the streets from which a way leads on."""
    while True:
        place = (round(dice.uniform(-45, 45), 1), round(dice.uniform(-14, 14), 1))
        if is_free(place, place, obstacles) and way_on(random.Random(0), place, obstacles):
            return place


def walk(number, obstacles):
    """The scenario's text."""
    dice = random.Random(number)
    place = start(dice, obstacles)
    text = (f'{HEADER}name = "random-walk-{number:02d}"\npeople = 300\nseed = {number}\nseconds = {SECONDS}\n'
            f'adaptation = "full"\n\n[camera]\nposition_m = [{place[0]}, {place[1]}]\n'
            f'yaw_deg = {dice.randrange(0, 360)}\n')
    left_s = SECONDS
    while left_s > 0:
        kind = dice.random()
        to = way_on(dice, place, obstacles) if kind < 0.7 else None
        if to:
            speed = round(dice.uniform(*(HURRY_MPS if dice.random() < HURRY_SHARE else STROLL_MPS)), 1)
            text += f"\n[[camera.leg]]\nwalk_to_m = [{to[0]}, {to[1]}]\nspeed_mps = {speed}\n"
            left_s -= math.dist(place, to) / speed
            place = to
        elif kind < 0.9:
            turn, rate = dice.randrange(-360, 361, 10), dice.randrange(30, 121, 10)
            text += f"\n[[camera.leg]]\nturn_by_deg = {turn}\nrate_dps = {rate}\n"
            left_s -= abs(turn) / rate
        else:
            wait_s = dice.randrange(2, 8)
            text += f"\n[[camera.leg]]\nwait_s = {wait_s}\n"
            left_s -= wait_s
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("footprints", type=pathlib.Path, help="footprints.geojson of the baked demo tour")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=SOURCE / "tests/scenario", help="folder to write to")
    arguments = parser.parse_args()
    obstacles = judge.boxed_obstacles(json.loads(arguments.footprints.read_text(encoding="utf-8")))
    for number in range(1, WALKS + 1):
        (arguments.output / f"random-walk-{number:02d}.toml").write_text(walk(number, obstacles), encoding="utf-8")


if __name__ == "__main__":
    main()
