"""Repeatable noise without tables."""

import math


def hashed(x, y, seed=0):
    """A number in [0, 1) that depends on three integers in no visible way."""
    value = (x * 0x9E3779B1 + y * 0x85EBCA77 + seed * 0xC2B2AE3D) & 0xFFFFFFFF
    for multiplier in (0x7FEB352D, 0x846CA68B):
        value = ((value ^ (value >> 16)) * multiplier) & 0xFFFFFFFF
    return (value ^ (value >> 16)) / 2.0 ** 32


def periodic(x, y, columns, rows, seed=0):
    """Smooth noise in [0, 1) of one cell per unit, which repeats after whole `columns` and `rows`."""
    i, j = math.floor(x), math.floor(y)
    s, t = (f * f * (3.0 - 2.0 * f) for f in (x - i, y - j))
    a, b, c, d = (hashed((i + k) % columns, (j + m) % rows, seed) for m in (0, 1) for k in (0, 1))
    return (a + (b - a) * s) * (1.0 - t) + (c + (d - c) * s) * t
