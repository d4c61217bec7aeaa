"""The town's plan as data: streets, square, church, gates and town wall. Metres; x east, y north, z up.

Nothing here depends on Blender. `layout.py` puts the houses on the plan.
"""

import math

import numpy as np

KERB_M = 0.10           # the pavement lies this much above the carriageway
SLOPE = 0.05            # of the southern streets
SLOPE_START_Y = -19.0   # north of this line the town is level
SLOPE_END_Y = -76.0

SQUARE = (-20.0, 20.0, -15.0, 15.0)          # x0, x1, y0, y1, from house front to house front
SQUARE_MARGIN = 1.7                          # pavement along its houses
TOWN_HALL = {"x0": -10.5, "x1": 7.5, "front": 14.2, "back": 27.0, "arcade": 3.7}
CHURCH = {"west": 32.0, "axis": 31.5}        # west front of the tower, axis of the nave
CHURCHYARD = [(28.5, 12.5), (75.0, 9.5), (75.5, 49.5), (28.5, 49.5)]
CHURCH_PLAZA = [(20.0, 21.0), (31.5, 21.0), (31.5, 42.0), (19.0, 42.0)]
CHURCH_PATHS = [[(30.0, 31.5), (33.0, 31.5)], [(30.0, 21.8), (64.0, 18.6), (71.0, 24.0), (71.5, 39.0), (62.0, 44.5),
                (30.0, 41.2)]]

# The ring of the town wall; the gates stand where the streets cross it.
WALL_RING = [(79.0, -9.6), (85.0, 20.0), (85.0, 53.0), (62.0, 69.0), (26.0, 75.0), (-13.0, 70.0), (-47.0, 71.0),
             (-73.0, 50.0), (-84.0, 24.0), (-79.0, -2.2), (-84.0, -30.0), (-67.0, -56.0), (-39.0, -73.0),
             (-9.0, -73.0), (28.0, -77.0), (60.0, -66.0), (79.0, -42.0)]
# Houses stand within this ring; between it and the wall lie gardens only.
BUILT_RING = [(79.0, -9.6), (80.0, 22.0), (78.5, 52.5), (56.0, 61.0), (24.0, 67.0), (-13.0, 70.0), (-42.0, 62.0),
              (-66.0, 42.0), (-77.0, 20.0), (-79.0, -2.2), (-76.0, -26.0), (-58.0, -48.0), (-33.0, -63.0),
              (-9.0, -73.0), (24.0, -68.5), (52.0, -57.0), (71.0, -37.0)]
# The middle of a trodden path through each garden: north-west, south-west, south-east, north-east.
GARDEN_PATHS = [[(-72, 12), (-66, 32), (-48, 47), (-33, 54), (-24, 62)],
                [(-74, -14), (-66, -34), (-50, -48), (-34, -56), (-18, -64)],
                [(-1, -66), (20, -64), (44, -57), (63, -42), (72, -21)],
                [(79, 2), (79.5, 30), (77, 52), (56, 59), (28, 61), (0, 63)]]
# What grows or lies in rows in the gardens: kind, box x0 x1 y0 y1, yaw of the rows, distance along and across, radius.
GARDEN_BEDS = [("hedge", (-74, -30, 12, 56), 0.75, (8.0, 9.0), 2.4), ("tree", (-76, -20, 6, 66), 0.75, (6.5, 7.0), 1.6),
               ("bed", (-58, -26, -44, -18), 0.0, (6.6, 3.4), 1.8), ("hedge", (-70, -20, -62, -14), -0.7, (8.0, 9.0), 2.4),
               ("tree", (-76, -14, -66, -14), -0.7, (12.0, 12.0), 1.6), ("linen", (4, 74, -74, -30), 0.3, (8.4, 3.2), 1.5),
               ("tree", (0, 76, -72, -16), 0.5, (13.0, 11.0), 1.6), ("tree", (-4, 82, 50, 70), -0.1, (7.0, 6.5), 1.6),
               ("tree", (70, 84, 4, 50), 0.1, (7.0, 9.0), 1.6)]
WALL_GATES = {0: "east", 5: "north", 9: "west", 13: "south"}   # index in WALL_RING


class Street:
    """A way with its axis as a smooth line; `carriage_m` 0: all pavement."""

    def __init__(self, name, points, width_m, carriage_m):
        self.name, self.width_m, self.carriage_m = name, width_m, carriage_m
        self.axis = smooth_line(points)


def smooth_line(points, step=1.0):
    """A Catmull-Rom line through the points, about `step` metres between its own."""
    p = np.array(points, float)
    p = np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    out = []
    for i in range(1, len(p) - 2):
        count = max(1, int(round(np.linalg.norm(p[i + 1] - p[i]) / step)))
        for t in np.arange(count) / count:
            a, b, c, d = p[i - 1], p[i], p[i + 1], p[i + 2]
            out.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t ** 2
                              + (3 * b - a - 3 * c + d) * t ** 3))
    out.append(p[-2])
    return np.array(out)


CHURCH_WAYS = [smooth_line(path) for path in CHURCH_PATHS]


def make_streets(rng):
    """All streets. The seed moves the bends a little; junctions and gates stay."""
    def bend(x, y, most=1.2):
        return (x + rng.uniform(-most, most), y + rng.uniform(-most, most))

    return [
        Street("west", [(-14, -1), (-22, -1.5), bend(-38, -6), bend(-58, -6.5), (-79, -2.2), (-93, 1)], 8.2, 4.6),
        Street("east", [(14, -4), (22, -4.5), bend(38, -9), bend(58, -6), (79, -9.6), (93, -13)], 8.2, 4.6),
        Street("south", [(-7, -8), (-8, -17), bend(-12.5, -32), bend(-6, -51), (-9, -73), (-11, -87)], 8.0, 4.6),
        Street("north", [(-15, 10), (-15.5, 17), bend(-18.5, 32), bend(-11, 50), (-13, 70), (-14, 84)], 7.6, 4.2),
        Street("church", [(15.5, 10), (16, 16), (18.5, 27), bend(15, 40, 0.6), (6, 46.5), (-12, 47)], 7.2, 3.8),
        Street("loop", [(-8.5, -44), bend(8, -45), bend(29, -43.5), (46, -35), bend(53.5, -22), (55, -6)], 7.4, 4.0),
        Street("passage", [(10, -12), (10, -30), (9.5, -44)], 3.3, 0.0),
        Street("dead_end", [(-50, -5), (-50.5, 8), (-49, 23.5)], 3.8, 0.0),
    ]


def ground_height(x, y):
    """Height of the carriageway. Works on numbers and arrays."""
    below = np.clip((SLOPE_START_Y - np.asarray(y, float)), 0.0, SLOPE_START_Y - SLOPE_END_Y)
    ease = 6.0
    run = np.where(below < ease, below * below / (2 * ease), below - ease / 2)
    return -SLOPE * run + 0.0 * np.asarray(x, float)


def _by_parts(of_part, points, edges):
    """of_part(x, y), x and y being rows, for as many points at once as stay in the processor's cache with all edges."""
    p = np.asarray(points, float).reshape(-1, 2)
    count = max(1, 32768 // edges)
    parts = [of_part(p[k:k + count, 0][None], p[k:k + count, 1][None]) for k in range(0, max(1, len(p)), count)]
    return np.concatenate(parts)


def distance_to_line(points, line):
    """Distance of each point to a line of points."""
    ends = np.array(line, float)
    ax, ay = ends[:-1, :1], ends[:-1, 1:]
    ux, uy = ends[1:, :1] - ax, ends[1:, 1:] - ay
    squares = np.maximum(1e-12, ux * ux + uy * uy)

    def to_edges(x, y, edges):
        dx, dy = x - ax[edges], y - ay[edges]
        t = np.minimum(np.maximum((dx * ux[edges] + dy * uy[edges]) / squares[edges], 0), 1)
        dx -= t * ux[edges]
        dy -= t * uy[edges]
        return dx * dx + dy * dy

    def of_part(x, y):
        edges = slice(None)
        if x.shape[1] > 1 and len(ax) > 8:      # edges that can be the nearest of one of these points
            low, high = np.array((x.min(), y.min())), np.array((x.max(), y.max()))
            from_middle = np.sqrt(to_edges(*(low + high) / 2, slice(None))[:, 0])
            edges = from_middle <= from_middle.min() + math.dist(low, high) + 1e-6
        return np.sqrt(to_edges(x, y, edges).min(axis=0))

    return _by_parts(of_part, points, len(ax))


def distance_to_polygon(points, polygon):
    """Signed distance, negative inside."""
    ring = np.array(list(polygon) + [polygon[0]], float)
    ax, ay, bx, by = ring[:-1, :1], ring[:-1, 1:], ring[1:, :1], ring[1:, 1:]

    def inside(x, y):
        crosses = (ay > y) != (by > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            crosses &= x < (bx - ax) * (y - ay) / (by - ay) + ax
        return np.logical_xor.reduce(crosses, axis=0)

    away = distance_to_line(points, ring)
    return np.where(_by_parts(inside, points, len(ax)), -away, away)


def distance_to_box(points, x0, x1, y0, y1):
    p = np.asarray(points, float).reshape(-1, 2)
    dx = np.maximum(x0 - p[:, 0], p[:, 0] - x1)
    dy = np.maximum(y0 - p[:, 1], p[:, 1] - y1)
    return outside_corner(dx, dy)


def outside_corner(dx, dy):
    """Signed distance to a corner, from how far points lie beyond its two sides."""
    d = np.maximum(dx, dy)
    beyond = np.minimum(dx, dy) > 0
    d[beyond] = np.hypot(dx[beyond], dy[beyond])
    return d


def smooth_min(a, b, radius):
    """The lesser of two distances, with the corner between them rounded."""
    h = np.minimum(np.maximum(0.5 + 0.5 * (b - a) / radius, 0), 1)   # np.clip takes longer over few
    return b + (a - b) * h - radius * h * (1 - h)


def arcade_box():
    """The floor of the arcade, with the ways that lead into it from the streets on both sides."""
    hall = TOWN_HALL
    return hall["x0"] - 3.0, hall["x1"] + 6.0, hall["front"] - 1.0, hall["front"] + hall["arcade"]


def walkable_distance(points, streets, corners=True):
    """Signed distance to the edge of the public space, negative inside."""
    d = distance_to_box(points, *SQUARE)
    for street in streets:
        d = np.minimum(d, distance_to_line(points, street.axis) - street.width_m / 2)
    d = np.minimum(d, distance_to_polygon(points, CHURCHYARD))
    d = np.minimum(d, distance_to_polygon(points, CHURCH_PLAZA))
    hall = distance_to_box(points, TOWN_HALL["x0"], TOWN_HALL["x1"], TOWN_HALL["front"], TOWN_HALL["back"])
    d = np.maximum(d, -hall)
    return np.minimum(d, distance_to_box(points, *arcade_box()))


def square_distance(points):
    x0, x1, y0, y1 = SQUARE
    m = SQUARE_MARGIN
    return distance_to_box(points, x0 + m + 1.5, x1 - m - 1.5, y0 + m + 1.5, y1 - m - 1.5) - 1.5


def carriage_distance(points, streets):
    """Signed distance to the kerb, negative on the carriageway and the square."""
    d = square_distance(points)
    for street in streets:
        if street.carriage_m > 0:
            d = smooth_min(d, distance_to_line(points, street.axis) - street.carriage_m / 2, 1.6)
    return d


def grass_distance(points):
    """Signed distance to the edge of the lawns, negative on them."""
    d = distance_to_polygon(points, CHURCHYARD)
    d = np.maximum(d, -distance_to_polygon(points, CHURCH_PLAZA))
    for way in CHURCH_WAYS:
        d = np.maximum(d, 1.1 - distance_to_line(points, way))
    return d


def pavement_height(x, y):
    return ground_height(x, y) + KERB_M


def yaw_of(direction):
    return math.atan2(direction[1], direction[0])
