#!/usr/bin/env python3
"""Writes the check's cases (see README.md) but those that need a town of their own. Run here after a change."""

import json
import math
import pathlib

FOLDER = pathlib.Path(__file__).parent
OURS = {"version": 1, "units": "m", "clearance_m": 0.05, "band_m": [0.1, 2.0], "origin_m": [0, 0]}


def feature(name, geometry, coordinates, **properties):
    return {"type": "Feature", "properties": {"name": name, **properties},
            "geometry": {"type": geometry, "coordinates": coordinates}}


def polygon(name, outer, *holes, closed=True, **properties):
    rings = [[list(p) for p in ring] + ([list(ring[0])] if closed else []) for ring in (outer, *holes)]
    return feature(name, "Polygon", rings, **properties)


def point(name, at, **properties):
    return feature(name, "Point", list(at), **properties)


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def hole(x0, y0, x1, y1):
    return box(x0, y0, x1, y1)[::-1]


def write(name, *features, members=None):
    head = {"type": "FeatureCollection", **({"flaneur": OURS} if members is None else members)}
    lines = ",\n".join(json.dumps(f) for f in features)
    (FOLDER / f"{name}.geojson").write_text(json.dumps(head)[:-1] + ', "features": [\n' + lines + "\n]}\n")


def four(code, make, raising, none, over, under):
    """A case that raises the code, one that does not, and one just over and just under its tolerance."""
    for suffix, value in (("", raising), ("_none", none), ("_over", over), ("_under", under)):
        made = make(value)
        write(f"{code}{suffix}", *(made if isinstance(made, list) else [made]))


def regular(corners):
    return [(round(9 * math.cos(2 * math.pi * i / corners), 6), round(9 * math.sin(2 * math.pi * i / corners), 6))
            for i in range(corners)]


HOUSE = box(0, 0, 8, 6)


def rings():
    four(101, lambda ring: polygon("house", ring), [(0, 0), (8, 0)], [(0, 0), (8, 0), (0, 6)],
         [(0, 0), (8, 0), (8, 0.0005)], [(0, 0), (8, 0), (8, 1)])
    four(102, lambda step: polygon("house", [(0, 0), (8, 0), (8, step), (8, 6), (0, 6)]), 0.0005, 1, 0.0009, 0.0011)
    four(103, lambda end: polygon("house", HOUSE + end, closed=False), [], [(0, 0)], [(0, 0.0011)], [(0, 0.0009)])
    four(104, lambda ring: polygon("house", ring), [(0, 0), (8, 6), (8, 0), (0, 6)], HOUSE,
         [(0, 0), (8, 0), (8, 6), (4, 0), (0, 6)], [(0, 0), (8, 0), (8, 6), (4, 0.001), (0, 6)])
    four(105, lambda ring: polygon("house", ring), HOUSE[::-1], HOUSE, box(0, 0, 0.15, 0.15)[::-1], box(0, 0, 0.15, 0.15))
    four(106, lambda side: polygon("post", box(0, 0, side, side)), 0.09, 1, 0.0999, 0.1001)
    four(107, lambda x: polygon("house", [(0, 0), (8, 0), (x, 6), (0, 6)]), None, 8, 1000001, 999999)
    four(108, lambda corners: polygon("tower", regular(corners)), 300, 12, 257, 256)
    four(109, lambda radius: point("oak", (3, 3), kind="tree", radius_m=radius), 0, 0.3, -0.001, 0.001)
    four(201, lambda x: polygon("house", HOUSE, hole(x, 2, x + 0.9, 3)), 7.6, 2, 7.111, 7.109)
    four(202, lambda x: polygon("house", HOUSE, hole(2, 2, 2.9, 3), hole(x, 2, x + 0.9, 3)), 2.4, 5, 2.889, 2.891)
    four(203, lambda w: polygon("house", [(0, 0), (8, 0), (8, 3), (8.5, 3), (8.5, 3 + w), (8, 3 + w), (8, 6), (0, 6)]),
         0.01, 0.5, 0.019, 0.022)


def street(shed=box(25.95, 19.95, 29.05, 23.05), west=13.05, more=()):
    """Obstacles of street.gltf."""
    parts = [polygon("house", box(9.95, 9.95, west, 16.05), kind="building", source="house"),
             polygon("house_2", box(14.95, 9.95, 18.05, 16.05), kind="building", source="house")]
    return parts + ([polygon("shed", shed, kind="building", source="shed")] if shed else []) + list(more)


def town():
    def east(x):
        return street(box(25.95, 19.95, x, 23.05))
    write("street", *street())
    four(301, east, 28.7, 29.05, 28.985, 28.995)
    four(302, east, 29.02, 29.05, 29.037, 29.042)
    four(303, east, 29.6, 29.05, 29.066, 29.058)
    four(304, lambda x: street(x and box(25.95, 19.95, x, 23.05)), None, 29.05, 27.4, 27.6)
    four(305, lambda x: street(more=[polygon("ghost", box(x, 20, x + 3, 23))]), 33, 60, 28.95, 28.85)
    write("305_none", *street())
    four(307, lambda x: street(west=x), 14.95, 13.05, 13.7, 13.6)
    far = [polygon(f"house_{i}", box(500 + 20 * i, 500, 510 + 20 * i, 510)) for i in range(2)]
    write("907", *far)
    write("907_none", *street())


def pairs():
    def beside(x):
        return [polygon("house", HOUSE), polygon("neighbour", box(x, 0, 12, 6))]
    four(401, beside, 7.5, 8, 7.998, 7.9985)
    four(402, lambda x: [polygon("house", HOUSE), polygon("again", box(x, 0, 8 + x, 6))], 0, 20, 0.07, 0.09)
    four(403, beside, 8.4, 8.008, 8.59, 8.61)
    four(404, beside, 9, 11, 9.19, 9.21)


def alley(depth, *more):
    """Three metres wide, open in the south."""
    return [polygon("alley", [(0, 0), (2, 0), (2, depth), (5, depth), (5, 0), (7, 0), (7, depth + 1), (0, depth + 1)]), *more]


def ways():
    def court(side):
        return polygon("court", box(0, 0, 8, 8), hole(2, 2, 2 + side, 2 + side))
    write("501", polygon("yard", [(0, 0), (10, 0), (10, 1), (1, 1), (1, 9), (9, 9), (9, 1.4), (10, 1.4), (10, 10), (0, 10)]))
    write("501_none", polygon("yard", HOUSE))
    write("501_over", court(1.01))
    write("501_under", court(0.99))
    four(502, lambda d: alley(d, point("door", (3.5, d - 0.5), kind="door")), 15, 4, 10.2, 9.8)
    # Two alleys that meet at their ends: a visitor between their mouths closes both.
    block = box(0, 0, 12, 31)
    loop = [(0, 0), (2, 0), (2, 28), (10, 28), (10, 0), (12, 0), (12, 31), (0, 31)]
    write("503", polygon("court", loop), polygon("island", box(4, 0, 8, 26)))
    write("503_none", polygon("court", block))
    write("503_over", *alley(11.6))
    write("503_under", *alley(10.8))
    four(504, lambda y: [polygon("house", HOUSE), feature("lane", "LineString", [[-5, y], [15, y]], highway="footway")],
         3, -2, 0.012, 0.008)


def gates():
    def gate(kind, x):
        return [polygon("house", HOUSE), point("gate", (x, 3), kind=kind)]
    for suffix, x in (("_none", 11), ("_over", 7.99), ("_under", 8.01)):
        write(f"601{suffix}", *gate("door", x))
        write(f"602{suffix}", *gate("exit", x))
    for suffix, x in (("_none", 11), ("_over", 8.28), ("_under", 8.295)):
        write(f"603{suffix}", *gate("door", x))

    def yard(opening):
        return [polygon("yard", [(0, 0), (6, 0), (6, 2), (5, 2), (5, 1), (1, 1), (1, 5), (5, 5), (5, 2 + opening),
                                 (6, 2 + opening), (6, 6), (0, 6)]),
                point("gate", (3, 3), kind="door"), point("way_out", (7.5, 3), kind="exit")]
    write("604_none", *yard(2))
    write("604_over", *yard(0.58))
    write("604_under", *yard(0.62))


def files():
    house = polygon("house", HOUSE)
    degrees = polygon("house", [(10.53, 52.16), (10.5302, 52.16), (10.5302, 52.1601), (10.53, 52.1601)])
    (FOLDER / "901.geojson").write_text('{"type": "FeatureCollection", "features": [\n')
    write("901_none", house)
    write("902")
    write("902_none", house)
    write("903", degrees)
    write("903_none", degrees, members={})
    write("904", house, {"type": "Feature", "properties": {"name": "torn"}, "geometry": {"type": "Polygon", "coordinates": ["x"]}})
    write("904_none", house)
    crs = "urn:ogc:def:crs:EPSG::{}"
    utm = polygon("house", box(604000, 5779000, 604008, 5779006))
    write("906", utm, members={"crs": {"type": "name", "properties": {"name": crs.format(999999)}}})
    write("906_none", utm, members={"crs": {"type": "name", "properties": {"name": crs.format(25832)}}})


rings()
town()
pairs()
ways()
gates()
files()
