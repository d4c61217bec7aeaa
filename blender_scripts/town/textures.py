"""Tiling albedo textures, made with numpy from a seed.

Every texture is bright and nearly neutral where the vertex colour is to tint it (plaster, timber, planks, cloth,
roof tiles, leaves), and fully coloured elsewhere. Rows run upwards, as in Blender's images.

All is reckoned in single precision, and what needs many arrays a pixel in bands of rows: more would not fit into the
processor's cache.
"""

import numpy as np

BAND = 32      # rows


def _rng(seed, name):
    return np.random.RandomState((seed * 7919 + sum(ord(c) * 31 ** i for i, c in enumerate(name))) % (2 ** 31))


def _noise(rng, size, cells):
    """Smooth tiling noise from 0 to 1 with `cells` bumps a side (a number or (across, up))."""
    cx, cy = (cells, cells) if isinstance(cells, int) else cells
    grid = rng.rand(cy, cx)
    y = np.arange(size) / size * cy
    x = np.arange(size) / size * cx
    y0, x0 = y.astype(int), x.astype(int)
    fy, fx = y - y0, x - x0
    fy, fx = fy * fy * (3 - 2 * fy), (fx * fx * (3 - 2 * fx)).astype(np.float32)
    rows0, rows1 = grid[y0 % cy], grid[(y0 + 1) % cy]
    column = (rows0 * (1 - fy)[:, None] + rows1 * fy[:, None]).astype(np.float32)
    noise = np.take(column, x0 % cx, axis=1)
    noise *= 1 - fx
    after = np.take(column, (x0 + 1) % cx, axis=1)
    after *= fx
    noise += after
    return noise


def _fractal(rng, size, cells, octaves=5, gain=0.5):
    total, weight, amount = np.zeros((size, size), np.float32), 1.0, 0.0
    for _ in range(octaves):
        layer = _noise(rng, size, cells)
        layer *= weight
        total += layer
        amount += weight
        weight *= gain
        cells = cells * 2 if isinstance(cells, int) else (cells[0] * 2, cells[1] * 2)
        if (cells if isinstance(cells, int) else max(cells)) > size:
            break
    total /= amount
    return total


def _grid(size):
    y, x = np.mgrid[0:size, 0:size].astype(np.float32) / np.float32(size)
    return x, y


def _relief(height, strength):
    """Light from the upper left over a height field, 1 on flat ground."""
    dx = np.roll(height, -1, 1) - np.roll(height, 1, 1)
    dy = np.roll(height, -1, 0) - np.roll(height, 1, 0)
    return np.clip(1.0 + strength * (-dx * 0.5 + dy * 0.8), 0.35, 1.6)


def _step(a, b, x):
    t = np.clip((x - a) / (b - a), 0, 1)
    return t * t * (3 - 2 * t)


def _mix(a, b, t):
    return a * (1 - t[..., None]) + b * t[..., None]


def _rgb(*values):
    return np.array(values, np.float32)


def _cells(rng, x, y, across, up, jitter, row_shift=0.5):
    """Tiling Voronoi cells: distance to the border between the two nearest (in cells), and the cell's number."""
    jx = ((rng.rand(up, across) - 0.5) * jitter).astype(np.float32).ravel()
    jy = ((rng.rand(up, across) - 0.5) * jitter).astype(np.float32).ravel()
    near, second = np.full((2, *x.shape), 81.0, np.float32)      # squares, until the end
    label = np.zeros(x.shape, np.int32)
    for first in range(0, len(x), BAND):
        band = slice(first, first + BAND)
        gx, gy = x[band] * np.float32(across), y[band] * np.float32(up)
        iy = np.floor(gy)
        for oy in (-1, 0, 1):
            row = iy + oy
            shift = (row % 2) * np.float32(row_shift)
            ix = np.floor(gx - shift)
            dx, dy = gx - ix - shift - np.float32(0.5), gy - row - np.float32(0.5)
            first_in_row, column = (row % up * across).astype(np.int32), ix.astype(np.int32)
            for ox in (-1, 0, 1):
                cell = first_in_row + (column + ox) % across
                d = np.square(dx - ox - jx[cell]) + np.square(dy - jy[cell])
                closer = d < near[band]
                np.minimum(second[band], np.maximum(d, near[band]), out=second[band])
                np.copyto(label[band], cell, where=closer)
                np.copyto(near[band], d, where=closer)
    np.sqrt(near, out=near)
    np.sqrt(second, out=second)
    second -= near
    return second, near, label


def _bricks(rng, x, y, across, up, width_jitter=0.3, shift=True):
    """Courses of blocks: distance to the nearest joint in tiles (horizontal, vertical), the block's number."""
    row = np.floor(y * np.float32(up))
    fy = y * np.float32(up) - row
    row = row.astype(np.int32) % up
    off = ((rng.rand(up, across) - 0.5) * width_jitter).astype(np.float32).ravel()
    start = (rng.rand(up) * across if shift else np.zeros(up)).astype(np.float32) + np.float32(0.5)
    away = np.empty(x.shape, np.float32)
    label = np.zeros(x.shape, np.int32)
    for first in range(0, len(x), BAND):
        band = slice(first, first + BAND)
        gx = (x[band] * np.float32(across) - start[row[band]]) % across
        whole = np.floor(gx)
        i = whole.astype(np.int32)
        left, right = np.full((2, *gx.shape), 99.0, np.float32)
        for k in (-1, 0, 1, 2):              # no cut is off its place by half a block: these are the nearest
            block = row[band] * across + (i + k) % across
            d = gx - whole - k - off[block]
            np.copyto(label[band], block, where=(d >= 0) & (d < left))
            np.copyto(left, d, where=(d >= 0) & (d < left))
            np.copyto(right, -d, where=(d < 0) & (-d < right))
        np.minimum(left, right, out=away[band])
    away /= across
    return away, np.minimum(fy, 1 - fy) / up, label


def _stones(size, distance, label, rng, palette, joint, joint_color, soft, bump, grain=0.25):
    """Coloured stones with rounded edges and dark joints from a distance field."""
    top = _step(joint, joint + soft, distance)
    rough = _fractal(rng, size, 32, 4)
    height = top * (0.8 + 0.35 * rough)
    count = int(label.max()) + 1
    pick = rng.randint(0, len(palette), count)
    tone = 0.85 + 0.28 * rng.rand(count)
    stone = np.take((np.array(palette)[pick] * tone[:, None]).astype(np.float32), label, axis=0)
    stone *= (1 - grain / 2 + grain * rough)[..., None]
    dirt = _fractal(rng, size, 5, 4)
    color = _mix(_rgb(*joint_color) * (0.7 + 0.6 * rough)[..., None], stone, _step(joint * 0.6, joint + soft * 0.5,
                                                                                distance))
    color = color * (0.82 + 0.36 * dirt)[..., None]
    return color * _relief(height, bump)[..., None]


def _levelled(color, stones):
    """Without differences of brightness that are wider than two of `stones` a side: repeated over a square, and seen
    flat from afar, they would make waves."""
    size = color.shape[0]
    light = color.mean(axis=2)
    few = 2 * stones                         # of the frequencies: what the others hold is less than a thousandth of a level
    squares = (np.fft.fftfreq(size) * size) ** 2
    near = np.nonzero(squares <= few ** 2)[0]
    keeps = np.exp(-0.5 * (squares[near][:, None] + squares[:few + 1]) / (0.25 * stones) ** 2)
    waves = np.zeros((size, size // 2 + 1), complex)
    waves[near, :few + 1] = np.fft.fft(np.fft.rfft(light)[:, :few + 1], axis=0)[near] * keeps
    wide = np.fft.irfft(np.fft.ifft(waves[:, :few + 1], axis=0), size)
    even = light.mean() / np.maximum(wide.astype(np.float32), 0.2 * light.mean())
    return color * even[..., None] ** np.float32(0.85)


def cobble(size, seed):
    """Rounded field stones for the carriageway."""
    rng = _rng(seed, "cobble")
    x, y = _grid(size)
    wx = (_noise(rng, size, 6) - 0.5) * 0.02
    border, _, label = _cells(rng, (x + wx) % 1, y, 24, 26, 0.62)
    palette = [(0.37, 0.35, 0.33), (0.42, 0.39, 0.35), (0.33, 0.33, 0.34), (0.46, 0.42, 0.37), (0.40, 0.35, 0.31)]
    color = _stones(size, border, label, rng, palette, 0.10, (0.215, 0.2, 0.165), 0.34, bump=2.8)
    moss = _step(0.55, 0.72, _fractal(rng, size, 4, 5)) * (1 - _step(0.1, 0.3, border))
    mossy = _mix(color, _rgb(0.17, 0.20, 0.09) * (0.7 + 0.6 * _noise(rng, size, 128))[..., None], 0.75 * moss)
    return _levelled(mossy, 24)


def setts(size, seed):
    """Small setts laid in straight courses, for the square. Fans would be scales from afar, and so are waves."""
    rng = _rng(seed, "setts")
    x, y = _grid(size)
    wave = (_noise(rng, size, 5) - 0.5) * 0.004 + (_noise(rng, size, 24) - 0.5) * 0.006
    jx, jy, label = _bricks(rng, (x + np.roll(wave, size // 3, 0)) % 1, (y + wave) % 1, 30, 36, 0.6)
    distance = np.minimum(jx * 30, jy * 30)
    palette = [(0.45, 0.42, 0.38), (0.50, 0.47, 0.42), (0.40, 0.38, 0.36), (0.47, 0.41, 0.36), (0.53, 0.50, 0.45)]
    color = _stones(size, distance, label, rng, palette, 0.07, (0.33, 0.31, 0.265), 0.2, bump=1.6)
    return _levelled(color, 30)


def paving(size, seed):
    """Worn flagstones for the pavements."""
    rng = _rng(seed, "paving")
    x, y = _grid(size)
    wave = (_fractal(rng, size, 8, 3) - 0.5) * 0.012
    jx, jy, label = _bricks(rng, (x + wave) % 1, (y + np.roll(wave, size // 3, 0)) % 1, 6, 8, 0.5)
    distance = np.minimum(jx, jy) * 40
    palette = [(0.50, 0.47, 0.42), (0.48, 0.46, 0.42), (0.53, 0.495, 0.44), (0.49, 0.455, 0.40), (0.46, 0.445, 0.42)]
    color = _stones(size, distance, label, rng, palette, 0.11, (0.29, 0.275, 0.23), 0.2, bump=0.9, grain=0.42)
    wear = _fractal(rng, size, 64, 3)
    return color * (0.9 + 0.2 * wear)[..., None]


def stone(size, seed):
    """Coursed rubble blocks for plinths, church and town wall."""
    rng = _rng(seed, "stone")
    x, y = _grid(size)
    wave = (_fractal(rng, size, 6, 3) - 0.5) * 0.014
    jx, jy, label = _bricks(rng, (x + wave) % 1, (y + np.roll(wave, size // 4, 1) * 0.8) % 1, 6, 10, 0.62)
    distance = np.minimum(jx, jy) * 40
    palette = [(0.74, 0.69, 0.60), (0.69, 0.65, 0.58), (0.78, 0.72, 0.61), (0.66, 0.63, 0.58), (0.72, 0.65, 0.55)]
    color = _stones(size, distance, label, rng, palette, 0.09, (0.55, 0.515, 0.45), 0.2, bump=0.9, grain=0.5)
    stain = _step(0.5, 0.75, _fractal(rng, size, (6, 3), 5))
    return color * (1 - 0.22 * stain)[..., None]


def plaster(size, seed):
    """Trowelled lime plaster: cloudy, with fine grit and a few hair cracks."""
    rng = _rng(seed, "plaster")
    cloud = _fractal(rng, size, 4, 5)
    trowel = _fractal(rng, size, (10, 22), 3)
    grit = _fractal(rng, size, 128, 3)
    x, y = _grid(size)
    warp = (_fractal(rng, size, 8, 4) - 0.5) * 0.12
    border, _, label = _cells(rng, (x + warp) % 1, (y - warp) % 1, 5, 5, 0.9)
    crack = (1 - _step(0.004, 0.014, border)) * _step(0.5, 0.62, _noise(rng, size, 7))
    value = 0.86 + 0.16 * (cloud - 0.5) + 0.10 * (trowel - 0.5) + 0.10 * (grit - 0.5)
    value = value * _relief(trowel * 0.6 + grit * 0.25, 2.2) ** 0.6 - 0.16 * crack
    streak = _step(0.55, 0.85, _fractal(rng, size, (40, 3), 4))
    color = _rgb(1.0, 0.985, 0.95) * value[..., None]
    return color * (1 - streak[..., None] * _rgb(0.07, 0.085, 0.11))


def timber(size, seed):
    """Hewn oak, the grain running along u; bright, so that the vertex colour makes it dark."""
    rng = _rng(seed, "timber")
    x, y = _grid(size)
    wave = (_fractal(rng, size, (3, 8), 3) - 0.5) * 0.06
    rings = _noise(rng, size, 8)
    row = ((y + wave) % 1 * size).astype(int) % size
    fiber = _fractal(rng, size, (4, 160), 3)[row, np.arange(size)[None, :]]
    coarse = _fractal(rng, size, (2, 24), 3)[row, np.arange(size)[None, :]]
    value = 0.74 + 0.30 * (fiber - 0.5) + 0.34 * (coarse - 0.5) + 0.12 * (rings - 0.5)
    split = _step(0.70, 0.78, _fractal(rng, size, (3, 64), 2)[row, np.arange(size)[None, :]])
    value = np.clip(value - 0.2 * split, 0.2, 1.0) * _relief(fiber, 1.0) ** 0.7
    return _rgb(1.0, 0.95, 0.88) * value[..., None]


def planks(size, seed):
    """Painted or bare boards that stand upright; bright, to be tinted."""
    rng = _rng(seed, "planks")
    x, y = _grid(size)
    boards = 8
    index = np.floor(x * boards).astype(int)
    fx = x * boards - index
    tone = (0.84 + 0.16 * rng.rand(boards))[index]
    grain = _fractal(rng, size, (96, 4), 3)
    wear = _fractal(rng, size, 6, 4)
    joint = _step(0.02, 0.075, np.minimum(fx, 1 - fx))
    value = tone * (0.86 + 0.28 * (grain - 0.5)) * (0.9 + 0.2 * wear)
    value = value * (0.28 + 0.72 * joint) * np.where(fx < 0.14, 1.06, 1.0)
    return _rgb(1.0, 0.985, 0.955) * value[..., None]


def roof_tile(size, seed):
    """Clay pantiles, the courses stepping down along v; warm, to be tinted."""
    rng = _rng(seed, "roof_tile")
    x, y = _grid(size)
    across, up = 14, 10
    row, column = np.floor(y * up), np.floor(x * across)
    fy, fx = y * up - row, x * across - column
    wobble = ((rng.rand(up, across) - 0.5) * 0.06).astype(np.float32)
    row, column = row.astype(int), column.astype(int)
    fx = (fx + wobble[row % up, column % across]) % 1.0
    roll = 0.5 + 0.5 * np.cos(2 * np.pi * (fx - 0.28))
    light = 0.62 + 0.48 * roll ** 1.2 - 0.22 * np.exp(-((fx - 0.86) / 0.08) ** 2)
    lip = fy + (rng.rand(up, across) * 0.05).astype(np.float32)[row % up, column % across]
    shadow = 1 - 0.62 * np.exp(-((1.0 - lip) / 0.07) ** 2) - 0.22 * _step(0.75, 1.0, lip)
    edge = 1 + 0.22 * np.exp(-((lip - 0.03) / 0.035) ** 2)
    palette = np.array([(0.80, 0.44, 0.30), (0.74, 0.38, 0.25), (0.86, 0.50, 0.35), (0.66, 0.35, 0.25),
                        (0.78, 0.46, 0.36), (0.60, 0.34, 0.26)])
    pick = rng.randint(0, len(palette), (up, across))
    tone = 0.84 + 0.3 * rng.rand(up, across)
    color = (palette[pick] * tone[..., None]).astype(np.float32)[row % up, column % across]
    rough = _fractal(rng, size, 48, 4)
    moss = _step(0.56, 0.74, _fractal(rng, size, (5, 8), 5)) * _step(0.35, 0.6, rough)
    color = color * (light * shadow * edge * (0.82 + 0.36 * rough))[..., None]
    grime = _fractal(rng, size, 4, 4)
    color = color * (0.84 + 0.32 * grime)[..., None]
    return _mix(color, _rgb(0.36, 0.35, 0.22) * (0.6 + 0.6 * rough)[..., None], 0.42 * moss)


def grass(size, seed):
    """Mown grass with clover, dry patches and trodden earth."""
    rng = _rng(seed, "grass")
    blades = np.zeros((size, size))
    for angle in range(5):
        layer = _fractal(rng, size, (180, 60) if angle % 2 else (70, 170), 2)
        blades = np.maximum(blades, np.roll(layer, rng.randint(size), angle % 2) * (0.8 + 0.05 * angle))
    tuft = _fractal(rng, size, 20, 4)
    patch = _fractal(rng, size, 4, 5)
    value = 0.35 + 0.9 * (blades - 0.45) + 0.35 * (tuft - 0.5)
    green = _mix(np.broadcast_to(_rgb(0.33, 0.37, 0.19), (size, size, 3)),
                 np.broadcast_to(_rgb(0.47, 0.46, 0.26), (size, size, 3)), _step(0.4, 0.7, patch))
    color = green * (0.55 + 1.1 * np.clip(value, 0, 1))[..., None]
    earth = _step(0.68, 0.8, _fractal(rng, size, 6, 5)) * (1 - _step(0.5, 0.7, tuft))
    return _mix(color, _rgb(0.36, 0.30, 0.2) * (0.6 + 0.8 * blades)[..., None], 0.7 * earth)


def bark(size, seed):
    """Furrowed bark, the furrows running along v."""
    rng = _rng(seed, "bark")
    x, y = _grid(size)
    warp = (_fractal(rng, size, (6, 3), 4) - 0.5) * 0.14
    border, _, _ = _cells(rng, (x + warp) % 1, y, 14, 4, 0.9)
    ridge = _step(0.03, 0.4, border)
    rough = _fractal(rng, size, 40, 4)
    value = (0.22 + 0.5 * ridge) * (0.7 + 0.6 * rough)
    color = _rgb(0.66, 0.57, 0.46) * value[..., None] * _relief(ridge * 0.7 + rough * 0.5, 4.0)[..., None]
    lichen = _step(0.6, 0.75, _fractal(rng, size, 7, 4)) * ridge
    return _mix(color, _rgb(0.40, 0.43, 0.30) * (0.6 + 0.6 * rough)[..., None], 0.5 * lichen)


def leaves(size, seed):
    """Overlapping leaves seen from outside the crown; bright, to be tinted."""
    rng = _rng(seed, "leaves")
    x, y = _grid(size)
    image = np.zeros((size, size, 3), np.float32)
    image[:] = (0.30, 0.32, 0.22)
    for layer in range(5):
        count = 13 + layer
        border, near, label = _cells(rng, (x + 0.13 * layer) % 1, (y + 0.29 * layer) % 1, count, count, 0.95, 0.5)
        cells = count * count
        angle = (rng.rand(cells) * np.pi).astype(np.float32)
        tone = ((0.55 + 0.45 * rng.rand(cells)) * (0.6 + 0.1 * layer)).astype(np.float32)[label]
        kept = (rng.rand(cells) < 0.62)[label]
        vein = np.abs(np.cos(angle)[label] * (x * count % 1 - 0.5) + np.sin(angle)[label] * (y * count % 1 - 0.5))
        leaf = kept & (near < 0.46) & (border > 0.05)
        light = tone * (0.75 + 0.5 * np.clip(0.5 - near, 0, 0.5)) * np.where(vein < 0.03, np.float32(1.3), np.float32(1))
        image *= np.where(near < 0.5, np.float32(0.9), np.float32(1))[..., None]
        image[leaf] = (np.stack([0.76 + 0.16 * (tone - 0.7), 0.80 + 0 * tone, 0.60 + 0 * tone], axis=-1) * light[..., None])[leaf]
    return np.clip(image * 1.25, 0, 1)


def twigs(size, seed):
    """Four twigs, two by two, cut out: leaves that point outwards from the middle. Bright, to be tinted."""
    rng = _rng(seed, "twigs")
    image = np.zeros((size, size, 4), np.float32)
    image[..., :3] = (0.50, 0.53, 0.38)
    for quarter in range(4):
        mx, my = 0.25 + 0.5 * (quarter % 2), 0.25 + 0.5 * (quarter // 2)
        for leaf in range(46):
            out, around = 0.185 * np.sqrt((45 - leaf + rng.rand()) / 46), 2 * np.pi * rng.rand()
            cx, cy = mx + out * np.cos(around), my + out * np.sin(around)
            way = around + rng.uniform(-0.9, 0.9)
            long, wide = rng.uniform(0.036, 0.05), rng.uniform(0.017, 0.024)
            i, j = (slice(max(0, int((at - long) * size)), int((at + long) * size) + 2) for at in (cx, cy))   # long is more than wide
            x, y = np.arange(size)[None, i] / size - cx, np.arange(size)[j, None] / size - cy
            u = (x * np.cos(way) + y * np.sin(way)) / long
            v = (-x * np.sin(way) + y * np.cos(way)) / wide
            inside = np.abs(v) < 1 - u * u
            tone = (0.62 + 0.38 * rng.rand()) * (0.78 + 0.22 * leaf / 45)
            color = np.array([0.80, 0.84, 0.60]) * tone
            shade = (0.86 + 0.14 * u) * np.where(np.abs(v) < 0.09, 1.14, 1.0) * np.where(v > 0, 1.0, 0.92)
            part = image[j, i]
            part[inside, :3] = color * shade[inside][:, None]
            part[inside, 3] = 1.0
    return np.clip(image, 0, 1)


def glass(size, seed):
    """Small panes in lead, each a little differently tilted to the sky; a curtain glimmers in a few."""
    rng = _rng(seed, "glass")
    x, y = _grid(size)
    across, up = 6, 4
    column, row = np.floor(x * across).astype(int), np.floor(y * up).astype(int)
    fx, fy = x * across - column, y * up - row
    lead = np.minimum(np.minimum(fx, 1 - fx) / across, np.minimum(fy, 1 - fy) / up)
    tilt = rng.rand(up, across)[row % up, column % across]
    ripple = _fractal(rng, size, 10, 3)
    sky = np.clip(0.13 + 0.17 * tilt * (0.5 + fy) + 0.20 * (ripple - 0.5), 0.04, 1)
    color = sky[..., None] * _rgb(0.82, 0.9, 0.94) + _rgb(0.03, 0.032, 0.032)
    warm = (rng.rand(up, across) > 0.86)[row % up, column % across]
    color = np.where(warm[..., None], color * 0.6 + _rgb(0.16, 0.12, 0.07), color)
    bead = _step(0.004, 0.009, lead)
    return _mix(np.broadcast_to(_rgb(0.11, 0.11, 0.115), color.shape), color, bead)


def cloth(size, seed):
    """Plain weave with folds along v; bright, to be tinted."""
    rng = _rng(seed, "cloth")
    x, y = _grid(size)
    weave = 0.5 + 0.25 * np.sin(2 * np.pi * x * 96) + 0.25 * np.sin(2 * np.pi * y * 96)
    fold = _fractal(rng, size, (10, 2), 3)
    stain = _fractal(rng, size, 5, 4)
    value = 0.86 + 0.06 * (weave - 0.5) + 0.28 * (fold - 0.5) + 0.14 * (stain - 0.5)
    return _rgb(1.0, 0.985, 0.95) * value[..., None]


# Material name -> (function, share of the full size, roughness). Iron has no texture.
TEXTURES = {
    "plaster": (plaster, 1.0, 0.95), "timber": (timber, 0.5, 0.85), "roof_tile": (roof_tile, 1.0, 0.85),
    "stone": (stone, 1.0, 0.92), "cobble": (cobble, 1.0, 0.85), "paving": (paving, 1.0, 0.88),
    "setts": (setts, 1.0, 0.85), "grass": (grass, 0.5, 1.0), "bark": (bark, 0.5, 0.95), "leaves": (leaves, 0.5, 0.8),
    "twigs": (twigs, 0.5, 0.8),
    "glass": (glass, 0.5, 0.15), "planks": (planks, 0.5, 0.75), "cloth": (cloth, 0.5, 0.95),
}


def make(name, size, seed):
    """sRGB values from 0 to 1, shape (pixels, pixels, 3), or with alpha where it is cut out (pixels, pixels, 4)."""
    function, share, _ = TEXTURES[name]
    return np.clip(function(max(64, int(size * share)), seed), 0.0, 1.0)
