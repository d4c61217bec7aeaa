"""One timber-framed house in its own coordinates: x along the street, y away from it, z = 0 at its door."""

import math

from framing import PATTERNS, bargeboards, bay_edges, gable, jetty, storey, tone, window_bays
from mesh import Frame, Mesh, beam, box, extrude, front_frame, panel, shade, srgb
from openings import door, sign, window
from roof import chimney, dormer, gable_roof, shed_dormer

DROP = 0.2          # height of the joists between two storeys
CORNER = 0.034      # how far posts at a corner stand out of both its walls
PLINTH = 0.42       # top of the stone plinth above the door's ground
FOOT = -1.1         # walls reach this deep

PLASTER = ["f4efe2", "f3ead6", "efe4cc", "ecd6a0", "e8c47c", "dfae62", "e9cfae", "e6b9a4", "dc9f8c", "d5dab4", "bfcda6",
           "efe9dc", "e2d2b2", "f2dfb6", "c8d2cc", "e9c8b4"]
TIMBER = ["3b2a1f", "4a3122", "57392a", "5e2c23", "6d3427", "4a443d", "5c554b", "2f2723", "71492f", "40302a", "3d4a40"]
FRAME = ["f4f1e8", "efeade", "f4f1e8", "5a3b28", "e7e0d0", "41584a"]
DOOR = ["3f5a45", "5b3524", "2f4459", "6e2f27", "4b3a2b", "75543a", "3b4f4c", "7a5a2f"]
TILE = [(1.0, 0.95, 0.9), (0.92, 0.8, 0.74), (0.62, 0.6, 0.62), (0.4, 0.42, 0.45), (0.58, 0.72, 0.74), (0.5, 0.5, 0.5)]
ACCENT = [("c9a24a", "8f3b2e"), ("b5532f", "3f6b52"), ("d9b765", "3c5c7a"), ("e0d4b4", "7d3328"), ("c46d3a", "2f4f3c")]


def pick_colors(rng):
    timber = srgb(rng.choice(TIMBER))
    frame = srgb(rng.choice(FRAME))
    door_color = srgb(rng.choice(DOOR))
    return {"plaster": shade(srgb(rng.choice(PLASTER)), rng.uniform(0.92, 1.0)), "timber": timber,
            "bracket": shade(timber, rng.uniform(0.85, 1.25)), "frame": frame, "door": door_color,
            "shutter": srgb(rng.choice(DOOR)), "barge": shade(timber, 0.9), "shift": rng.random() * 4,
            "accent": [srgb(c) for c in rng.choice(ACCENT)],
            "tile": shade(rng.choice(TILE), rng.uniform(0.85, 1.0))}


class House:
    """What the sides of a house have in common while it is built."""

    def __init__(self, plot, rng, storeys, roof):
        self.rng, self.mesh, self.roof = rng, Mesh(), roof
        self.width, self.depth = plot.width, plot.depth
        self.left_open, self.right_open, self.back_open = plot.left_open, plot.right_open, plot.back_open
        self.left_seen, self.right_seen = plot.left_seen, plot.right_seen
        self.passage = plot.kind == "passage" or plot.gateway
        self.colors = pick_colors(rng)
        self.heights = [rng.uniform(2.75, 3.15)] + [rng.uniform(2.5, 2.75) for _ in range(storeys - 1)]
        if self.passage:
            self.heights[0] = 3.3
        self.fronts, self.bases = [0.0], [0.0]
        for i in range(1, storeys):
            step = rng.uniform(0.3, 0.48) if i == 1 else rng.uniform(0.25, 0.34)
            self.fronts.append(self.fronts[-1] - step)
            self.bases.append(self.bases[-1] + self.heights[i - 1] + DROP)
        self.top = self.bases[-1] + self.heights[-1]
        self.doors = []   # (x, y) on the ground
        self.posts_below = []   # of the ground floor, along the front

    @property
    def front(self):
        return self.fronts[-1]


def build_house(plot, rng):
    """Returns the mesh and the doors as (x, y, nx, ny): a point on the front's line and the way out."""
    storeys = rng.choices((2, 3, 4), (0.42, 0.48, 0.10))[0]
    if plot.width < 5.4 and storeys == 4:
        storeys = 3
    roof = "gable" if rng.random() < (0.42 if plot.width < 7.6 else 0.18) else "eaves"
    if plot.kind == "passage" or plot.gateway:
        storeys, roof = 3, "eaves"
    house = House(plot, rng, storeys, roof)
    ground_floor(house)
    for level in range(1, storeys):
        upper_floor(house, level)
    for level in range(storeys):
        sides(house, level)
    cover(house)
    return house.mesh, house.doors


def ground_floor(house):
    mesh, rng, colors, w = house.mesh, house.rng, house.colors, house.width
    height = house.heights[0]
    edges = house.posts_below = bay_edges(w, 1.2)
    bays = len(edges) - 1
    ground = front_frame()
    wall = ground.shifted(0, PLINTH)
    holes, framed = [], rng.random() < 0.72
    if house.passage:
        through = (w / 2 - 1.5, w / 2 + 1.5, FOOT, 2.95)
        holes.append(through)
        passage_walls(house, through)
        bay = rng.choice((0, bays - 1))
    else:
        bay = rng.choice(range(bays)) if bays < 5 else rng.randrange(1, bays - 1)
    u = (edges[bay] + edges[bay + 1]) / 2
    wide = min(1.12, edges[1] - 0.22)
    hole = door(mesh, ground, u, wide, rng.choice((2.15, 2.2, 2.55)), colors, rng, stone=not framed,
                arched=rng.random() < 0.4)
    house.doors.append((u, 0.0))
    holes.append(hole)
    low = [(h[0], h[1], h[2] - PLINTH, h[3] - PLINTH) for h in holes]
    near = [any(h[0] - 0.3 < edges[i + 1] and edges[i] < h[1] + 0.3 for h in holes) for i in range(bays)]
    lights = [not near[i] and rng.random() < 0.85 for i in range(bays)]
    with_shutters = rng.random() < 0.45
    if framed:
        storey(mesh, wall, w, height - PLINTH, colors, rng, lights, rng.choice(("foot", "plain", "cross")),
               rng.choice(("brace", "none")), low, edges, with_shutters, flowers=0.25)
    else:
        panel(mesh, "plaster", wall, 0, w, 0, height - PLINTH, colors["plaster"], low, uv_shift=(colors["shift"], 0.0))
        beam(mesh, wall, (0, height - PLINTH - 0.1), (w, height - PLINTH - 0.1), 0.2, 0.04, tone(colors["timber"], rng), rng)
        solid_windows(house, wall, edges, lights, height)
    plinth(mesh, ground, w, [(h[0], h[1]) for h in holes], rng)
    if rng.random() < 0.3 and not house.passage:
        side = 1 if u < w / 2 else -1
        sign(mesh, ground, min(w - 0.4, max(0.4, u + side * 0.95)), 2.42, rng)


def solid_windows(house, wall, edges, lights, height):
    """Windows of a rendered ground floor, in stone surrounds."""
    stone = srgb("cfc3ad")
    for i, lit in enumerate(lights):
        if lit:
            u = (edges[i] + edges[i + 1]) / 2
            half = min(0.95, edges[1] - 0.3) / 2
            v, top = 0.55, min(0.55 + 1.3, height - PLINTH - 0.4)
            for a, b in (((u - half - 0.06, v - 0.1), (u - half - 0.06, top + 0.12)),
                         ((u + half + 0.06, v - 0.1), (u + half + 0.06, top + 0.12)),
                         ((u - half, top + 0.06), (u + half, top + 0.06)), ((u - half, v - 0.05), (u + half, v - 0.05))):
                beam(house.mesh, wall, a, b, 0.12, 0.04, stone, house.rng, "stone", ends=True)
            window(house.mesh, wall, u, v, half * 2, top - v, house.colors["frame"], house.rng, sill=False)


def plinth(mesh, ground, width, gaps, rng):
    """Stone foot of a wall, between the gaps."""
    color = shade(srgb("d8ccb8"), rng.uniform(0.82, 1.0))
    start = 0.0
    for a, b in sorted(gaps) + [(width, width)]:
        if a - start > 0.05:
            cuts = max(1, int((a - start) / 1.6))
            for i in range(cuts):
                p, q = start + (a - start) * i / cuts, start + (a - start) * (i + 1) / cuts
                sides = (2,) + ((3,) if i == 0 else ()) + ((1,) if i == cuts - 1 else ())
                extrude(mesh, "stone", ground, [(p, FOOT), (q, FOOT), (q, PLINTH), (p, PLINTH)], 0.0, 0.06, color,
                        flanks=sides)
        start = max(start, b)


def passage_walls(house, hole):
    """The way through the house: side walls, ceiling with joists, the far wall's opening."""
    mesh, rng, colors = house.mesh, house.rng, house.colors
    u0, u1, _, top = hole
    stone = srgb("c8baa2")
    d = house.depth
    for frame in (Frame((u0, 0, 0), (0, 1, 0)), Frame((u1, d, 0), (0, -1, 0))):
        panel(mesh, "stone", frame, 0, d, FOOT, 1.2, stone, step=1.2)
        panel(mesh, "plaster", frame, 0, d, 1.2, top, shade(colors["plaster"], 0.9), step=1.2)
        beam(mesh, frame, (0, 1.2), (d, 1.2), 0.14, 0.04, tone(colors["timber"], rng), rng, ends=True)
        beam(mesh, frame, (0, top - 0.3), (d, top - 0.3), 0.18, 0.06, tone(colors["timber"], rng), rng, ends=True)
    panel(mesh, "planks", Frame((u0, d, top), (1, 0, 0), (0, -1, 0)), 0, u1 - u0, 0, d, shade(colors["timber"], 1.3), step=1.5)
    y = 0.4
    while y < d:
        ceiling = Frame((u0, y, top), (1, 0, 0), (0, -1, 0))
        beam(mesh, ceiling, (0, 0), (u1 - u0, 0), 0.2, 0.18, tone(colors["timber"], rng), rng)
        y += 1.05
    for frame in (front_frame(), Frame((house.width, d, 0), (-1, 0, 0))):
        a, b = (u0, u1) if frame.u[0] > 0 else (house.width - u1, house.width - u0)
        for u in (a - 0.1, b + 0.1):
            beam(mesh, frame, (u, -0.3), (u, top), 0.2, 0.1, tone(colors["timber"], rng), rng)
        beam(mesh, frame, (a - 0.3, top + 0.13), (b + 0.3, top + 0.13), 0.26, 0.11, tone(colors["timber"], rng), rng,
             ends=True)
        for s, u in ((1, a), (-1, b)):
            brace = [(u, top - 0.8), (u + s * 0.66, top), (u + s * 0.5, top), (u, top - 0.6)]
            extrude(mesh, "timber", frame, brace[::s], -0.1, 0.05, tone(colors["timber"], rng), back=True)


def upper_floor(house, level):
    mesh, rng, colors, w = house.mesh, house.rng, house.colors, house.width
    frame = Frame((0, house.fronts[level], house.bases[level]), (1, 0, 0))
    edges = bay_edges(w)
    lights = window_bays(len(edges) - 1, rng)
    if level == 1:
        house.pattern, house.corner = rng.choice(PATTERNS), rng.choice(("brace", "brace", "man"))
    pattern = house.pattern if level == 1 or rng.random() < 0.5 else rng.choice(PATTERNS)
    storey(mesh, frame, w, house.heights[level], colors, rng, lights, pattern, house.corner, (), edges,
           flowers=0.12 if level == 1 else 0.04, sills=False)
    overhang = house.fronts[level - 1] - house.fronts[level]
    jetty(mesh, frame, w, overhang, DROP, edges, colors, rng, brackets=1 if level == 1 else 2,
          feet=house.posts_below if level == 1 else None)
    y0, y1, z = house.fronts[level - 1], house.fronts[level], house.bases[level]
    for x, order, open_side in ((0.0, -1, house.left_open), (w, 1, house.right_open)):
        if open_side:
            points = [(x, y0, z), (x, y1, z), (x, y0, z - DROP)][::order]
            mesh.face("timber", points, [(0, 0), (0.4, 0), (0, 0.2)], tone(colors["timber"], rng))


def sides(house, level):
    """Left, right and back walls of a storey; framed where they can be seen."""
    mesh, rng, colors, w, d = house.mesh, house.rng, house.colors, house.width, house.depth
    z, y = house.bases[level], house.fronts[level]
    last = level == len(house.heights) - 1
    height = house.heights[level] + (0.0 if last else DROP)
    low = FOOT if level == 0 else z
    for frame, is_open, seen in ((Frame((w, y, 0), (0, 1, 0)), house.right_open, house.right_seen),
                                 (Frame((0, d, 0), (0, -1, 0)), house.left_open, house.left_seen)):
        length = d - y
        if is_open and level > 0:
            corner_post(house, frame.u[1] > 0, y, z, height)
        if not is_open:
            panel(mesh, "plaster", frame, 0, length, low, z + height, colors["plaster"], step=4.5)
        elif level == 0:
            panel(mesh, "plaster", frame, 0, length, low, z + height, colors["plaster"])
            plinth(mesh, frame, length, [], rng)
        elif not seen:
            rough_frame(house, frame.shifted(0, z), length, height)
        else:
            edges = bay_edges(length, 1.3)
            lights = [b and rng.random() < 0.5 for b in window_bays(len(edges) - 1, rng)]
            storey(mesh, frame.shifted(0, z), length, height, colors, rng, lights, "plain", "brace", (), edges)
    back = Frame((w, d, 0), (-1, 0, 0))
    holes = []
    if house.passage and level == 0:
        holes = [(w / 2 - 1.5, w / 2 + 1.5, FOOT, 2.95)]
    panel(mesh, "plaster", back, 0, w, low, z + height, shade(colors["plaster"], 0.95), holes, step=2.6)
    if house.back_open:
        for u in (w * 0.25, w * 0.75):
            window(mesh, back, u, z + 0.95, 0.85, 1.15, colors["frame"], rng)
        if level > 0:
            rough_frame(house, back.shifted(0, z), w, height, plaster=False)


def corner_post(house, right, y, z, height):
    """Fills the notch between the posts of two walls, through which a line of plaster would glitter from afar."""
    x, out = house.width if right else -CORNER, CORNER
    box(house.mesh, "timber", (x, y - out, z), (x + out, y, z + height), house.colors["timber"], skip="zZY")


def rough_frame(house, frame, length, height, plaster=True):
    """Plain framing of a wall that is only seen from afar."""
    colors, rng = house.colors, house.rng
    if plaster:
        panel(house.mesh, "plaster", frame, 0, length, 0, height, colors["plaster"], step=2.6)
    count = max(2, round(length / 1.9))
    for v in (0.09, height * 0.5, height - 0.09):  # no plaster shows between them and the timbers above and below
        beam(house.mesh, frame, (0, v), (length, v), 0.18, 0.03, tone(colors["timber"], rng), rng, step=9, flanks=False)
    for i in range(count + 1):
        u = min(max(0.09, length * i / count), length - 0.09)
        beam(house.mesh, frame, (u, 0.2), (u, height - 0.2), 0.16, 0.026, tone(colors["timber"], rng), rng, step=9,
             flanks=False)


def cover(house):
    """Roof, gables, dormers, chimney."""
    mesh, rng, colors, w, d = house.mesh, house.rng, house.colors, house.width, house.depth
    y0, z, tint = house.front, house.top, house.colors["tile"]
    timber = colors["timber"]
    pitch = math.radians(rng.uniform(50, 57))
    slope = math.tan(pitch)
    if house.roof == "gable":
        slope = min(slope * 1.06, math.tan(math.radians(60)))
        verge = (0.34, 0.1)
        gable_roof(mesh, lambda l, s, h: (w - s, y0 + l, h), d - y0, w, z, slope, 0.22, verge, tint, timber, rng)
        front = Frame((0, y0, z), (1, 0, 0))
        gable(mesh, front, w, slope, colors, rng)
        bargeboards(mesh, front, w, slope, 0.34, 0.16, colors, rng)
        gable(mesh, Frame((w, d, z), (-1, 0, 0)), w, slope, colors, rng, decorated=house.back_open, windows=False,
              flanks=False)
        ridge_x, ridge_y, rise = w / 2, rng.uniform(0.45, 0.75) * d, w / 2 * slope
        chimney(mesh, ridge_x + rng.choice((-0.7, 0.7)), ridge_y, z + rise - 2.0, z + rise + rng.uniform(0.5, 1.0), rng)
        return
    span = d - y0
    verge = (0.24 if house.left_open else 0.03, 0.24 if house.right_open else 0.03)
    gable_roof(mesh, lambda l, s, h: (l, y0 + s, h), w, span, z, slope, 0.36, verge, tint, timber, rng)
    for frame, is_open, seen in ((Frame((w, y0, z), (0, 1, 0)), house.right_open, house.right_seen),
                                 (Frame((0, d, z), (0, -1, 0)), house.left_open, house.left_seen)):
        gable(mesh, frame, span, slope, colors, rng, decorated=is_open, windows=seen, flanks=seen)
        if is_open:
            bargeboards(mesh, frame, span, slope, 0.24, 0.2, colors, rng)
    rise = span / 2 * slope
    lift = 0.13 * math.hypot(1, slope)
    main = (y0, z + lift, slope)
    wish = rng.random()
    if wish < 0.3 and w > 5.8:
        wide = min(3.2, w * 0.45)
        dormer(mesh, w / 2 + rng.uniform(-0.6, 0.6), wide, y0 - 0.02, z + 0.02, 2.1, main, slope, colors, tint, rng, True)
    elif wish < 0.85:
        count = 1 if w < 6.2 else 2
        y = y0 + rng.uniform(0.9, 1.3)
        base = z + lift + slope * (y - y0)
        gabled = rng.random() < 0.5
        for i in range(count):
            x = w * (i + 0.5) / count
            if gabled:
                dormer(mesh, x, 1.15, y, base, 1.15, main, 1.0, colors, tint, rng)
            else:
                shed_dormer(mesh, x, 1.5, y, base, 0.95, main, colors, tint, rng)
    chimney(mesh, rng.uniform(0.2, 0.8) * w, y0 + span / 2 + rng.uniform(0.3, 0.8), z + rise - 2.2,
            z + rise + rng.uniform(0.5, 1.0), rng)
