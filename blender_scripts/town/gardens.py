"""The ground between the backs of the houses and the town wall: orchards, kitchen gardens and bleaching greens to walk in.

What is drawn at random here has a sequence of its own, so that houses and streets stay the same.
"""

import math

import numpy as np

import plan
from layout import Field, grid_axes
from mesh import Mesh, box, shade, srgb
from openings import leaf_tuft
from town_wall import GATE_DEPTH, GATE_WIDTH, THICK, gate_axis, run_ends

ROOM_M = 0.65             # people walk wherever a circle of this radius fits
UNDER_WALLS_M = 0.45      # the ground goes on this far
STEP_M = 0.25
NEAR_M = 6.0              # so far around each house its distance is looked at first
TOWER_M = 2.75            # radius of the wall's towers
LEAST_M2 = 300.0          # smaller yards stay closed
OPENING_M, LEAST_OPENING_M = 2.6, 1.8      # in a garden wall
OPENING_EVERY_M = 36.0
APART_M = 25.0            # ways into a garden: farther than whoever stands in one can close another
GATEWAYS = 3              # houses with a way through them, at most so many a garden
GATEWAY_WIDTH_M = 3.0
LEAST_HOUSE_M = 6.9       # for a gateway
PATH_M = 1.0              # half the width
EARTH = srgb("a08c6c")
HEDGE = srgb("66803c")


class Gardens:
    """Where people may walk behind the houses, and how they get there."""

    def __init__(self, streets, public, plots, lines, rng):
        self.public, self.plots = public, plots
        walls = _between_walls(streets)
        behind = Field.of(public, STEP_M).values > 0.6
        self.yards = _yards(_room(walls, streets, plots), behind)[1]
        self.openings = {}                              # index of a garden wall -> lengths along it
        self.ways = []                                  # (x, y) just inside each
        self._open_walls(streets, lines)
        self._make_gateways(streets)
        room = _room(walls, streets, plots)
        labels, self.yards = _yards(room, behind)
        self.room = Field(_opened(room, labels > 0), STEP_M)
        lines = self._path_lines()
        self.path = Field.of(lambda p: np.min([plan.distance_to_line(p, line) for line in lines], axis=0) - PATH_M)
        self.rng = rng

    def _open_walls(self, streets, lines):
        for index, line in enumerate(lines):
            spots, s, width = _contacts(line, self.yards)
            blind = plan.distance_to_line(spots, streets[-1].axis) < streets[-1].width_m / 2 + 2.5
            stretch = s[width & ~blind]
            if len(stretch) == 0 or stretch[-1] - stretch[0] < LEAST_OPENING_M:
                continue
            count = round((stretch[-1] - stretch[0]) / OPENING_EVERY_M)
            inner = (stretch[0] + 4, stretch[-1] - 4)                       # so that little ground lies beyond the last ones
            for at in np.linspace(*inner, count + 1) if count > 0 else [(stretch[0] + stretch[-1]) / 2]:
                spot = spots[int(np.argmin(np.abs(s - at)))]
                if self._is_apart(spot):
                    self.openings.setdefault(index, []).append(float(at))
                    self.ways.append(tuple(spot))

    def _is_apart(self, spot):
        return self._to_next_way(spot) > APART_M

    def _to_next_way(self, spot):
        """Distance to the nearest other way into the same garden."""
        yard = self.yards(spot)
        return min((math.dist(spot, way) for way in self.ways if self.yards(way) == yard), default=1e9)

    def _make_gateways(self, streets):
        """The house that stands farthest from its garden's path, then those farthest from all ways in."""
        suited = {}
        for plot in self.plots:
            middle = plot.width / 2
            front, back = plot.at(middle, 0), plot.at(middle, plot.depth + 1.6)
            yards = {self.yards(plot.at(middle + du, plot.depth + 1.2)) for du in (-1.2, 0, 1.2)}
            on_square = plan.distance_to_box([front], *plan.SQUARE)[0] < 3.0
            blind = plan.distance_to_line([front], streets[-1].axis)[0] < 12.0
            if plot.kind == "house" and plot.width >= LEAST_HOUSE_M and len(yards) == 1 and 0 not in yards and not on_square and not blind:
                suited.setdefault(yards.pop(), []).append((plot, back))
        for houses in suited.values():
            paths = [plan.smooth_line(line) for line in plan.GARDEN_PATHS]
            trodden = min(paths, key=lambda path: plan.distance_to_line([houses[0][1]], path)[0])
            plot, back = max(houses, key=lambda h: float(plan.distance_to_line([h[1]], trodden).min()))
            for _ in range(GATEWAYS):
                if self._is_apart(back):
                    plot.gateway = True
                    self.ways.append(tuple(back))
                plot, back = max(houses, key=lambda h: self._to_next_way(h[1]))

    def _path_lines(self):
        """The middles of the trodden paths, and of the ways to them through walls and houses."""
        lines = [plan.smooth_line(line) for line in plan.GARDEN_PATHS]
        middles = np.concatenate(lines).tolist()
        lines += [[plot.at(plot.width / 2, -0.5), plot.at(plot.width / 2, plot.depth + 1.6)] for plot in self.plots if plot.gateway]
        return lines + [[way, min(middles, key=lambda p: math.dist(p, way))] for way in self.ways]


def _between_walls(streets):
    """Distance to the town wall at the cells of the grid, negative in it and outside."""
    ring = [tuple(p) for i in range(len(plan.WALL_RING)) for p in run_ends(i, streets)]
    ring = [p for i, p in enumerate(ring) if p != ring[i - 1]]
    return -Field.of(lambda p: plan.distance_to_polygon(p, ring), STEP_M).values - THICK / 2


def _room(walls, streets, plots):
    """The lesser of `walls` and the distance to the nearest house, gate or tower, negative in them."""
    xs, ys = grid_axes(STEP_M)
    room, solids = walls.copy(), _solids(streets, plots)
    for (x, y, half), distance in solids:
        i, j = (slice(*np.searchsorted(axis, (at - half - NEAR_M, at + half + NEAR_M))) for axis, at in ((xs, x), (ys, y)))
        room[j, i] = np.minimum(room[j, i], distance(xs[None, i], ys[j, None]))
    j, i = np.nonzero(room > NEAR_M)      # elsewhere what is farther away than NEAR_M changes nothing
    far, x, y = room[j, i], xs[i], ys[j]
    for _, distance in solids:
        far = np.minimum(far, distance(x, y))
    room[j, i] = far
    return room


def _solids(streets, plots):
    """Of each house, gate and tower: middle and half the edge of a square about it, and its distance from x and y."""
    solids = []
    for index, (cx, cy) in enumerate(plan.WALL_RING):
        if index in plan.WALL_GATES:
            spot = gate_axis(index, streets)[0]
            solids.append(((*spot, GATE_DEPTH + GATE_WIDTH), lambda x, y, index=index: _gate_distance(x, y, index, streets)))
        else:
            solids.append(((cx, cy, TOWER_M), lambda x, y, cx=cx, cy=cy: np.hypot(x - cx, y - cy) - TOWER_M))
    return solids + [((*plot.middle, plot.width + plot.depth), lambda x, y, plot=plot: _house_distance(x, y, plot)) for plot in plots]


def _house_distance(x, y, plot):
    house = _box_distance(x, y, plot.origin, plot.along, plot.width, 0, plot.depth)
    if plot.gateway:
        u = (x - plot.origin[0]) * plot.along[0] + (y - plot.origin[1]) * plot.along[1]
        house = np.maximum(house, GATEWAY_WIDTH_M / 2 - np.abs(u - plot.width / 2))
    return house


def _gate_distance(x, y, index, streets):
    spot, way = gate_axis(index, streets)
    return _box_distance(x, y, spot - way * GATE_DEPTH / 2, way, GATE_DEPTH, -GATE_WIDTH / 2, GATE_WIDTH / 2)


def in_gate(line, streets):
    """Whether a garden wall along this line would stand within a gate of the town wall."""
    x, y = np.array(line, float).T
    return any(_gate_distance(x, y, index, streets).max() < 0.5 for index in plan.WALL_GATES)


def _box_distance(x, y, origin, along, length, low, high):
    x, y = x - origin[0], y - origin[1]
    u, v = x * along[0] + y * along[1], y * along[0] - x * along[1]
    return plan.outside_corner(np.maximum(-u, u - length), np.maximum(low - v, v - high))


def _yards(room, behind):
    """By cell the number of the large yard where a circle of ROOM_M fits, 0: none; and the function from place to number."""
    xs, ys = grid_axes(STEP_M)
    yards = _label((room >= ROOM_M) & behind)

    def number(place):
        i, j = round((place[0] - xs[0]) / STEP_M), round((place[1] - ys[0]) / STEP_M)
        return int(yards[j, i]) if 0 <= i < len(xs) and 0 <= j < len(ys) else 0

    return yards, number


def _opened(room, kept):
    """How deep each cell lies in a circle of free ground about one of the cells `kept`; -1: not near one."""
    reach = math.ceil((ROOM_M + 1) / STEP_M)
    padded = np.pad(np.where(kept, room, -9.0), reach, constant_values=-9.0)
    ny, nx = room.shape
    best = np.full(room.shape, -1.0)
    band = 16                             # rows at once: they stay in the processor's cache
    for top in range(0, ny, band):
        mine = best[top:top + band]
        for j in range(2 * reach + 1):
            rows = padded[top + j:top + j + len(mine)]
            for i in range(2 * reach + 1):
                np.maximum(mine, rows[:, i:i + nx] - STEP_M * math.hypot(i - reach, j - reach), out=mine)
    return best


def _label(cells):
    """Numbers of the connected parts of at least LEAST_M2, from 1; 0 elsewhere."""
    edges = np.diff(np.pad(cells, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, first = np.nonzero(edges == 1)               # runs of cells along the rows
    last = np.nonzero(edges == -1)[1]
    size, leader = (last - first).tolist(), list(range(len(row)))

    def lead(run):
        while leader[run] != run:
            leader[run] = run = leader[leader[run]]
        return run

    start = np.searchsorted(row, np.arange(len(cells) + 1)).tolist()
    ends = list(zip(first.tolist(), last.tolist()))
    for j in range(1, len(cells)):
        a, b = start[j - 1], start[j]
        while a < start[j] and b < start[j + 1]:
            if ends[a][0] < ends[b][1] and ends[b][0] < ends[a][1]:
                one, other = sorted((lead(a), lead(b)))
                if one != other:
                    leader[other] = one               # the first run of a part leads it
                    size[one] += size[other]
            a, b = (a + 1, b) if ends[a][1] < ends[b][1] else (a, b + 1)
    leaders = [lead(run) for run in range(len(row))]
    large = [run for run in sorted(set(leaders)) if size[run] * STEP_M ** 2 >= LEAST_M2]
    number_of = {run: k + 1 for k, run in enumerate(large)}
    labels = np.zeros(cells.shape, int)
    for j, (i, k), leading in zip(row.tolist(), ends, leaders):
        labels[j, i:k] = number_of.get(leading, 0)
    return labels


def _contacts(line, yards):
    """Places a metre behind a garden wall, their lengths along it, and whether each lies in a yard."""
    cum = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    s = np.arange(0.05, cum[-1], 0.1)
    p = np.stack([np.interp(s, cum, line[:, 0]), np.interp(s, cum, line[:, 1])], axis=1)
    way = np.gradient(p, axis=0) if len(p) > 1 else np.ones((len(p), 2))
    way /= np.maximum(1e-9, np.linalg.norm(way, axis=1))[:, None]
    behind = p + 1.2 * np.stack([way[:, 1], -way[:, 0]], axis=1)
    return behind, s, np.array([yards(q) > 0 for q in behind], bool)


def cut(line, places):
    """The pieces of a wall's line between the openings, each at a length along it; and (x, y, yaw) of the openings' ends."""
    cum = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])

    def at(s):
        return np.array([np.interp(s, cum, line[:, 0]), np.interp(s, cum, line[:, 1])])

    ends, start, pieces = [], 0.0, []
    for place in sorted(places) + [None]:
        low, high = (cum[-1], cum[-1]) if place is None else (place - OPENING_M / 2, place + OPENING_M / 2)
        low, high = (0.0 if low < 0.8 else low), (cum[-1] if high > cum[-1] - 0.8 else high)
        if low - start > 0.3:
            inner = line[(cum > start + 0.02) & (cum < low - 0.02)]
            pieces.append(np.vstack([at(start), inner, at(low)]))
        if place is not None:
            for s in (low, high):
                if 0 < s < cum[-1]:
                    way = at(min(s + 0.1, cum[-1])) - at(max(s - 0.1, 0))
                    way /= np.linalg.norm(way)
                    ends.append((*(at(s) + 0.25 * np.array((way[1], -way[0]))).tolist(), plan.yaw_of(way)))
        start = high
    return pieces, ends


def places(gardens):
    """('tree', 'bed', 'linen', 'hedge', 'bench' or 'loiter', x, y, yaw), each clear of walls, paths, ways and all before it."""
    rng, taken = gardens.rng, []

    def put(kind, x, y, yaw, radius, off_path=0.4):
        p = np.array([(x, y)])
        if gardens.room(p)[0] < radius + 0.9 or gardens.public(p)[0] < radius + 1.5 or gardens.path(p)[0] < radius + off_path:
            return
        if any(math.dist((x, y), way) < radius + 3.0 for way in gardens.ways):
            return
        if all(math.dist((x, y), t[:2]) > radius + t[2] for t in taken):
            taken.append((x, y, radius))
            out.append((kind, x, y, yaw))

    out = []
    for line in plan.GARDEN_PATHS:
        spine = plan.smooth_line(line)
        for k in range(8, len(spine) - 6, 17):
            ahead = spine[k + 1] - spine[k - 1]
            side = np.array((-ahead[1], ahead[0])) / np.linalg.norm(ahead) * (1 if k % 2 else -1)
            x, y = spine[k] + side * (PATH_M + 0.9)
            put("bench" if k % 3 == 0 else "loiter", float(x), float(y), math.atan2(-side[1], -side[0]) + math.pi / 2, 0.8, -0.4)
    for kind, (x0, x1, y0, y1), yaw, (du, dv), radius in plan.GARDEN_BEDS:
        c, s = math.cos(yaw), math.sin(yaw)
        reach = math.hypot(x1 - x0, y1 - y0) / 2
        for u in np.arange(-reach, reach, du):
            for v in np.arange(-reach, reach, dv):
                x, y = (x0 + x1) / 2 + c * u - s * v, (y0 + y1) / 2 + s * u + c * v
                wobble = 0.5 if kind == "tree" else 0.0
                x, y = x + rng.uniform(-wobble, wobble), y + rng.uniform(-wobble, wobble)
                if x0 < x < x1 and y0 < y < y1:
                    put(kind, x, y, yaw, radius)
    return out


def make_hedge(length, rng):
    """A clipped hedge along x, 0.85 m high, its top a little uneven."""
    mesh = Mesh()
    count = max(2, round(length / 0.9))
    xs = [length * (i / count - 0.5) for i in range(count + 1)]
    tops = [0.85 + rng.uniform(-0.05, 0.05) for _ in xs]
    half = [0.3 + rng.uniform(-0.04, 0.04) for _ in xs]
    green = shade(HEDGE, rng.uniform(0.85, 1.05))
    for (a, za, ha), (b, zb, hb) in zip(zip(xs, tops, half), zip(xs[1:], tops[1:], half[1:])):
        mesh.face("leaves", [(a, -ha, -0.2), (b, -hb, -0.2), (b, -hb, zb), (a, -ha, za)], [(a, 0), (b, 0), (b, zb), (a, za)],
                  shade(green, 0.9))
        mesh.face("leaves", [(b, hb, -0.2), (a, ha, -0.2), (a, ha, za), (b, hb, zb)], [(b, 0), (a, 0), (a, za), (b, zb)],
                  shade(green, 0.9))
        mesh.face("leaves", [(a, -ha, za), (b, -hb, zb), (b, hb, zb), (a, ha, za)], [(a, 0), (b, 0), (b, 0.6), (a, 0.6)], green)
    for x, h, z, order in ((xs[0], half[0], tops[0], -1), (xs[-1], half[-1], tops[-1], 1)):
        mesh.face("leaves", [(x, -h, -0.2), (x, h, -0.2), (x, h, z), (x, -h, z)][::order],
                  [(0, 0), (0.6, 0), (0.6, z), (0, z)][::order], shade(green, 0.85))
    return mesh


def make_bed(length, rng):
    """A raised bed along x: boards, earth, a row of cabbages or herbs."""
    mesh, half = Mesh(), length / 2
    box(mesh, "planks", (-half, -0.6, -0.3), (half, 0.6, 0.24), srgb("6b5138"), skip="zZ")
    mesh.face("plaster", [(-half, -0.6, 0.2), (half, -0.6, 0.2), (half, 0.6, 0.2), (-half, 0.6, 0.2)],
              [(-half, 0), (half, 0), (half, 1.2), (-half, 1.2)], srgb("5a4632"))
    green = rng.choice((srgb("7f9a52"), srgb("92a85e"), srgb("5f7a3a")))
    for i in range(2 * int(length / 0.42)):
        place = (-half + 0.25 + 0.42 * (i // 2) + rng.uniform(-0.05, 0.05), 0.28 * (1 if i % 2 else -1) + rng.uniform(-0.06, 0.06), 0.2)
        leaf_tuft(mesh, place, 0.3, shade(green, rng.uniform(0.85, 1.1)), rng, 5)
    return mesh


def make_linen(length, rng):
    """Linen stretched over a low frame along x, to bleach in the sun."""
    mesh, half = Mesh(), length / 2
    white = shade((0.86, 0.85, 0.8), rng.uniform(0.92, 1.0))
    box(mesh, "cloth", (-half, -0.55, 0.27), (half, 0.55, 0.3), white, step=1.6)
    for x in (0.1 - half, 0, half - 0.1):
        for y in (-0.5, 0.5):
            box(mesh, "planks", (x - 0.04, y - 0.04, -0.2), (x + 0.04, y + 0.04, 0.34), srgb("6b5138"), skip="z")
    return mesh
