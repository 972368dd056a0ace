"""Base colour textures that repeat: PNG files from closed forms and repeatable noise."""

import math

from .images import linear_png
from .noise import hashed, periodic


def checker(first, second, width, height):
    """Two by two fields of two linear greys, the first of them in the corner of the origin."""
    return linear_png(width, height, lambda u, v: [first if (u < 0.5) == (v < 0.5) else second] * 3)


def tiles(size, count, colors, grout, grout_width):
    """`count` × `count` square tiles, each of a shade between two of `colors`; `grout_width` in tiles."""
    def texel(u, v):
        x, y = count * u, count * v
        if min(x % 1.0, y % 1.0) < grout_width:
            return grout
        i, j = int(x), int(y)
        first, second = colors[int(len(colors) * hashed(i, j, 1))], colors[int(len(colors) * hashed(i, j, 2))]
        return _mix(first, second, hashed(i, j, 3))

    return linear_png(size, size, texel)


def planks(size, rows, dark, light):
    """Boards along u, two to a row, between two colours, with grain along them and dark joints."""
    def texel(u, v):
        row = int(rows * v)
        # Every row is shifted against its neighbour.
        along = u + 0.37 * row
        board = math.floor(2.0 * along) % 2
        across = rows * v - row
        if min(across, 1.0 - across) < 0.03 or (2.0 * along) % 1.0 < 0.008:
            return [0.35 * c for c in dark]
        shade = hashed(board, row, 4)
        streaks = periodic(6.0 * along, 8.0 * rows * v, 6, 8 * rows, 5)
        fine = periodic(16.0 * along, 32.0 * rows * v, 16, 32 * rows, 6)
        return _mix(dark, light, 0.35 * shade + 0.45 * streaks + 0.2 * fine)

    return linear_png(size, size, texel)


def plaster(size, color, depth):
    """A colour that is darker in places by up to `depth`."""
    def texel(u, v):
        shade = sum(weight * periodic(n * u, n * v, n, n, n) for n, weight in ((4, 0.4), (16, 0.3), (64, 0.3)))
        return [c * (1.0 - depth * shade) for c in color]

    return linear_png(size, size, texel)


def _mix(a, b, t):
    return [x + (y - x) * t for x, y in zip(a, b)]
