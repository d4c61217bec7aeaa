"""Steep tiled roofs, dormers and chimneys, in the coordinates of the house (x along the street, y away from it)."""

import math

from framing import PROUD, gable, tone
from mesh import Frame, Mesh, beam, box, extrude, lathe, panel, shade, srgb, ticks
from openings import window

THICK = 0.13   # of the covering, seen at the eaves


def gable_roof(mesh, place, length, span, z, slope, over_eaves, over_verge, tint, timber, rng, sag=0.08):
    """A roof over 0..length (along the ridge) and 0..span; `place(l, s, z)` gives house coordinates.

    over_verge: overhang at the two gables.
    """
    rise = span / 2 * slope
    lean = math.hypot(1, slope)
    lift = THICK * lean
    l0, l1 = -over_verge[0], length + over_verge[1]
    bend = rng.uniform(0.4, 1.0) * sag

    def height(l, s):
        t = max(0.0, s) / (span / 2)
        return z + slope * s - bend * math.sin(math.pi * min(1, max(0, l / length))) * t

    shift = (rng.random() * 3, rng.random() * 3)
    ls = ticks(l0, l1, 1.7)
    ss = ticks(-over_eaves, span / 2, 1.5)
    for mirror in (False, True):
        def point(l, s, dz=0.0):
            return place(l, span - s if mirror else s, height(l, s) + dz)

        def ordered(points, uvs):
            return (points[::-1], uvs[::-1]) if mirror else (points, uvs)

        for a, b in zip(ls, ls[1:]):
            for c, d in zip(ss, ss[1:]):
                points = [point(a, c, lift), point(b, c, lift), point(b, d, lift), point(a, d, lift)]
                uvs = [(u + shift[0], v * lean + shift[1]) for u, v in ((a, c), (b, c), (b, d), (a, d))]
                mesh.face("roof_tile", *ordered(points, uvs), shade(tint, rng.uniform(0.96, 1.04)))
            c = -over_eaves
            points = [point(a, c), point(b, c), point(b, c, lift), point(a, c, lift)]
            mesh.face("roof_tile", *ordered(points, [(a, 0.0), (b, 0.0), (b, 0.1), (a, 0.1)]), shade(tint, 0.8))
            points = [point(a, 0.04), point(b, 0.04), point(b, c), point(a, c)]
            mesh.face("timber", *ordered(points, [(a, 0), (b, 0), (b, 0.4), (a, 0.4)]), shade(timber, 0.75))
        for c, d in zip(ss, ss[1:]):
            for end, flip in ((l0, False), (l1, True)):
                points = [point(end, d), point(end, c), point(end, c, lift), point(end, d, lift)]
                uvs = [(d, 0), (c, 0), (c, 0.12), (d, 0.12)]
                if flip:
                    points, uvs = points[::-1], uvs[::-1]
                mesh.face("roof_tile", *ordered(points, uvs), shade(tint, 0.75))
        for edge, inner, over in ((l0, 0.0, over_verge[0]), (length, l1, over_verge[1])):
            if over > 0.1:
                for c, d in zip(ss, ss[1:]):
                    points = [point(edge, d), point(inner if edge == l0 else l1, d),
                              point(inner if edge == l0 else l1, c), point(edge, c)]
                    mesh.face("timber", *ordered(points, [(d, 0), (d, over), (c, over), (c, 0)]), shade(timber, 0.75))
    for a, b in zip(ls, ls[1:]):
        _ridge_piece(mesh, place, a, b, span / 2, height, lift, tint)
    return z + rise + lift


def _ridge_piece(mesh, place, a, b, middle, height, lift, tint):
    profile = [(-0.15, -0.13), (-0.09, 0.05), (0.09, 0.05), (0.15, -0.13)]
    za, zb = height(a, middle) + lift, height(b, middle) + lift
    for (s0, d0), (s1, d1) in zip(profile, profile[1:]):
        mesh.face("roof_tile", [place(a, middle + s0, za + d0), place(b, middle + s0, zb + d0),
                                place(b, middle + s1, zb + d1), place(a, middle + s1, za + d1)],
                  [(a, 0.05), (b, 0.05), (b, 0.2), (a, 0.2)], shade(tint, 0.92))


def dormer(mesh, x, width, y_front, z_base, wall, main, slope, colors, tint, rng, decorated=False):
    """A gabled dormer; main = (y, z, slope) of the roof it stands on: a point of the roof's plane and its slope."""
    y_ref, z_ref, k = main

    def behind(z):
        return y_ref + (z - z_ref) / k

    x0, x1 = x - width / 2, x + width / 2
    z_wall = z_base + wall
    z_ridge = z_wall + width / 2 * slope
    front = Frame((x0, y_front, z_base), (1, 0, 0))
    timber = colors["timber"]
    panel(mesh, "plaster", front, 0, width, -0.15, wall, colors["plaster"], uv_shift=(colors["shift"], 0))
    for u in ((0.08, width - 0.08) if not decorated else (0.08, width / 3, 2 * width / 3, width - 0.08)):
        beam(mesh, front, (u, 0), (u, wall), 0.14, PROUD, tone(timber, rng), rng)
    for v in (0.08, wall - 0.07):
        beam(mesh, front, (0, v), (width, v), 0.15, PROUD + 0.01, tone(timber, rng), rng, ends=True)
    if decorated:
        for i in range(3):
            window(mesh, front, width * (i + 0.5) / 3, wall - 1.28, width / 3 - 0.2, 1.08, colors["frame"], rng)
    else:
        window(mesh, front, width / 2, 0.2, width - 0.36, wall - 0.4, colors["frame"], rng)
    gable(mesh, front, width, slope, colors, rng, decorated=decorated, windows=decorated, base=wall)
    for side in (0, 1):
        xs = x0 if side == 0 else x1
        points = [(xs, behind(z_wall), z_wall), (xs, y_front, z_base - 0.15), (xs, y_front, z_wall)]
        if behind(z_base) > y_front + 0.05:
            points = [(xs, behind(z_wall), z_wall), (xs, behind(z_base - 0.15), z_base - 0.15),
                      (xs, y_front, z_base - 0.15), (xs, y_front, z_wall)]
        uvs = [(p[1], p[2]) for p in points]
        if side == 1:
            points, uvs = points[::-1], uvs[::-1]
        mesh.face("plaster", points, uvs, colors["plaster"])
    over, out, lift = 0.16, 0.2, 0.1
    z_eave = z_wall - over * slope
    for side in (-1, 1):
        xe = x + side * (width / 2 + over)
        top = [(xe, y_front - out, z_eave + lift), (xe, behind(z_eave) + 0.1, z_eave + lift),
               (x, behind(z_ridge) + 0.15, z_ridge + lift), (x, y_front - out, z_ridge + lift)]
        run = math.hypot(width / 2 + over, z_ridge - z_eave)
        uvs = [(top[0][1], 0), (top[1][1], 0), (top[2][1], run), (top[3][1], run)]
        under = [(p[0], p[1], p[2] - lift) for p in (top[0], top[3])] + \
                [(x, y_front + 0.02, z_ridge), (xe, y_front + 0.02, z_eave)]
        rim = [(xe, y_front - out, z_eave), (x, y_front - out, z_ridge), top[3], top[0]]
        eave = [(xe, y_front - out, z_eave), (xe, behind(z_eave) + 0.1, z_eave), top[1], top[0]]
        if side == -1:
            top, uvs = top[::-1], uvs[::-1]
            eave, under = eave[::-1], under[::-1]
        else:
            rim = rim[::-1]
        mesh.face("roof_tile", top, uvs, tint)
        mesh.face("timber", under, [(0, 0), (run, 0), (run, 0.2), (0, 0.2)], shade(timber, 0.7))
        mesh.face("planks", rim, [(0, 0), (0, run), (0.1, run), (0.1, 0)], colors["barge"])
        mesh.face("roof_tile", eave, [(0, 0), (1, 0), (1, 0.1), (0, 0.1)], shade(tint, 0.8))


def shed_dormer(mesh, x, width, y_front, z_base, wall, main, colors, tint, rng):
    """A dormer with one flat-pitched roof that runs back into the main one."""
    y_ref, z_ref, k = main
    pitch = 0.42
    z_wall = z_base + wall
    # Where the flat roof from (y_front, z_wall) meets the main one.
    y_meet = y_front + (z_wall - (z_ref + k * (y_front - y_ref))) / (k - pitch)
    z_meet = z_wall + pitch * (y_meet - y_front)
    x0, x1 = x - width / 2, x + width / 2
    front = Frame((x0, y_front, z_base), (1, 0, 0))
    panel(mesh, "plaster", front, 0, width, -0.15, wall, colors["plaster"])
    for u in (0.07, width / 2, width - 0.07):
        beam(mesh, front, (u, 0), (u, wall), 0.12, PROUD, tone(colors["timber"], rng), rng)
    for v in (0.07, wall - 0.06):
        beam(mesh, front, (0, v), (width, v), 0.13, PROUD + 0.01, tone(colors["timber"], rng), rng, ends=True)
    for i in (0, 1):
        window(mesh, front, width * (i + 0.5) / 2, 0.16, width / 2 - 0.24, wall - 0.32, colors["frame"], rng)
    for side in (0, 1):
        xs = x0 if side == 0 else x1
        points = [(xs, y_meet, z_meet), (xs, y_front, z_base - 0.15), (xs, y_front, z_wall)]
        uvs = [(p[1], p[2]) for p in points]
        mesh.face("planks", points if side == 0 else points[::-1], uvs if side == 0 else uvs[::-1], colors["barge"])
    over, out, lift = 0.14, 0.24, 0.1
    a, b = x0 - over, x1 + over
    y0, z0 = y_front - out, z_wall - out * pitch
    top = [(a, y0, z0 + lift), (b, y0, z0 + lift), (b, y_meet + 0.1, z_meet + lift), (a, y_meet + 0.1, z_meet + lift)]
    run = math.hypot(y_meet - y0, z_meet - z0)
    mesh.face("roof_tile", top, [(a, 0), (b, 0), (b, run), (a, run)], tint)
    mesh.face("roof_tile", [(a, y0, z0), (b, y0, z0), top[1], top[0]], [(a, 0), (b, 0), (b, 0.1), (a, 0.1)],
              shade(tint, 0.8))
    mesh.face("timber", [(a, y_front, z_wall), (b, y_front, z_wall), (b, y0, z0), (a, y0, z0)],
              [(a, 0), (b, 0), (b, 0.2), (a, 0.2)], shade(colors["timber"], 0.7))
    for xs, order in ((a, 1), (b, -1)):
        points = [(xs, y_meet + 0.1, z_meet), (xs, y0, z0), (xs, y0, z0 + lift), (xs, y_meet + 0.1, z_meet + lift)]
        mesh.face("roof_tile", points[::order], [(0, 0), (run, 0), (run, 0.1), (0, 0.1)][::order], shade(tint, 0.8))


def chimney(mesh, x, y, z_low, z_top, rng):
    """A rendered or brick stack with a cap."""
    color = rng.choice([srgb("b0644c"), srgb("9c5a46"), srgb("cfc4b2")])
    w, d = rng.uniform(0.42, 0.6), rng.uniform(0.5, 0.85)
    low, high = (x - w / 2, y - d / 2), (x + w / 2, y + d / 2)
    box(mesh, "stone", (*low, z_low), (*high, z_top - 0.25), color, skip="zZ")
    box(mesh, "stone", (low[0] - 0.06, low[1] - 0.06, z_top - 0.25), (high[0] + 0.06, high[1] + 0.06, z_top - 0.12),
        shade(color, 0.9))
    box(mesh, "stone", (low[0] + 0.02, low[1] + 0.02, z_top - 0.12), (high[0] - 0.02, high[1] - 0.02, z_top),
        shade(color, 0.6), skip="z")


def weathercock(mesh, x, y, z, which="vane"):
    """An iron finial with a ball, and what turns on it."""
    iron = (0.05, 0.045, 0.035)
    lathe(mesh, "iron", (x, y, z), [(0.05, 0.0), (0.03, 1.2), (0.0, 2.0)], 5, iron)
    lathe(mesh, "iron", (x, y, z + 0.7), [(0.0, 0.0), (0.2, 0.2), (0.0, 0.4)], 7, (0.5, 0.36, 0.1))
    mesh.turning.append((which, "wind", (x, y, z + 1.4), 0.0))


def make_vanes():
    """A vane with an arrow, and a cock; both look to -y, into the wind."""
    gold = (0.4, 0.3, 0.09)
    along = Frame((0, 0, 0), (0, 1, 0))
    vane, cock = Mesh(), Mesh()
    extrude(vane, "iron", along, [(-0.45, 0.14), (0.1, 0.14), (0.1, 0.18), (-0.45, 0.18)], -0.01, 0.01, gold, back=True)
    extrude(vane, "iron", along, [(-0.62, 0.16), (-0.42, 0.06), (-0.42, 0.26)], -0.01, 0.01, gold, back=True)
    extrude(vane, "iron", along, [(0.02, 0.0), (0.6, 0.1), (0.5, 0.2), (0.6, 0.32), (0.02, 0.22)], -0.01, 0.01, gold, back=True)
    body = [(-0.62, 0.72), (-0.5, 0.66), (-0.42, 0.4), (-0.2, 0.2), (0.12, 0.18), (0.36, 0.36), (0.62, 0.3), (0.78, 0.5),
            (0.74, 0.86), (0.52, 0.98), (0.42, 0.66), (0.12, 0.5), (-0.14, 0.62), (-0.24, 0.86), (-0.36, 1.0), (-0.48, 0.94), (-0.5, 0.78)]
    extrude(cock, "iron", along, body, -0.03, 0.03, gold, back=True)
    extrude(cock, "iron", along, [(-0.04, 0.0), (0.04, 0.0), (0.04, 0.24), (-0.04, 0.24)], -0.03, 0.03, gold, back=True)
    return {"vane": vane, "cock": cock}
