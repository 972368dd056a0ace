"""Small vectors as tuples of floats, and the rotations that place things in a scene."""

import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    return scale(a, 1.0 / length(a))


def direction(elevation, azimuth):
    """Unit vector `elevation` radians above the horizon; azimuth 0 is -Z and grows towards +X."""
    return (
        math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation),
        -math.cos(elevation) * math.cos(azimuth),
    )


def quaternion_of_axes(x, y, z):
    """Unit quaternion [x, y, z, w] of the rotation that takes the coordinate axes to the orthonormal x, y, z."""
    # The largest of the four components is computed first, so that the division is well conditioned.
    candidates = (
        1.0 + x[0] - y[1] - z[2],
        1.0 - x[0] + y[1] - z[2],
        1.0 - x[0] - y[1] + z[2],
        1.0 + x[0] + y[1] + z[2],
    )
    largest = max(range(4), key=lambda i: candidates[i])
    s = 0.5 / math.sqrt(candidates[largest])
    products = {
        0: (candidates[0], x[1] + y[0], z[0] + x[2], y[2] - z[1]),
        1: (x[1] + y[0], candidates[1], y[2] + z[1], z[0] - x[2]),
        2: (z[0] + x[2], y[2] + z[1], candidates[2], x[1] - y[0]),
        3: (y[2] - z[1], z[0] - x[2], x[1] - y[0], candidates[3]),
    }
    return [component * s for component in products[largest]]


def look_at(position, target, up=(0.0, 1.0, 0.0)):
    """Quaternion that turns the local -Z from `position` towards `target`, as cameras and lights of glTF look."""
    z = normalize(sub(position, target))
    x = normalize(cross(up, z))
    return quaternion_of_axes(x, cross(z, x), z)


def standing_on(normal, turn):
    """Quaternion that takes +Y to `normal` after a rotation by `turn` radians about +Y."""
    helper = (1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 else (0.0, 0.0, 1.0)
    u = normalize(cross(helper, normal))
    v = cross(u, normal)
    c, s = math.cos(turn), math.sin(turn)
    x = add(scale(u, c), scale(v, s))
    return quaternion_of_axes(x, normal, cross(x, normal))
