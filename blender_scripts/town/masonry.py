"""Stone parts shared by church, town hall, gates and town wall: arches, pointed windows, buttresses."""

import math

from mesh import Frame, beam, box, extrude, panel, polygon, shade, srgb
from openings import arch

SANDSTONE = srgb("f0dfc0")
LIMESTONE = srgb("e6ddca")
SLATE = (0.20, 0.225, 0.26)


def outline(u, v, width, height, rise, steps=8, pointed=True):
    """The rim of an arched opening, anticlockwise from its lower left."""
    return [(u - width / 2, v), (u + width / 2, v)] + arch(u, v + height - rise, width, rise, steps, pointed)


def rings(mesh, frame, shapes, color, material="stone"):
    """Steps from an outer rim to an inner one: shapes lists (outline, out); the sill is left out."""
    for (outer, a), (inner, b) in zip(shapes, shapes[1:]):
        along = 0.0
        count = len(outer)
        for i in list(range(1, count - 1)) + [count - 1]:
            j = (i + 1) % count
            length = math.dist(outer[i], outer[j])
            reach = max(abs(a - b), math.dist(outer[i], inner[i]))
            mesh.face(material, [frame.at(*outer[i], a), frame.at(*outer[j], a), frame.at(*inner[j], b),
                                 frame.at(*inner[i], b)],
                      [(along, 0), (along + length, 0), (along + length, reach), (along, reach)], color)
            along += length


def pointed_window(mesh, frame, u, v, width, height, color, rng, mullions=1, out=0.16):
    """A lancet with a splayed stone rim, tracery bars and leaded glass."""
    rise = width * 0.95
    shapes = []
    for grow, level in ((0.5, 0.0), (0.5, out), (0.22, out), (0.0, 0.02)):
        shapes.append((outline(u, v - grow / 2, width + grow, height + grow, rise + grow / 2), level))
    rings(mesh, frame, shapes, color)
    polygon(mesh, "glass", frame, outline(u, v, width, height, rise), (0.62, 0.66, 0.75), 0.021,
            (rng.random() * 2, rng.random() * 2))
    spring = v + height - rise
    extrude(mesh, "stone", frame, [(u - width / 2 - 0.3, v - 0.28), (u + width / 2 + 0.3, v - 0.28),
                                   (u + width / 2 + 0.3, v), (u - width / 2 - 0.3, v)], 0.0, out + 0.08, shade(color, 0.95))
    for i in range(1, mullions + 1):
        x = u - width / 2 + width * i / (mullions + 1)
        beam(mesh, frame, (x, v), (x, spring + rise * 0.45), 0.12, 0.09, color, rng, "stone", base=0.02)
    part = width / (mullions + 1)
    for i in range(mullions + 1):
        middle = u - width / 2 + part * (i + 0.5)
        points = arch(middle, spring, part, part * 0.9, 4, True)
        for a, b in zip(points, points[1:]):
            beam(mesh, frame, a, b, 0.09, 0.08, color, rng, "stone", base=0.02)


def portal(mesh, frame, u, width, height, color, rng, door_color):
    """A stepped pointed doorway with a boarded door; ground at v = 0."""
    rise = width * 0.8
    shapes = []
    for grow, level in ((1.9, 0.0), (1.9, 0.62), (1.3, 0.62), (1.3, 0.4), (0.75, 0.4), (0.75, 0.2), (0.3, 0.2), (0.0, 0.03)):
        shapes.append((outline(u, -0.4, width + grow, height + 0.4 + grow / 2, rise + grow / 2, 10), level))
    rings(mesh, frame, shapes, color)
    polygon(mesh, "planks", frame, outline(u, -0.4, width, height + 0.4, rise, 10), door_color, 0.035)
    beam(mesh, frame, (u, 0), (u, height), 0.12, 0.08, shade(door_color, 0.7), rng, "planks")
    for side in (-1, 1):
        for z in (0.6, 1.5, 2.3):
            beam(mesh, frame, (u + side * 0.1, z), (u + side * width * 0.46, z), 0.07, 0.06, (0.03, 0.03, 0.03), rng, "iron")


def buttress(mesh, frame, u, heights, depths, width, color, foot=-1.2):
    """A stepped buttress against a wall; heights and depths from the lowest stage upwards."""
    low = foot
    for i, (high, depth) in enumerate(zip(heights, depths)):
        inner = depths[i + 1] if i + 1 < len(depths) else 0.0
        a, b = u - width / 2, u + width / 2
        rise = (depth - inner) * 1.3
        panel(mesh, "stone", frame, a, b, low, high, color, out=depth, step=2.0)
        for x, order in ((a, 1), (b, -1)):
            points = [frame.at(x, low, 0), frame.at(x, low, depth), frame.at(x, high, depth),
                      frame.at(x, high + rise, inner), frame.at(x, high + rise, 0)]
            if inner < 1e-6:
                points = points[:4]
            uvs = [(0, low), (depth, low), (depth, high), (inner, high + rise), (0, high + rise)][:len(points)]
            mesh.face("stone", points[::order], uvs[::order], color)
        mesh.face("stone", [frame.at(a, high, depth), frame.at(b, high, depth), frame.at(b, high + rise, inner),
                            frame.at(a, high + rise, inner)], [(a, 0), (b, 0), (b, 1), (a, 1)], shade(color, 0.9))
        low = high + rise if inner > 0 else high


def arched_wall(mesh, frame, openings, width, top, thickness, color, rng, foot=-1.2, pointed=False, trim=None,
                reveals=(-1, 1)):
    """A free wall with arched openings one can walk through: both faces, reveals, and a trim on the front.

    openings: (u, width, springing, rise); reveals: which upright sides of an opening to build, left -1, right 1. The wall runs from u = 0 to width, v = foot to top, out from -thickness to 0.
    """
    start = 0.0
    back = Frame(frame.at(width, 0, -thickness), tuple(-c for c in frame.u))
    faces = [(frame, lambda u: u), (back, lambda u: width - u)]
    for u, wide, spring, rise in list(openings) + [(width + 0.5, 1.0, 0, 0)]:
        end = u - wide / 2
        if end - start > 0.01:
            for plane, to in faces:
                a, b = sorted((to(start), to(min(end, width))))
                panel(mesh, "stone", plane, a, b, foot, top, color, step=1.5)
        if end >= width:
            break
        points = arch(u, spring, wide, rise, 12, pointed)
        for (p, q) in zip(points, points[1:]):
            for plane, to in faces:
                corners = [(to(q[0]), q[1]), (to(p[0]), p[1]), (to(p[0]), top), (to(q[0]), top)]
                if plane is back:
                    corners = [(to(p[0]), p[1]), (to(q[0]), q[1]), (to(q[0]), top), (to(p[0]), top)]
                polygon(mesh, "stone", plane, corners, color)
            mesh.face("stone", [frame.at(*q), frame.at(*q, -thickness), frame.at(*p, -thickness), frame.at(*p)],
                      [(q[0], 0), (q[0], thickness), (p[0], thickness), (p[0], 0)], shade(color, 0.92))
        for order in reveals:
            x = u + order * wide / 2
            low = foot
            while low < spring - 1e-6:
                high = min(spring, low + 1.4)
                points_ = [frame.at(x, low, 0), frame.at(x, high, 0), frame.at(x, high, -thickness),
                           frame.at(x, low, -thickness)]
                mesh.face("stone", points_[::order], [(0, low), (0, high), (thickness, high), (thickness, low)][::order],
                          shade(color, 0.95))
                low = high
        if trim:
            outer = [(u + (x - u) * (1 + 0.5 / wide), spring + (z - spring) * (1 + 0.25 / rise)) for x, z in points]
            for k in range(len(points) - 1):
                quad = [points[k], outer[k], outer[k + 1], points[k + 1]]
                ends = ((0,) if k == 0 else ()) + ((2,) if k == len(points) - 2 else ())
                extrude(mesh, "stone", frame, quad, 0.0, 0.06, trim, flanks=(1, 3) + ends)
        start = u + wide / 2


def string_course(mesh, x0, x1, y0, y1, z, color, out=0.16, height=0.28):
    """A moulding round a tower."""
    box(mesh, "stone", (x0 - out, y0 - out, z), (x1 + out, y1 + out, z + height), color)


def _towards(p, q, share):
    return tuple(p[m] + (q[m] - p[m]) * share for m in range(3))


def pyramid(mesh, material, corners, peak, color, bands=4):
    """A roof of triangles from a ring of points (anticlockwise seen from above) to a peak, in bands."""
    count = len(corners)
    for i in range(count):
        a, b = corners[i], corners[(i + 1) % count]
        width = math.dist(a, b)
        for k in range(bands):
            s, t = k / bands, (k + 1) / bands
            run = math.dist(tuple((a[m] + b[m]) / 2 for m in range(3)), peak)
            points = [_towards(p, peak, w) for p, w in ((a, s), (b, s), (b, t), (a, t))]
            uvs = [(width * s / 2, run * s), (width * (1 - s / 2), run * s), (width * (1 - t / 2), run * t),
                   (width * t / 2, run * t)]
            if t >= 1 - 1e-9:
                points, uvs = points[:3], uvs[:3]
            mesh.face(material, points, uvs, color)
