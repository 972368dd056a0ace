"""Textures of imperfect surfaces: PNG files from noise that repeats."""

import math

from ..images import linear_png, png
from ..noise import periodic


def fractal(u, v, columns, rows, octaves, seed):
    """Noise of several octaves in [0, 1), of `columns` × `rows` cells over [0, 1)², which repeats."""
    total, weight, sum_of_weights = 0.0, 1.0, 0.0
    for octave in range(octaves):
        total += weight * periodic(columns * u, rows * v, columns, rows, seed + octave)
        sum_of_weights += weight
        weight *= 0.5
        columns, rows = 2 * columns, 2 * rows
    return total / sum_of_weights


def mix(a, b, t):
    return [x + (y - x) * t for x, y in zip(a, b)]


def wood(width, height, dark, light, rings=14, seed=1):
    """Boards cut along the grain, which runs along u: year rings that waver, pores and flecks."""
    def texel(u, v):
        bend = fractal(u, v, 2, 3, 3, seed)
        phase = rings * v + 4.5 * bend
        ring = phase % 1.0
        late = ring ** 3  # each ring grows darker towards its end
        pores = periodic(24.0 * u, 256.0 * v, 24, 256, seed + 10)
        fine = periodic(96.0 * u, 384.0 * v, 96, 384, seed + 11)
        tone = 0.75 - 0.5 * late + 0.35 * (fractal(u, v, 3, 24, 3, seed + 20) - 0.5)
        tone -= 0.45 * max(pores - 0.72, 0.0) / 0.28 + 0.12 * fine
        return mix(dark, light, min(max(tone, 0.0), 1.0))

    return linear_png(width, height, texel)


def mottled(size, first, second, cells=6, octaves=5, seed=3):
    """Two colours in clouds."""
    return linear_png(size, size, lambda u, v: mix(first, second, _steep(fractal(u, v, cells, cells, octaves, seed))))


def roughness(size, low, high, cells=5, octaves=5, seed=7):
    """A metallic-roughness texture for the given range of roughness, not metallic; of plain data."""
    pixels = bytearray()
    for y in range(size):
        for x in range(size):
            value = low + (high - low) * _steep(fractal((x + 0.5) / size, (y + 0.5) / size, cells, cells, octaves, seed))
            pixels.extend((255, round(255.0 * value), 255))
    return png(size, size, bytes(pixels))


def relief(size, height, slope):
    """A normal map of the function height(u, v), which repeats, scaled by `slope`."""
    rows = [[height((x + 0.5) / size, (y + 0.5) / size) for x in range(size)] for y in range(size)]
    pixels = bytearray()
    for y in range(size):
        for x in range(size):
            dx = slope * (rows[y][(x + 1) % size] - rows[y][x - 1])
            # Up in the image is against v.
            dy = slope * (rows[y - 1][x] - rows[(y + 1) % size][x])
            n = 1.0 / math.sqrt(dx * dx + dy * dy + 1.0)
            pixels.extend(round(127.5 + 127.5 * c) for c in (-dx * n, -dy * n, n))
    return png(size, size, bytes(pixels))


def weave(size, threads):
    """The height of a plain weave of `threads` × `threads` threads, for `relief`."""
    def height(u, v):
        a, b = threads * u, threads * v
        over = (int(a) + int(b)) % 2
        warp, weft = abs(math.sin(math.pi * a)), abs(math.sin(math.pi * b))
        return max(warp * (0.6 + 0.4 * weft) if over else 0.55 * warp, weft * (0.6 + 0.4 * warp) if not over else 0.55 * weft)

    return relief(size, height, 0.8)


def _steep(value):
    """More contrast: noise of many octaves keeps to the middle."""
    return min(max(1.8 * (value - 0.5) + 0.5, 0.0), 1.0)
