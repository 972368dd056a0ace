#!/usr/bin/env python3
"""FLIP once more, slowly, to hold src/metrics/flip.cpp against: flip_test.cpp has the numbers that this prints.

Written from the formulas of Andersson et al. 2020 and 2021 and shares nothing with the renderer: double precision, filters
as squares of weights instead of products of rows and columns, the opponent space with its scales and offset, matrices
from the chromaticities of Rec. 709. Needs only the standard library; takes a minute.
"""

import math
import struct

GREEN, BLUE = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def float32(value):
    """As the test's images hold it."""
    return struct.unpack("f", struct.pack("f", value))[0]


# ---- The images, by the same rule as in flip_test.cpp.


def unit_numbers():
    """In [0, 1), by a linear congruential generator."""
    state = 12345
    while True:
        state = (1664525 * state + 1013904223) % 2**32
        yield (state >> 8) / 2**24


def ldr_pair(width, height):
    """Image and reference: stripes, a ramp and a pattern; the image with noise."""
    numbers = unit_numbers()
    image, reference = [], []
    for y in range(height):
        for x in range(width):
            clean = [
                (0.8 if x % 8 < 4 else 0.1) * (y + 1) / height,
                x / (width - 1),
                (x * 7 + y * 13) % 11 / 10,
            ]
            noisy = [min(max(c + 0.5 * (next(numbers) - 0.5), 0.0), 1.0) for c in clean]
            reference.append(tuple(map(float32, clean)))
            image.append(tuple(map(float32, noisy)))
    return image, reference


def hdr_of(pixels):
    return [tuple(float32(40.0 * c * c * c) for c in pixel) for pixel in pixels]


# ---- Colours.


def matrix_times(m, v):
    return tuple(sum(a * b for a, b in zip(row, v)) for row in m)


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [
        [(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
        [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
        [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det],
    ]


def xyz_of_xy(x, y):
    return (x / y, 1.0, (1.0 - x - y) / y)


def rec709_to_xyz():
    primaries = [xyz_of_xy(0.64, 0.33), xyz_of_xy(0.30, 0.60), xyz_of_xy(0.15, 0.06)]
    columns = [list(row) for row in zip(*primaries)]
    scale = matrix_times(inverse(columns), xyz_of_xy(0.3127, 0.3290))
    return [[c * s for c, s in zip(row, scale)] for row in columns]


TO_XYZ = rec709_to_xyz()
FROM_XYZ = inverse(TO_XYZ)
WHITE = matrix_times(TO_XYZ, (1.0, 1.0, 1.0))


def opponent(rgb):
    x, y, z = (c / w for c, w in zip(matrix_times(TO_XYZ, rgb), WHITE))
    return (116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))


def rgb_of_opponent(c):
    y = (c[0] + 16.0) / 116.0
    xyz = (y + c[1] / 500.0, y, y - c[2] / 200.0)
    return matrix_times(FROM_XYZ, [a * w for a, w in zip(xyz, WHITE)])


def hunt_lab(rgb):
    def f(t):
        return t ** (1.0 / 3.0) if t > (6.0 / 29.0) ** 3 else t / (3.0 * (6.0 / 29.0) ** 2) + 4.0 / 29.0

    x, y, z = (f(c / w) for c, w in zip(matrix_times(TO_XYZ, rgb), WHITE))
    lightness = 116.0 * y - 16.0
    return (lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))


def hyab(p, q):
    return abs(p[0] - q[0]) + math.hypot(p[1] - q[1], p[2] - q[2])


LARGEST = hyab(hunt_lab(GREEN), hunt_lab(BLUE)) ** 0.7


def color_error(p, q):
    compressed = hyab(p, q) ** 0.7
    knee = 0.4 * LARGEST
    if compressed < knee:
        return 0.95 / knee * compressed
    return 0.95 + (compressed - knee) / (LARGEST - knee) * 0.05


# ---- Filters: {(dx, dy): weight}.


def square(radius):
    return [(x, y) for y in range(-radius, radius + 1) for x in range(-radius, radius + 1)]


def contrast_filter(terms, ppd):
    radius = math.ceil(3.0 * math.sqrt(0.04 / (2.0 * math.pi**2)) * ppd)
    weights = {}
    for x, y in square(radius):
        d2 = (x * x + y * y) / ppd**2
        weights[x, y] = sum(
            a * math.sqrt(math.pi / b) * math.exp(-math.pi**2 * d2 / b) for a, b in terms
        )
    total = sum(weights.values())
    return {place: weight / total for place, weight in weights.items()}


def feature_filter(ppd, kind, axis):
    deviation = 0.5 * 0.082 * ppd
    weights = {}
    for place in square(math.ceil(3.0 * deviation)):
        t = place[axis]
        g = math.exp(-(place[0] ** 2 + place[1] ** 2) / (2.0 * deviation**2))
        weights[place] = -t * g if kind == "edge" else (t * t / deviation**2 - 1.0) * g
    positive = sum(w for w in weights.values() if w > 0.0)
    negative = -sum(w for w in weights.values() if w < 0.0)
    return {place: w / (positive if w > 0.0 else negative) for place, w in weights.items()}


def filtered(values, width, height, weights):
    result = []
    for y in range(height):
        for x in range(width):
            total = 0.0
            for (dx, dy), weight in weights.items():
                sx = min(max(x + dx, 0), width - 1)
                sy = min(max(y + dy, 0), height - 1)
                total += weight * values[sy * width + sx]
            result.append(total)
    return result


# ---- FLIP.


def seen(pixels, width, height, ppd):
    """Colours, strength of edges and of points."""
    channels = list(zip(*map(opponent, pixels)))
    terms = [[(1.0, 0.0047)], [(1.0, 0.0053)], [(34.1, 0.04), (13.5, 0.025)]]
    blurred = [filtered(c, width, height, contrast_filter(t, ppd)) for c, t in zip(channels, terms)]
    colors = []
    for c in zip(*blurred):
        colors.append(hunt_lab([min(max(v, 0.0), 1.0) for v in rgb_of_opponent(c)]))
    grey = [(y + 16.0) / 116.0 for y in channels[0]]
    strengths = []
    for kind in ("edge", "point"):
        along = [filtered(grey, width, height, feature_filter(ppd, kind, axis)) for axis in (0, 1)]
        strengths.append([math.hypot(a, b) for a, b in zip(*along)])
    return colors, *strengths


def ldr_flip(image, reference, width, height, ppd):
    p = seen(image, width, height, ppd)
    q = seen(reference, width, height, ppd)
    errors = []
    for i in range(width * height):
        feature = max(abs(p[1][i] - q[1][i]), abs(p[2][i] - q[2][i]))
        errors.append(color_error(p[0][i], q[0][i]) ** (1.0 - (feature / math.sqrt(2.0)) ** 0.5))
    return errors


def tone_mapped(pixels, exposure):
    def fit(value):
        x = 0.6 * value * 2.0**exposure
        return min(max((2.51 * x * x + 0.03 * x) / (2.43 * x * x + 0.59 * x + 0.14), 0.0), 1.0)

    return [tuple(map(fit, pixel)) for pixel in pixels]


def exposures(reference):
    """Start, stop and number."""
    low, high = 0.0, 100.0
    while high - low > 1e-13:
        middle = 0.5 * (low + high)
        if tone_mapped([(middle,)], 0.0)[0][0] < 0.85:
            low = middle
        else:
            high = middle
    luminances = sorted(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in reference)
    start = math.log2(low / luminances[-1])
    stop = math.log2(low / luminances[len(luminances) // 2])
    return start, stop, max(2, math.ceil(stop - start))


def hdr_flip(image, reference, width, height, ppd):
    start, stop, count = exposures(reference)
    errors = [0.0] * (width * height)
    for i in range(count):
        exposure = start + i * (stop - start) / (count - 1)
        some = ldr_flip(tone_mapped(image, exposure), tone_mapped(reference, exposure), width, height, ppd)
        errors = list(map(max, errors, some))
    return errors


def report(name, errors, width):
    places = [(0, 0), (7, 3), (width - 1, len(errors) // width - 1)]
    some = ", ".join(f"({x}, {y}) {errors[y * width + x]:.6f}" for x, y in places)
    print(f"{name}: mean {sum(errors) / len(errors):.6f}, {some}")


def main():
    print(f"c_max {LARGEST:.6f}")
    black, white, red = hunt_lab((0, 0, 0)), hunt_lab((1, 1, 1)), hunt_lab((1, 0, 0))
    print(f"black and white {color_error(black, white):.6f}")
    print(f"black and red {color_error(black, red):.6f}")
    print(f"red and green {color_error(red, hunt_lab(GREEN)):.6f}")
    grey = [hunt_lab((v, v, v)) for v in (0.18, 0.2)]
    print(f"grey of 0.18 and 0.2 {color_error(*grey):.6f}")
    width, height = 40, 30
    image, reference = ldr_pair(width, height)
    default = 0.7 * (3840.0 / 0.7) * math.pi / 180.0
    report(f"LDR-FLIP, {default:.4f} ppd", ldr_flip(image, reference, width, height, default), width)
    report("LDR-FLIP, 20 ppd", ldr_flip(image, reference, width, height, 20.0), width)
    image, reference = hdr_of(image), hdr_of(reference)
    start, stop, count = exposures(reference)
    print(f"exposures {start:.6f} to {stop:.6f}, {count}")
    report("HDR-FLIP, 20 ppd", hdr_flip(image, reference, width, height, 20.0), width)


if __name__ == "__main__":
    main()
