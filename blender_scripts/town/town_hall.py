"""The town hall: two framed storeys over an open arcade, a steep roof with a cross gable and a clock turret."""

import math

import plan
from framing import bargeboards, bay_edges, gable, jetty, storey, tone
from masonry import LIMESTONE, SANDSTONE, SLATE, arched_wall, pyramid
from mesh import Frame, Mesh, beam, box, extrude, panel, shade, srgb
from openings import door, window
from roof import chimney, dormer, gable_roof, shed_dormer, weathercock
from church import clock

BAYS, PIER = 5, 0.72
SPRING, RISE, TOP = 2.35, 1.15, 4.0
STOREYS, DROP, OVERHANG = (3.2, 2.8), 0.22, (0.4, 0.3)


def make_town_hall(rng):
    """Mesh, and its doors as (x, y, nx, ny)."""
    hall = plan.TOWN_HALL
    mesh = Mesh()
    width, depth = hall["x1"] - hall["x0"], hall["back"] - hall["front"]
    colors = {"plaster": srgb("f3ead2"), "timber": srgb("5e2a20"), "bracket": srgb("6e3426"), "frame": srgb("f4f1e8"),
              "door": srgb("4b2f22"), "shutter": srgb("3f5a45"), "barge": srgb("5a2a20"), "shift": 0.3,
              "accent": [srgb("d2a445"), srgb("3f6b52"), srgb("b5532f")], "tile": (0.9, 0.86, 0.84)}
    arcade(mesh, width, depth, hall["arcade"], colors, rng)
    doors = inner_wall(mesh, width, hall["arcade"], colors, rng)
    y, z = 0.0, TOP
    for level, height in enumerate(STOREYS):
        y -= OVERHANG[level]
        z += DROP
        upper(mesh, width, depth, y, z, height, OVERHANG[level], colors, rng, level)
        z += height
    roof(mesh, width, depth, y, z, colors, rng)
    ground = float(plan.pavement_height(0, hall["front"]))
    world = [(hall["x0"] + x, hall["front"] + q, 0.0, -1.0) for x, q in doors]
    return mesh.moved(hall["x0"], hall["front"], ground), world


def arcade(mesh, width, depth, deep, colors, rng):
    """Arches on the front and on both ends, a boarded ceiling on beams."""
    bay = (width - PIER) / BAYS
    openings = [(PIER + (bay - PIER) / 2 + i * bay, bay - PIER, SPRING, RISE) for i in range(BAYS)]
    front = Frame((0, 0, 0), (1, 0, 0))
    arched_wall(mesh, front, openings, width, TOP, PIER, SANDSTONE, rng, trim=LIMESTONE)
    run = deep - PIER
    clear = run - 0.25
    right, left = Frame((width, PIER, 0), (0, 1, 0)), Frame((0, deep, 0), (0, -1, 0))
    arched_wall(mesh, right, [(clear / 2, clear, SPRING, RISE)], run, TOP, PIER, SANDSTONE, rng, trim=LIMESTONE, reveals=(1,))
    arched_wall(mesh, left, [(run - clear / 2, clear, SPRING, RISE)], run, TOP, PIER, SANDSTONE, rng, trim=LIMESTONE,
                reveals=(-1,))
    for wall in (Frame((width, 0, 0), (0, 1, 0)), Frame((0, PIER, 0), (0, -1, 0))):
        panel(mesh, "stone", wall, 0, PIER, -1.2, TOP, SANDSTONE)
    for i in range(BAYS + 1):
        x = i * bay
        for low, high, out in ((-1.2, 0.35, 0.07), (SPRING - 0.16, SPRING, 0.06)):
            box(mesh, "stone", (x - out, -out, low), (x + PIER + out, PIER + out, high), LIMESTONE)
    ceiling = Frame((PIER, deep, TOP - 0.1), (1, 0, 0), (0, -1, 0))
    panel(mesh, "planks", ceiling, 0, width - 2 * PIER, 0, deep - PIER, shade(colors["timber"], 1.6), step=1.3)
    x = PIER
    while x < width - PIER + 0.01:
        beam(mesh, Frame((x, PIER, TOP - 0.1), (0, 1, 0), (1, 0, 0)), (0, 0), (deep - PIER, 0), 0.24, 0.22,
             tone(colors["timber"], rng), rng)
        x += bay / 2
    for side, x in ((-1, 0.0), (1, width)):
        wall = Frame((width, deep, 0), (0, 1, 0)) if side == 1 else Frame((0, depth, 0), (0, -1, 0))
        panel(mesh, "stone", wall, 0, depth - deep, -1.2, TOP + DROP, SANDSTONE)
        for u in (2.2, 5.4):
            window(mesh, wall, u, 1.4, 1.2, 1.6, colors["frame"], rng, base=0.02)
    back = Frame((width, depth, 0), (-1, 0, 0))
    panel(mesh, "plaster", back, 0, width, -1.2, TOP + DROP + sum(STOREYS) + DROP, colors["plaster"], step=2.6)
    for v in (1.4, TOP + 1.2, TOP + STOREYS[0] + 1.4):
        for i in range(6):
            window(mesh, back, 1.7 + i * 2.9, v, 1.1, 1.5, colors["frame"], rng)


def inner_wall(mesh, width, deep, colors, rng):
    """The wall behind the arcade, with two doors and windows between."""
    wall = Frame((0, deep, 0), (1, 0, 0))
    spots = (width * 0.3, width * 0.7)
    holes = [door(mesh, wall, u, 1.3, 2.65, colors, rng, stone=True, arched=True) for u in spots]
    panel(mesh, "plaster", wall, 0, width, -1.2, TOP, shade(colors["plaster"], 0.96), holes, step=1.2)
    for u in (width * 0.1 + 0.5, width * 0.5, width * 0.9 - 0.5):
        for side in (-0.62, 0.62):
            window(mesh, wall, u + side, 1.15, 1.05, 1.6, colors["frame"], rng)
    extrude(mesh, "stone", wall, [(0, -1.2), (width * 0.3 - 0.95, -1.2), (width * 0.3 - 0.95, 0.5), (0, 0.5)], 0, 0.05, LIMESTONE)
    extrude(mesh, "stone", wall, [(width * 0.3 + 0.95, -1.2), (width * 0.7 - 0.95, -1.2), (width * 0.7 - 0.95, 0.5),
                                  (width * 0.3 + 0.95, 0.5)], 0, 0.05, LIMESTONE)
    extrude(mesh, "stone", wall, [(width * 0.7 + 0.95, -1.2), (width, -1.2), (width, 0.5), (width * 0.7 + 0.95, 0.5)],
            0, 0.05, LIMESTONE)
    return [(u, deep) for u in spots]


def upper(mesh, width, depth, y, z, height, overhang, colors, rng, level):
    front = Frame((0, y, z), (1, 0, 0))
    edges = bay_edges(width, 1.2)
    count = len(edges) - 1
    lights = [0 < i < count - 1 and i % 5 != 0 for i in range(count)]
    storey(mesh, front, width, height, colors, rng, lights, "fan" if level == 0 else "cross", "man", (), edges,
           flowers=0.35 if level == 0 else 0)
    jetty(mesh, front, width, overhang, DROP, edges, colors, rng)
    length = depth - y
    for frame in (Frame((width, y, z), (0, 1, 0)), Frame((0, depth, z), (0, -1, 0))):
        side_edges = bay_edges(length, 1.3)
        n = len(side_edges) - 1
        storey(mesh, frame, length, height + (DROP if level == 0 else 0), colors, rng, [i % 3 == 1 for i in range(n)], "plain",
               "brace", (), side_edges)


def roof(mesh, width, depth, y, z, colors, rng):
    slope = math.tan(math.radians(52))
    span = depth - y
    gable_roof(mesh, lambda l, s, h: (l, y + s, h), width, span, z, slope, 0.4, (0.3, 0.3), colors["tile"], colors["timber"],
               rng, sag=0.05)
    for frame in (Frame((width, y, z), (0, 1, 0)), Frame((0, depth, z), (0, -1, 0))):
        gable(mesh, frame, span, slope, colors, rng)
        bargeboards(mesh, frame, span, slope, 0.3, 0.2, colors, rng)
    lift = 0.13 * math.hypot(1, slope)
    main = (y, z + lift, slope)
    dormer(mesh, width / 2, 4.6, y - 0.02, z + 0.02, 2.4, main, slope, colors, colors["tile"], rng, True)
    for x in (width * 0.14, width * 0.28, width * 0.72, width * 0.86):
        back = y + 1.2
        shed_dormer(mesh, x, 1.5, back, z + lift + slope * 1.2, 0.95, main, colors, colors["tile"], rng)
    ridge = z + span / 2 * slope
    middle = y + span / 2
    turret(mesh, width / 2, middle, ridge - 0.6, colors, rng)
    for x in (width * 0.12, width * 0.9):
        chimney(mesh, x, middle + 0.9, ridge - 2.5, ridge + 0.9, rng)


def turret(mesh, x, y, z, colors, rng):
    """A square framed turret on the ridge with a clock and a pointed slate cap."""
    h, tall = 1.05, 3.4
    corners = [(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)]
    for i, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1])):
        wall = Frame((a[0], a[1], z), ((b[0] - a[0]) / (2 * h), (b[1] - a[1]) / (2 * h), 0))
        panel(mesh, "stone", wall, 0, 2 * h, 0, tall, SLATE)
        for u in (0.1, 2 * h - 0.1):
            beam(mesh, wall, (u, 0), (u, tall), 0.16, 0.03, colors["frame"], rng, "planks")
        beam(mesh, wall, (0, tall - 0.1), (2 * h, tall - 0.1), 0.2, 0.08, colors["frame"], rng, "planks", ends=True)
        if i in (0, 2):
            clock(mesh, wall.shifted(h, 2.1), 0, 0)
    ring = [(p[0] + math.copysign(0.22, p[0] - x), p[1] + math.copysign(0.22, p[1] - y), z + tall) for p in corners]
    pyramid(mesh, "stone", ring, (x, y, z + tall + 4.6), SLATE, 3)
    mesh.face("stone", ring[::-1], [(0, 0), (1, 0), (1, 1), (0, 1)], SLATE)
    weathercock(mesh, x, y, z + tall + 4.2)
