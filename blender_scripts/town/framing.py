"""Timber framing of one wall or gable: sills, plates, posts, rails, braces and the fields between them."""

import math

from mesh import Frame, beam, extrude, panel, polygon, shade
from openings import flower_box, shutters, window

POST = 0.17        # width of a post
SILL = 0.22        # height of the sill beam
PLATE = 0.18       # height of the top plate
PROUD = 0.03       # how far timbers stand out of the plaster
PARAPET = 0.92     # top of the parapet rail above the storey's floor
PATTERNS = ("cross", "cross", "lozenge", "fan", "foot", "curve", "plain")


def tone(color, rng, spread=0.09):
    return shade(color, rng.uniform(1 - spread, 1 + spread))


def bay_edges(width, wish=1.12):
    count = max(3, round(width / wish))
    return [width * i / count for i in range(count + 1)]


def window_bays(count, rng):
    """Which bays hold a window: the same from both ends."""
    style = rng.choice(("pairs", "alternate", "ribbon", "ribbon"))
    half = (count + 1) // 2
    row = []
    for i in range(half):
        if i == 0:
            row.append(False)
        elif style == "alternate":
            row.append(i % 2 == 1)
        elif style == "pairs":
            row.append(i % 3 != 0)
        else:
            row.append(True)
    if count <= 4:
        row = [False] + [True] * (half - 1)
    return [row[min(i, count - 1 - i)] for i in range(count)]


def field(mesh, frame, pattern, u0, u1, v0, v1, colors, rng):
    """Ornament between two posts and two rails."""
    color = tone(colors["timber"], rng)
    w, h = u1 - u0, v1 - v0
    um, vm = (u0 + u1) / 2, (v0 + v1) / 2
    if w < 0.4 or h < 0.3 or pattern == "plain":
        return
    if pattern == "cross":
        beam(mesh, frame, (u0, v0), (u1, v1), 0.12, PROUD - 0.006, color, rng, step=9)
        beam(mesh, frame, (u0, v1), (u1, v0), 0.12, PROUD - 0.012, tone(color, rng), rng, step=9)
    elif pattern == "lozenge":
        for a, b in (((um, v0), (u1, vm)), ((u1, vm), (um, v1)), ((um, v1), (u0, vm)), ((u0, vm), (um, v0))):
            beam(mesh, frame, a, b, 0.1, PROUD - 0.008, color, rng, step=9)
    elif pattern == "foot":
        for side, post in ((1, u0), (-1, u1)):
            beam(mesh, frame, (post + side * w * 0.42, v0), (post, v0 + h * 0.86), 0.13, PROUD - 0.008, color, rng, step=9)
    elif pattern == "curve":
        for side, post in ((1, u0), (-1, u1)):
            last = (post + side * w * 0.48, v0)
            for t in (0.5, 1.0):
                here = (post + side * w * 0.48 * (1 - t) ** 1.6, v0 + h * t ** 0.8)
                beam(mesh, frame, last, here, 0.12, PROUD - 0.008, color, rng, step=9)
                last = here
    elif pattern == "fan":
        radius = min(w * 0.48, h * 0.86)
        rays = 7
        accent = colors["accent"]
        arc = [(um + radius * math.cos(math.pi * i / rays), v0 + radius * math.sin(math.pi * i / rays))
               for i in range(rays + 1)]
        polygon(mesh, "timber", frame, [(u0, v0), (u1, v0), (u1, v1), (u0, v1)], tone(color, rng), 0.008)
        for i in range(rays):
            a, b = arc[i], arc[i + 1]
            polygon(mesh, "planks", frame, [(um, v0), a, b], accent[i % len(accent)], 0.018 + 0.006 * (i % 2))


def storey(mesh, frame, width, height, colors, rng, windows, pattern, corner="brace", holes=(), posts=None,
           with_shutters=False, flowers=0.0, sills=True):
    """One storey of framing on a wall from u = 0 to width and v = 0 to height."""
    edges = posts or bay_edges(width)
    panel(mesh, "plaster", frame, 0, width, 0, height, colors["plaster"], holes, uv_shift=(colors["shift"], colors["shift"]))
    timber = colors["timber"]

    def clear(u0, u1, v0, v1):
        return not any(h[0] < u1 and u0 < h[1] and h[2] < v1 and v0 < h[3] for h in holes)

    top = height - PLATE
    gaps = sorted((h[0] - 0.02, h[1] + 0.02) for h in holes if h[2] < SILL)
    start = 0.0
    for a, b in gaps + [(width, width)]:
        if a > start:
            beam(mesh, frame, (start, SILL / 2), (a, SILL / 2), SILL, PROUD + 0.012, tone(timber, rng), rng, ends=not gaps)
        start = b
    beam(mesh, frame, (0, height - PLATE / 2), (width, height - PLATE / 2), PLATE, PROUD + 0.008, tone(timber, rng), rng)
    for i, u in enumerate(edges):
        u = min(max(u, POST / 2), width - POST / 2)
        if clear(u - POST / 2, u + POST / 2, 0.3, top):
            wobble = rng.uniform(-0.012, 0.012)
            beam(mesh, frame, (u + wobble, SILL), (u - wobble, top), POST, PROUD, tone(timber, rng), rng)
    for i, (a, b) in enumerate(zip(edges, edges[1:])):
        a, b = max(a, POST / 2) + POST / 2, min(b, width - POST / 2) - POST / 2
        if not clear(a, b, 0.3, top):
            continue
        last = len(edges) - 2
        if windows[i]:
            sill_v = PARAPET
            beam(mesh, frame, (a, PARAPET - 0.07), (b, PARAPET - 0.07), 0.14, PROUD - 0.003, tone(timber, rng), rng, step=9)
            field(mesh, frame, pattern, a, b, SILL, PARAPET - 0.14, colors, rng)
            tall = min(1.28, top - sill_v - 0.06)
            if top - sill_v - tall > 0.24:
                z = sill_v + tall + 0.08
                beam(mesh, frame, (a, z), (b, z), 0.13, PROUD - 0.003, tone(timber, rng), rng, step=9)
            wide = min(b - a - 0.02, 1.05)
            if with_shutters:
                wide = min(wide, 0.62)
                shutters(mesh, frame, (a + b) / 2, sill_v, wide, tall, colors["shutter"], rng, PROUD)
            blooming = rng.random() < flowers
            window(mesh, frame, (a + b) / 2, sill_v, wide, tall, colors["frame"], rng, sill=sills or blooming,
                   casements=2 if wide > 0.7 else 1)
            if blooming:
                flower_box(mesh, frame, (a + b) / 2, sill_v, wide, rng)
        elif corner == "brace" and i in (0, last) and last > 0:
            s, e = (b, a) if i == 0 else (a, b)
            beam(mesh, frame, (s, SILL), (e, top - 0.25), 0.15, PROUD - 0.006, tone(timber, rng), rng)
            rail(mesh, frame, a, b, height * 0.52, colors, rng)
        elif corner == "man" and i in (0, last) and last > 0:
            for (p, q) in (((a, SILL), (b, top)), ((a, top), (b, SILL))):
                beam(mesh, frame, p, q, 0.13, PROUD - rng.uniform(0.005, 0.012), tone(timber, rng), rng)
            rail(mesh, frame, a, b, height * 0.52, colors, rng)
        else:
            rail(mesh, frame, a, b, PARAPET - 0.07, colors, rng)
            rail(mesh, frame, a, b, (PARAPET + top) / 2 + 0.1, colors, rng)
            field(mesh, frame, pattern if rng.random() < 0.5 else "foot", a, b, SILL, PARAPET - 0.14, colors, rng)
    return edges


def rail(mesh, frame, a, b, v, colors, rng):
    beam(mesh, frame, (a, v), (b, v), 0.13, PROUD - 0.004, tone(colors["timber"], rng), rng, step=9)


def gable(mesh, frame, width, slope, colors, rng, decorated=True, windows=True, base=0.0, flanks=True):
    """The triangle above a wall from u = 0 to width at v = base; slope: rise per metre."""
    peak = width / 2 * slope
    levels = [0.0]
    while levels[-1] + 2.2 < peak - 0.9:
        levels.append(levels[-1] + 2.25)
    levels.append(peak)
    timber = colors["timber"]
    for low, high in zip(levels, levels[1:]):
        a, b = low / slope, high / slope
        cuts = max(2, int((width - 2 * a) / 1.6))
        for i in range(cuts):
            corners = [(a + (width - 2 * a) * i / cuts, base + low), (a + (width - 2 * a) * (i + 1) / cuts, base + low),
                       (b + (width - 2 * b) * (i + 1) / cuts, base + high), (b + (width - 2 * b) * i / cuts, base + high)]
            if high == peak:
                corners = corners[:3]
            polygon(mesh, "plaster", frame, corners, colors["plaster"], uv_shift=(colors["shift"], 0.0))
    if not decorated:
        return
    for index, (low, high) in enumerate(zip(levels, levels[1:])):
        a = low / slope
        lap = 0.04 if index == 0 else 0.0   # over the plate below, so that no plaster shows between them
        axis, tall = base + low + 0.09 - lap / 2, 0.18 + lap
        beam(mesh, frame, (a, axis), (width - a, axis), tall, PROUD + 0.012, tone(timber, rng), rng, flanks=flanks)
        span = width - 2 * a
        count = max(2, round(span / 1.12))
        if count % 2 == 0 and span > 2.4:
            count += 1
        edges = [a + span * i / count for i in range(count + 1)]
        for u in edges[1:-1]:
            top = min(base + high, base + min(u, width - u) * slope - 0.14)
            if top - base - low > 0.5:
                beam(mesh, frame, (u, base + low + 0.18), (u, top), POST * 0.9, PROUD, tone(timber, rng), rng,
                     flanks=flanks)
        middle = count // 2
        for i, (p, q) in enumerate(zip(edges, edges[1:])):
            head = min(high, min(p, width - q) * slope - 0.1) - low
            p, q = p + POST / 2, q - POST / 2
            lights = windows and (count % 2 == 1) and abs(i - middle) <= (1 if index == 0 and count >= 5 else 0)
            if lights and head > 1.7 and q - p > 0.45:
                tall = min(1.1, head - 0.85)
                rail(mesh, frame, p, q, base + low + 0.68, colors, rng)
                field(mesh, frame, "cross", p, q, base + low + 0.18, base + low + 0.61, colors, rng)
                window(mesh, frame, (p + q) / 2, base + low + 0.76, min(0.9, q - p - 0.02), tall, colors["frame"], rng)
            elif head > 1.2:
                rail(mesh, frame, p, q, base + low + min(1.1, head * 0.55), colors, rng)
        for side in (0, 1):
            foot = edges[1] if side == 0 else edges[-2]
            if high < peak and count >= 3:
                top = min(high - 0.1, (foot if side == 0 else width - foot) * slope - 0.3)
                end = foot + (0.75 if side == 0 else -0.75) * min(1.0, top - low - 0.3)
                if top - low > 0.9:
                    beam(mesh, frame, (end, base + low + 0.18), (foot, base + top), 0.12, PROUD - 0.01, tone(timber, rng),
                         rng, flanks=flanks)


def bargeboards(mesh, frame, width, slope, over, drop, colors, rng):
    """Boards along the verges of a gable that stand `over` in front of it."""
    peak = width / 2 * slope
    plane = frame.shifted(0, 0, over)
    for a, b in (((-drop / slope, -drop), (width / 2, peak)), ((width / 2, peak), (width + drop / slope, -drop))):
        beam(mesh, plane, a, b, 0.2, 0.0, colors["barge"], rng, "planks", base=-0.04, ends=True)


def jetty(mesh, frame, width, overhang, drop, posts, colors, rng, brackets=1, feet=None):
    """What carries an upper wall that stands `overhang` before the lower one: joist ends, brackets, filling boards.

    frame: the upper wall, its v = 0 at the lower edge of its sill; drop: height of the joists; brackets: under every
    joist (1) or every other one (2); feet: where posts of the wall below carry them instead, clear of its windows.
    """
    timber = colors["timber"]
    lower, upper = -overhang, 0.0
    tones = []
    cuts = max(2, int(width / 1.6))
    for i in range(cuts):
        a, b = width * i / cuts, width * (i + 1) / cuts
        mesh.face("timber", [frame.at(a, -drop, lower), frame.at(b, -drop, lower), frame.at(b, 0, upper),
                             frame.at(a, 0, upper)], [(a, 0), (b, 0), (b, 0.5), (a, 0.5)], shade(timber, 0.8))
    for i, u in enumerate(posts):
        u = min(max(u, 0.1), width - 0.1)
        color = tone(timber, rng)
        a, b = u - 0.085, u + 0.085
        f = frame.at
        end = 0.02
        mesh.face("timber", [f(a, -drop, end), f(b, -drop, end), f(b, 0, end), f(a, 0, end)],
                  [(0, 0), (0.17, 0), (0.17, drop), (0, drop)], color)
        mesh.face("timber", [f(a, -drop, lower), f(a, -drop, end), f(a, 0, end), f(a, 0, lower)],
                  [(0, 0), (overhang, 0), (overhang, drop), (0, drop)], color)
        mesh.face("timber", [f(b, -drop, end), f(b, -drop, lower), f(b, 0, lower), f(b, 0, end)],
                  [(0, 0), (overhang, 0), (overhang, drop), (0, drop)], color)
        mesh.face("timber", [f(a, -drop, lower), f(b, -drop, lower), f(b, -drop, end), f(a, -drop, end)],
                  [(0, 0), (0.17, 0), (0.17, overhang), (0, overhang)], color)
        if i % brackets == 0:
            tones.append(tone(colors["bracket"], rng))
    for i, u in enumerate(posts[::brackets] if feet is None else feet):
        u = min(max(u, 0.1), width - 0.1)
        side = Frame(frame.at(u - 0.06, -drop, lower), frame.n)   # the bracket seen from the left
        reach, fall = overhang * 0.92, 0.52
        profile = [(0, -fall), (reach * 0.45, -fall * 0.6), (reach, -0.08), (reach, 0.0), (0, 0.0)]
        extrude(mesh, "timber", side, profile, -0.12, 0.0, tones[i % len(tones)], front=True, back=True,
                flanks=(0, 1, 2))

