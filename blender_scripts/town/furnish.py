"""Where trees, lamps, stalls and the small things stand. Each place is (x, y, yaw)."""

import math

import numpy as np

import plan
from layout import offset_line

# Name of the shared mesh, height, crown radius, colour, detail.
TREE_SORTS = [("tree_lime", 8.6, 3.0, "8c9a48", 1.5), ("tree_maple", 9.6, 2.8, "7a8f45", 1.2),
              ("tree_apple", 6.4, 2.6, "9aa04f", 0.75), ("tree_elm", 8.8, 3.1, "7f9148", 0.75),
              ("tree_far", 9.5, 3.4, "7f8c50", 0.25)]
STALLS = [(-10.0, 6.6, 0.0), (-5.4, 6.9, 0.0), (-0.8, 6.7, 0.0), (3.8, 6.9, 0.0), (8.6, 6.6, 0.0),
          (1.2, -8.2, math.pi), (5.9, -8.4, math.pi), (10.6, -8.1, math.pi)]
WELL = (-2.5, -1.2)
CHURCHYARD_TREES = ((36, 16.0), (46, 15.2), (56, 14.2), (68, 14.5), (73, 31), (70, 46), (57, 47.4), (46, 46.8), (35.5, 47))
SQUARE_TREES = [(-15.8, -9.6), (15.4, 10.2), (15.6, -10.6), (-12.2, -10.4)]
CARTS = [(13.4, -1.4, 0.5), (-14.6, 3.6, 2.2), (29.2, 38.6, 0.95)]
HORSE_CART = 2          # which of them a horse stands before


def lamps(streets, public):
    """Lamp posts at the kerbs, alternating sides, and round the square."""
    places = [(-17.3, -13.0), (17.3, -13.0), (17.3, 13.0), (-17.0, 12.6), (-1.5, 12.6), (0.5, -13.0), (21.6, 29.9), (22.4, 37.5)]
    for street in streets:
        if street.carriage_m == 0:
            continue
        side = 1
        s = 9
        while s < len(street.axis) - 3:
            line = offset_line(street.axis, side * (street.carriage_m / 2 + 0.42))
            p = line[s]
            kerb = float(plan.carriage_distance([p], streets)[0])
            inside = float(plan.distance_to_polygon([p], plan.WALL_RING)[0]) < -7
            apart = all(math.hypot(p[0] - q[0], p[1] - q[1]) > 7.5 for q in places)
            if 0.25 < kerb < 0.7 and public([p])[0] < -0.8 and inside and apart:
                places.append((float(p[0]), float(p[1])))
                s += 17
                side = -side
            else:
                s += 1
    return places


def trees(public, rng):
    """(x, y, scale, sort) of trees on the square, in the churchyard and outside the wall."""
    spots = [(x, y, 0.85, 0) for x, y in SQUARE_TREES]
    spots += [(x + rng.uniform(-0.6, 0.6), y + rng.uniform(-0.6, 0.6), rng.uniform(0.9, 1.2), 1)
              for x, y in CHURCHYARD_TREES]
    for i in range(46):
        a = 2 * math.pi * (i + rng.uniform(-0.3, 0.3)) / 46
        for r in np.arange(60, 120, 2.0):
            p = (r * math.cos(a), r * math.sin(a))
            if plan.distance_to_polygon([p], plan.WALL_RING)[0] > 9:
                break
        if public([p])[0] > 3:
            k = rng.uniform(1.02, 1.12)
            spots.append((p[0] * k, p[1] * k, rng.uniform(0.95, 1.4), 4))
    return spots


def along_fronts(plots, doors, streets, public, rng):
    """Benches and piles of goods against house fronts: ('bench' or 'pile', x, y, yaw, whether nobody has to pass there)."""
    places = []
    for plot, entries in zip(plots, doors):
        if plot.kind != "house" or rng.random() < 0.45:
            continue
        door_u = entries[0]
        u = plot.width * 0.22 if door_u > plot.width / 2 else plot.width * 0.78
        p, ahead = plot.at(u, -0.42), plot.at(u, -2.0)
        if abs(u - door_u) < 1.9 or public([p])[0] > -0.2 or public([ahead])[0] > -1.75:
            continue
        if float(plan.carriage_distance([plot.at(u, -0.9)], streets)[0]) < 0.1:
            continue
        places.append(("bench" if rng.random() < 0.45 else "pile", float(p[0]), float(p[1]), plot.yaw, not plot.gateway))
    return places


def graves(rng):
    """Rows of headstones north and south of the church."""
    places = []
    for y in (46.6, 44.6, 16.6, 14.4):
        for i in range(9):
            x = 40 + i * 3.3 + rng.uniform(-0.5, 0.5)
            far = min(plan.distance_to_line([(x, y)], way)[0] for way in plan.CHURCH_WAYS)
            free = all(math.dist((x, y), tree) > 1.8 for tree in CHURCHYARD_TREES)
            if rng.random() < 0.75 and free and far > 1.9 and plan.distance_to_polygon([(x, y)], plan.CHURCHYARD)[0] < -1:
                places.append((x, y, rng.uniform(-0.15, 0.15)))
    return places


def loiter_spots():
    """(x, y, yaw); people look along local -y."""
    spots = []
    for k in range(5):
        a = 2 * math.pi * k / 5 + 0.4
        x, y = WELL[0] + 2.7 * math.cos(a), WELL[1] + 2.7 * math.sin(a)
        spots.append((x, y, a - math.pi / 2))
    for x, y, yaw in STALLS:
        for side in (-0.8, 0.9):
            ahead = (side * math.cos(yaw) + 2.1 * math.sin(yaw), side * math.sin(yaw) - 2.1 * math.cos(yaw))
            spots.append((x + ahead[0], y + ahead[1], yaw + math.pi))
    return spots
