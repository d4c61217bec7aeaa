"""Puts houses along the streets and round the square, and closes what stays open with garden walls.

A plot is a rectangle: `origin` is the left end of its front seen from the street, `along` the unit vector to the
right, `back` the one away from the street.
"""

import math

import numpy as np

import plan

GAP_M = 0.35   # a house front may lie this far behind the line of the street
CORNER_M, CLEAR_OF_CORNER_M = 0.8, 0.27   # of a house between the ends of two garden walls: so wide at most, and passed in front so far
TILE = 48      # points a side


class Field:
    """A signed distance sampled on a grid over the whole town, read back between the samples."""

    def __init__(self, values, step):
        self.values, self.step = values, step
        self.xs, self.ys = grid_axes(step)

    @classmethod
    def of(cls, function, step=0.5):
        """function: from points to values; it is given a tile's at once, which have much the same near them."""
        points = np.stack(np.meshgrid(*grid_axes(step)), axis=-1)
        values = np.empty(points.shape[:2])
        for j in range(0, values.shape[0], TILE):
            for i in range(0, values.shape[1], TILE):
                tile = points[j:j + TILE, i:i + TILE]
                values[j:j + TILE, i:i + TILE] = function(tile.reshape(-1, 2)).reshape(tile.shape[:2])
        return cls(values, step)

    def __call__(self, points):
        p = np.asarray(points, float).reshape(-1, 2)
        ny, nx = self.values.shape
        gx = np.minimum(np.maximum((p[:, 0] - self.xs[0]) / self.step, 0), nx - 1.001)
        gy = np.minimum(np.maximum((p[:, 1] - self.ys[0]) / self.step, 0), ny - 1.001)
        i, j = gx.astype(int), gy.astype(int)
        fx, fy = gx - i, gy - j
        v = self.values
        return ((v[j, i] * (1 - fx) + v[j, i + 1] * fx) * (1 - fy)
                + (v[j + 1, i] * (1 - fx) + v[j + 1, i + 1] * fx) * fy)


class Plot:
    """Where a house stands, and which of its sides can be seen."""

    def __init__(self, origin, along, width, depth, kind="house"):
        self.origin = np.array(origin, float)
        self.along = np.array(along, float)
        self.back = np.array((-along[1], along[0]), float)
        self.width, self.depth, self.kind = width, depth, kind
        self.left_open = self.right_open = self.back_open = True    # no other house stands against it
        self.left_seen = self.right_seen = True                     # and it can be seen from a street
        self.middle = self.at(width / 2, depth / 2)
        self.x, self.y = self.middle.tolist()
        self._x, self._y, self._along = float(origin[0]), float(origin[1]), (float(along[0]), float(along[1]))
        self.gateway = False                                        # people walk through it into the garden behind

    @property
    def yaw(self):
        return plan.yaw_of(self.along)

    def corners(self, inset=0.0):
        o, a, b, w, d = self.origin, self.along, self.back, self.width, self.depth
        return np.array([o + a * inset + b * inset, o + a * (w - inset) + b * inset,
                         o + a * (w - inset) + b * (d - inset), o + a * inset + b * (d - inset)])

    def at(self, u, v):
        return self.origin + self.along * u + self.back * v

    def contains(self, points, grow=0.0):
        p = np.asarray(points, float).reshape(-1, 2) - self.origin
        u, v = p @ self.along, p @ self.back
        return (u > -grow) & (u < self.width + grow) & (v > -grow) & (v < self.depth + grow)

    def holds(self, place, grow=0.0):
        """The same for one place, much sooner."""
        x, y = float(place[0]) - self._x, float(place[1]) - self._y
        u, v = x * self._along[0] + y * self._along[1], y * self._along[0] - x * self._along[1]
        return -grow < u < self.width + grow and -grow < v < self.depth + grow


def _overlap(a, b):
    """How deep two plots lie in each other (separating axes), 0 if apart."""
    axes = np.array([a.along, a.back, b.along, b.back]).T
    on_a, on_b = a.corners() @ axes, b.corners() @ axes
    common = np.minimum(on_a.max(axis=0), on_b.max(axis=0)) - np.maximum(on_a.min(axis=0), on_b.min(axis=0))
    return max(0.0, common.min())


def offset_line(axis, distance):
    """The line at a signed distance to the left of an axis."""
    tangent = np.gradient(axis, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    return axis + distance * np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)


class _Line:
    """A line by its length."""

    def __init__(self, points):
        self.points = points
        self.s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])

    def at(self, s):
        return np.array([np.interp(s, self.s, self.points[:, 0]), np.interp(s, self.s, self.points[:, 1])])


def frontages(streets):
    """Lines that houses stand along, each with the houses to the left of its direction reversed: a house's front
    runs from left to right seen from the street, so the house lies to the left of the line."""
    x0, x1, y0, y1 = plan.SQUARE
    lines = [np.array([(x0, y1), (x1, y1)], float), np.array([(x1, y0), (x0, y0)], float),
             np.array([(x1, y1), (x1, y0)], float), np.array([(x0, y0), (x0, y1)], float)]
    for street in streets:
        half = street.width_m / 2
        lines.append(offset_line(street.axis, half))
        lines.append(offset_line(street.axis, -half)[::-1])
    end = streets[-1].axis
    tip, direction = end[-1], end[-1] - end[-2]
    direction /= np.linalg.norm(direction)
    side = np.array([direction[1], -direction[0]])
    lines.append(np.array([tip - side * 4.5, tip + side * 4.5]))
    lines.append(np.array([(19.5, 42.0), (29.0, 42.0)]))      # north side of the church plaza
    return lines


def _samples(plots):
    """Points all over each plot, shape (plots, points, 2)."""
    width, depth = np.array([p.width for p in plots]), np.array([p.depth for p in plots])
    u, v = np.linspace(0.05, width - 0.05, 6, axis=1)[:, None, :, None], np.linspace(GAP_M, depth, 7, axis=1)[:, :, None, None]
    origin, along, back = (np.array([getattr(p, key) for p in plots])[:, None, None] for key in ("origin", "along", "back"))
    return (origin + u * along + v * back).reshape(len(plots), -1, 2)


def _first_that_fits(wanted, plots, public, inside):
    """The first of the wanted plots that lies off the public space, inside the town and beside all other plots."""
    if not wanted:
        return None
    free = public(_samples(wanted)).reshape(len(wanted), -1).min(axis=1) >= 0.0
    for plot in (p for p, is_free in zip(wanted, free) if is_free):
        if np.any(inside(plot.corners()) > -2.2):
            continue
        near = [o for o in plots if abs(o.x - plot.x) < 16.0 and abs(o.y - plot.y) < 16.0]
        if all(_overlap(plot, other) < 0.3 for other in near):
            return plot
    return None


def _wanted(line, s, widths, depths, setback):
    """Plots of all these sizes whose fronts begin at `s`."""
    made = []
    for width in widths:
        if s + width > line.s[-1]:
            continue
        start, end = line.at(s), line.at(s + width)
        chord = end - start
        length = np.linalg.norm(chord)
        along = chord / length
        back = np.array((-along[1], along[0]))
        middle = line.at(s + width / 2)
        bulge = max(0.0, float((middle - start) @ back))
        made += [Plot(start + back * (bulge + 0.02 + setback), along, length, depth) for depth in depths]
    return made


def special_plots():
    """The house over the passage at the south side of the square, town hall and church."""
    hall, church = plan.TOWN_HALL, plan.CHURCH
    passage = Plot((14.2, plan.SQUARE[2] - 0.05), (-1.0, 0.0), 8.4, 9.4, "passage")
    back = hall["front"] + hall["arcade"]
    return [passage, Plot((hall["x0"], back), (1.0, 0.0), hall["x1"] - hall["x0"], hall["back"] - back, "town_hall"),
            Plot((church["west"], church["axis"] - 8), (1.0, 0.0), 40, 16, "church")]


def place_houses(streets, public, rng, width_m):
    """Plots in the order of their frontages; `width_m` is the mean width."""
    plots = special_plots()
    inside = Field.of(lambda p: plan.distance_to_polygon(p, plan.BUILT_RING), 1.0)
    for points in frontages(streets):
        line = _Line(points)
        s = 0.0
        while s < line.s[-1] - 4.8:
            wish = min(9.0, max(5.2, rng.gauss(width_m, 0.95)))
            depth, setback = rng.uniform(8.4, 10.2), 0.14 * rng.random()
            start, ahead = line.at(s + 0.3), line.at(s + 0.4) - line.at(s + 0.3)
            behind = start + 1.5 * np.array((-ahead[1], ahead[0])) / max(1e-9, np.linalg.norm(ahead))
            if public([behind])[0] < 0.2 or any(o.holds(behind, -0.35) for o in plots):
                s += 0.3
                continue
            widths = [max(5.0, width) for width in (wish, 0.85 * wish, 5.6, 5.0)]
            depths = [max(6.2, depth - cut) for cut in (0.0, 1.6, 3.0)]
            plot = _first_that_fits(_wanted(line, s, widths, depths, setback), plots, public, inside)
            if plot is None:
                s += 0.3
                continue
            plots.append(plot)
            s += plot.width
    for plot in plots:
        _find_open_sides(plot, plots, public)
    return plots


def _find_open_sides(plot, plots, public):
    def free(points):
        return any(not any(o is not plot and o.holds(p, 0.25) for o in plots) for p in points)

    w, d = plot.width, plot.depth
    plot.left_open = free([plot.at(-0.5, d * 0.3), plot.at(-0.5, d * 0.7)])
    plot.right_open = free([plot.at(w + 0.5, d * 0.3), plot.at(w + 0.5, d * 0.7)])
    plot.left_seen = plot.left_open and min(public([plot.at(-1.2, d * 0.2), plot.at(-1.2, d * 0.5)])) < 1.6
    plot.right_seen = plot.right_open and min(public([plot.at(w + 1.2, d * 0.2), plot.at(w + 1.2, d * 0.5)])) < 1.6
    plot.back_open = free([plot.at(w * 0.3, d + 0.5), plot.at(w * 0.7, d + 0.5)])


def contour(field, xs, ys, level=0.0):
    """Lines where a field on a grid crosses a level, the lower side to their left; closed lines repeat a point."""
    f = field - level
    f = np.where(np.abs(f) < 1e-6, 1e-6, f)
    links = {}
    ny, nx = f.shape

    def cross(j, i, k, m):
        t = f[j, i] / (f[j, i] - f[k, m])
        return (xs[i] + (xs[m] - xs[i]) * t, ys[j] + (ys[k] - ys[j]) * t)

    inside = f < 0
    mixed = inside[:-1, :-1].astype(int) + inside[1:, :-1] + inside[:-1, 1:] + inside[1:, 1:]
    for j, i in zip(*np.nonzero((mixed > 0) & (mixed < 4))):
        ring = [(j, i), (j, i + 1), (j + 1, i + 1), (j + 1, i)]
        enter, leave = [], []
        for a, b in zip(ring, ring[1:] + ring[:1]):
            if inside[a] != inside[b]:
                key = (a, b) if a < b else (b, a)
                (leave if inside[a] else enter).append(key)
        # Walking round the cell anticlockwise, the inside is left at `leave`: the line runs leave -> enter.
        for a, b in zip(leave, enter if len(enter) == 1 else enter[::-1]):
            links[a] = b
    lines = []
    ends = set(links.values())
    starts = [k for k in links if k not in ends] + list(links)
    used = set()
    for start in starts:
        if start in used:
            continue
        chain, key = [start], start
        while key in links and key not in used:
            used.add(key)
            key = links[key]
            chain.append(key)
        lines.append(np.array([cross(*a, *b) for a, b in chain]))
    return lines


def simplify(line, tolerance):
    """Douglas-Peucker."""
    if len(line) < 3:
        return line
    keep = np.zeros(len(line), bool)
    keep[0] = keep[-1] = True
    closed = np.allclose(line[0], line[-1])
    if closed:
        keep[len(line) // 2] = True
    stack = [(0, len(line) // 2), (len(line) // 2, len(line) - 1)] if closed else [(0, len(line) - 1)]
    while stack:
        a, b = stack.pop()
        if b - a < 2:
            continue
        chord = line[b] - line[a]
        length = max(1e-9, np.linalg.norm(chord))
        away = line[a + 1:b] - line[a]
        d = np.abs(away[:, 0] * chord[1] - away[:, 1] * chord[0]) / length
        k = int(np.argmax(d))
        if d[k] > tolerance:
            keep[a + 1 + k] = True
            stack += [(a, a + 1 + k), (a + 1 + k, b)]
    return line[keep]


def grid_axes(step):
    return np.arange(-96.0, 96.0 + step / 2, step), np.arange(-92.0, 92.0 + step / 2, step)


def garden_walls(public, plots):
    """Lines along the edge of the public space where no house closes it, lengthened a little into the houses."""
    ring = np.array(plan.BUILT_RING)
    hall = plan.TOWN_HALL
    runs = []
    for line in contour(public.values, public.xs, public.ys, 0.12):
        cum = _Line(line)
        count = max(2, int(cum.s[-1] / 0.2))
        p = np.array([cum.at(s) for s in np.linspace(0, cum.s[-1], count)])
        tangent = np.gradient(p, axis=0)
        tangent /= np.maximum(1e-9, np.linalg.norm(tangent, axis=1))[:, None]
        outside = p + 0.25 * np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)   # the public space is to the left
        covered = np.zeros(count, bool)
        for plot in plots:
            covered |= plot.contains(outside, 0.02)
        covered |= plan.distance_to_box(p, hall["x0"] - 0.05, hall["x1"] + 0.05, hall["front"], hall["back"]) < 0.1
        covered |= plan.distance_to_polygon(p, ring) > -0.3
        start = None
        for i in range(count + 1):
            bare = i < count and not covered[i]
            if bare and start is None:
                start = i
            if not bare and start is not None:
                if i - start >= 1:
                    a, b = max(0, start - 2), min(count, i + 2)
                    runs.append(simplify(p[a:b], 0.05))
                start = None
    return [run for run in runs if len(run) > 1]


def before_corners(lines):
    """The lines of garden walls; where two end at the same corner of a house they meet before it, and it stays behind them."""
    moved = [line.copy() for line in lines]
    for i, line in enumerate(lines):
        for j, other in enumerate(lines):
            if i == j or not 0.05 < math.dist(line[-1], other[0]) < CORNER_M:
                continue
            way = (other[1] - line[-2]) / np.linalg.norm(other[1] - line[-2])
            spot = (line[-1] + other[0]) / 2 + CLEAR_OF_CORNER_M * np.array((-way[1], way[0]))
            moved[i][-1], moved[j][0] = spot + 0.1 * way, spot - 0.1 * way
    return moved


def make_layout(rng, width_m):
    """Streets, the signed distance to the edge of the public space, plots and garden walls."""
    streets = plan.make_streets(rng)
    public = Field.of(lambda p: plan.walkable_distance(p, streets))
    plots = place_houses(streets, public, rng, width_m)
    return streets, public, plots, garden_walls(public, plots)


def nearest_plot(plots, x, y):
    return min(plots, key=lambda p: math.hypot(*(p.at(p.width / 2, p.depth / 2) - (x, y))))
