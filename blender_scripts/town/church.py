"""The church: west tower with spire, nave with cross gables, choir; in the town's coordinates."""

import math

import plan
from masonry import LIMESTONE, SANDSTONE, SLATE, buttress, pointed_window, portal, pyramid, string_course
from mesh import Frame, Mesh, box, extrude, front_frame, lathe, panel, polygon, shade, srgb
from roof import gable_roof, weathercock

TOWER, NAVE, CHOIR = 8.4, 23.0, 8.0     # lengths along the axis
HALF_NAVE, HALF_CHOIR = 7.4, 4.6
EAVES, CHOIR_EAVES, TOWER_TOP = 9.2, 8.4, 25.0


def make_church(rng):
    """Mesh, and its doors as (x, y, nx, ny)."""
    mesh = Mesh()
    x, axis = plan.CHURCH["west"], plan.CHURCH["axis"]
    tower(mesh, x, axis, rng)
    nave(mesh, x + TOWER, axis, rng)
    choir(mesh, x + TOWER + NAVE, axis, rng)
    z = float(plan.pavement_height(x, axis))
    return mesh.moved(0, 0, z), [(x - 0.65, axis, -1.0, 0.0), (x + TOWER + 3.8, axis - HALF_NAVE - 0.4, 0.0, -1.0)]


def tower(mesh, x, axis, rng):
    half = TOWER / 2
    x0, x1, y0, y1 = x, x + TOWER, axis - half, axis + half
    walls = [Frame((x0, y1, 0), (0, -1, 0)), Frame((x0, y0, 0), (1, 0, 0)), Frame((x1, y0, 0), (0, 1, 0)),
             Frame((x1, y1, 0), (-1, 0, 0))]
    for i, wall in enumerate(walls):
        panel(mesh, "stone", wall, 0, TOWER, -1.0, TOWER_TOP, SANDSTONE, step=2.0, uv_shift=(i * 1.3, 0))
        for u in (2.5, TOWER - 2.5):
            pointed_window(mesh, wall, u, 18.2, 1.5, 4.6, LIMESTONE, rng)
        if i != 2:
            buttress(mesh, wall, 0.65, (5.0, 12.0), (1.0, 0.6), 1.1, SANDSTONE)
            buttress(mesh, wall, TOWER - 0.65, (5.0, 12.0), (1.0, 0.6), 1.1, SANDSTONE)
            clock(mesh, wall, TOWER / 2, 15.0)
    west = walls[0]
    portal(mesh, west, half, 1.9, 3.5, LIMESTONE, rng, srgb("5b3a26"))
    pointed_window(mesh, west, half, 6.4, 2.4, 5.4, LIMESTONE, rng, 2)
    for wall in (walls[1], walls[3]):
        pointed_window(mesh, wall, half, 6.4, 1.2, 3.6, LIMESTONE, rng)
    for z in (5.6, 13.0, 17.2, TOWER_TOP - 0.2):
        string_course(mesh, x0, x1, y0, y1, z, LIMESTONE)
    spire(mesh, (x0 + x1) / 2, axis, half, rng)


def clock(mesh, wall, u, v):
    rim = [(u + math.cos(k * math.pi / 8) * 1.05, v + math.sin(k * math.pi / 8) * 1.05) for k in range(16)]
    extrude(mesh, "iron", wall, rim, 0.0, 0.06, (0.02, 0.035, 0.07))
    gold = (0.62, 0.43, 0.1)
    for k in range(12):
        c, s = math.cos(k * math.pi / 6), math.sin(k * math.pi / 6)
        w = 0.05
        polygon(mesh, "iron", wall, [(u + c * 0.78 + s * w, v + s * 0.78 - c * w), (u + c * 0.97 + s * w, v + s * 0.97 - c * w),
                                     (u + c * 0.97 - s * w, v + s * 0.97 + c * w), (u + c * 0.78 - s * w, v + s * 0.78 + c * w)],
                gold, 0.075)
    yaw = math.atan2(wall.n[0], -wall.n[1])
    mesh.turning.append(("minute_hand", "minute_hand", wall.at(u, v, 0.09), yaw))
    mesh.turning.append(("hour_hand", "hour_hand", wall.at(u, v, 0.08), yaw))


def make_hands():
    """Both hands of a clock at twelve, about the middle of its face, which looks to -y."""
    gold, wall = (0.62, 0.43, 0.1), front_frame()
    hour, minute = Mesh(), Mesh()
    polygon(hour, "iron", wall, [(-0.06, -0.1), (0.06, -0.1), (0.05, 0.36), (0.1, 0.38), (0.0, 0.56), (-0.1, 0.38), (-0.05, 0.36)],
            gold)
    polygon(minute, "iron", wall, [(-0.05, -0.16), (0.05, -0.16), (0.02, 0.8), (-0.02, 0.8)], gold)
    return {"hour_hand": hour, "minute_hand": minute}


def spire(mesh, cx, cy, half, rng):
    """Four stone gables, an octagonal slate spire behind them, pinnacles at the corners."""
    z = TOWER_TOP
    rise = half * 1.35
    sides = [((-1, 1), (0, -1)), ((-1, -1), (1, 0)), ((1, -1), (0, 1)), ((1, 1), (-1, 0))]
    for (sx, sy), (ux, uy) in sides:
        wall = Frame((cx + sx * half, cy + sy * half, z), (ux, uy, 0))
        polygon(mesh, "stone", wall, [(0, 0), (2 * half, 0), (half, rise)], SANDSTONE)
        pointed_window(mesh, wall, half, 0.7, 1.0, 2.3, LIMESTONE, rng, 0)
        peak = wall.at(half, rise + 0.15, 0.2)
        for a, b in ((wall.at(-0.3, -0.3, 0.2), peak), (peak, wall.at(2 * half + 0.3, -0.3, 0.2))):
            center = (cx, cy, z + rise + 0.15)
            mesh.face("stone", [a, b, center], [(0, 0), (3, 0), (3, 3)], SLATE)
    octagon = [(cx + math.cos((k + 0.5) * math.pi / 4) * half * 0.98, cy + math.sin((k + 0.5) * math.pi / 4) * half * 0.98,
                z + 0.6) for k in range(8)]
    top = z + 23.5
    pyramid(mesh, "stone", octagon, (cx, cy, top), SLATE, 8)
    for sx in (-1, 1):
        for sy in (-1, 1):
            px, py = cx + sx * (half - 0.35), cy + sy * (half - 0.35)
            box(mesh, "stone", (px - 0.45, py - 0.45, z), (px + 0.45, py + 0.45, z + 2.2), LIMESTONE, skip="zZ")
            ring = [(px - 0.55, py - 0.55, z + 2.2), (px + 0.55, py - 0.55, z + 2.2), (px + 0.55, py + 0.55, z + 2.2),
                    (px - 0.55, py + 0.55, z + 2.2)]
            pyramid(mesh, "stone", ring, (px, py, z + 4.6), LIMESTONE, 1)
    weathercock(mesh, cx, cy, top - 0.4, "cock")


def nave(mesh, x, axis, rng):
    """Three bays; every bay has a window and a cross gable on both sides."""
    y0, y1 = axis - HALF_NAVE, axis + HALF_NAVE
    bays, bay = 3, NAVE / 3
    slope = math.tan(math.radians(54))
    tint = (0.86, 0.82, 0.8)
    for south in (True, False):
        wall = Frame((x, y0, 0), (1, 0, 0)) if south else Frame((x + NAVE, y1, 0), (-1, 0, 0))
        panel(mesh, "stone", wall, 0, NAVE, -1.0, EAVES, SANDSTONE, step=2.0)
        for i in range(bays):
            middle = bay * (i + 0.5)
            door_bay = south and i == 0
            pointed_window(mesh, wall, middle, 4.6 if door_bay else 2.4, 2.3, 4.6 if door_bay else 6.2, LIMESTONE, rng, 2)
            if door_bay:
                portal(mesh, wall, middle, 1.4, 2.6, LIMESTONE, rng, srgb("4d3324"))
            cross_gable(mesh, wall, middle, bay, slope, tint, axis, south, rng)
        for i in range(bays + 1):
            u = min(max(bay * i, 0.6), NAVE - 0.6)
            buttress(mesh, wall, u, (4.2, 7.6), (1.3, 0.75), 0.9, SANDSTONE)
        box_course(mesh, wall, NAVE, EAVES - 0.3)
    gable_roof(mesh, lambda l, s, h: (x + l, y0 + s, h), NAVE, 2 * HALF_NAVE, EAVES, slope, 0.4, (0.0, 0.2), tint,
               srgb("4a3a2c"), rng, sag=0.02)
    rise = HALF_NAVE * slope
    for wall in (Frame((x + NAVE, y0, EAVES), (0, 1, 0)), Frame((x, y1, EAVES), (0, -1, 0))):
        polygon(mesh, "stone", wall, [(0, -EAVES - 1), (2 * HALF_NAVE, -EAVES - 1), (2 * HALF_NAVE, 0), (HALF_NAVE, rise),
                                      (0, 0)], SANDSTONE)


def box_course(mesh, wall, length, v):
    extrude(mesh, "stone", wall, [(0, v), (length, v), (length, v + 0.3), (0, v + 0.3)], 0.0, 0.22, LIMESTONE)


def cross_gable(mesh, wall, u, bay, slope, tint, axis, south, rng):
    width = bay - 1.0
    rise = width / 2 * slope
    corners = [(u - width / 2, EAVES - 0.1), (u + width / 2, EAVES - 0.1), (u, EAVES + rise)]
    polygon(mesh, "stone", wall, corners, SANDSTONE, 0.02)
    pointed_window(mesh, wall, u, EAVES + 0.8, 1.0, 2.2, LIMESTONE, rng, 0)

    def place(l, s, h):
        p = wall.at(u + width / 2 - s, 0, -l)
        return (p[0], p[1], h)

    gable_roof(mesh, place, HALF_NAVE - 0.3, width, EAVES, slope, 0.25, (0.25, 0.0), tint, srgb("4a3a2c"), rng, sag=0.0)


def choir(mesh, x, axis, rng):
    """A straight bay and a three-sided end under one hipped roof."""
    h, c = HALF_CHOIR, CHOIR
    plan_points = [(x, axis - h), (x + c * 0.55, axis - h), (x + c, axis - h * 0.42), (x + c, axis + h * 0.42),
                   (x + c * 0.55, axis + h), (x, axis + h)]
    for a, b in zip(plan_points, plan_points[1:]):
        length = math.dist(a, b)
        wall = Frame((a[0], a[1], 0), ((b[0] - a[0]) / length, (b[1] - a[1]) / length, 0))
        panel(mesh, "stone", wall, 0, length, -1.0, CHOIR_EAVES, SANDSTONE, step=2.0)
        pointed_window(mesh, wall, length / 2, 2.6, 1.6, 5.0, LIMESTONE, rng)
        buttress(mesh, wall, length - 0.4, (4.0, 6.8), (1.1, 0.6), 0.8, SANDSTONE)
    ridge = [(x - 1.0, axis, CHOIR_EAVES + h * 1.35), (x + c * 0.5, axis, CHOIR_EAVES + h * 1.35)]
    eave = [(x, axis - h - 0.4), (x + c * 0.55 + 0.15, axis - h - 0.4), (x + c + 0.4, axis - h * 0.42 - 0.15),
            (x + c + 0.4, axis + h * 0.42 + 0.15), (x + c * 0.55 + 0.15, axis + h + 0.4), (x, axis + h + 0.4)]
    ring = [(p[0], p[1], CHOIR_EAVES - 0.1) for p in eave]
    tint = (0.86, 0.82, 0.8)
    for i, (a, b) in enumerate(zip(ring, ring[1:])):
        width = math.dist(a, b)
        top = {0: [ridge[1], ridge[0]], 4: [ridge[0], ridge[1]]}.get(i, [ridge[1]])
        points = [a, b] + top
        uvs = [(0, 0), (width, 0)] + ([(width, 7), (0, 7)] if len(top) == 2 else [(width / 2, 7)])
        mesh.face("roof_tile", points, uvs, tint)
        below = [(a[0], a[1], a[2] - 0.14), (b[0], b[1], b[2] - 0.14), b, a]
        mesh.face("roof_tile", below, [(0, 0), (width, 0), (width, 0.1), (0, 0.1)], shade(tint, 0.8))
    under = [(p[0], p[1], p[2] - 0.14) for p in ring][::-1]
    mesh.face("planks", under, [(p[0], p[1]) for p in under], srgb("6a5a48"))
    lathe(mesh, "iron", (ridge[1][0], axis, ridge[1][2]), [(0.06, -0.2), (0.03, 1.4), (0.0, 1.6)], 5, (0.05, 0.045, 0.04))
