"""Bodies with bevels, folds and texture coordinates, of which the scenes of the gallery are made."""

import math

from ..mesh import Mesh
from ..vector import add, cross, dot, normalize, scale, sub


def rounded_box(low, high, radius, steps=3, uv_per_meter=0.0, uv_offset=(0.0, 0.0)):
    """A closed box whose edges and corners are rounded, with exact normals; texture coordinates lie along its faces."""
    center = scale(add(low, high), 0.5)
    half = scale(sub(high, low), 0.5)
    core = tuple(h - radius for h in half)
    bevel = [radius * math.tan(0.25 * math.pi * i / steps) for i in range(steps + 1)]
    mesh = Mesh()
    for axis in range(3):
        for side in (1.0, -1.0):
            # The two axes of the face, in the order that has its front outside.
            u, v = ((axis + 1) % 3, (axis + 2) % 3) if side > 0.0 else ((axis + 2) % 3, (axis + 1) % 3)
            places = [[-core[k] - b for b in reversed(bevel)] + [core[k] + b for b in bevel] for k in (u, v)]
            first = mesh.vertex_count
            for b in places[1]:
                for a in places[0]:
                    point = [0.0, 0.0, 0.0]
                    point[axis], point[u], point[v] = side * half[axis], a, b
                    inner = tuple(min(max(p, -c), c) for p, c in zip(point, core))
                    normal = normalize(sub(point, inner))
                    position = add(center, add(inner, scale(normal, radius)))
                    uv = _face_uv(position, axis, uv_per_meter, uv_offset) if uv_per_meter else None
                    mesh.add_vertex(position, normal, uv)
            mesh.add_grid(2 * steps + 1, 2 * steps + 1, first=first)
    return mesh


def _face_uv(position, axis, uv_per_meter, offset):
    """Texture coordinates in the plane of a face, u along X wherever the face has it."""
    a, b = ((2, 1), (0, 2), (0, 1))[axis]
    return (uv_per_meter * position[a] + offset[0], uv_per_meter * position[b] + offset[1])


def refined(points, steps=5):
    """More points between `points`, on Catmull and Rom's cubics."""
    ends = [points[0], *points, points[-1]]
    result = []
    for i in range(len(points) - 1):
        p0, p1, p2, p3 = ends[i:i + 4]
        for k in range(steps):
            u = k / steps
            result.append(tuple(0.5 * (2.0 * b + (c - a) * u + (2.0 * a - 5.0 * b + 4.0 * c - d) * u * u
                                       + (3.0 * b - a - 3.0 * c + d) * u ** 3) for a, b, c, d in zip(p0, p1, p2, p3)))
    return [*result, points[-1]]


def tube(path, radius, around=12, closed=False):
    """A round tube through the points of `path`; `radius` is a number or one for each point. Ends are rounded off."""
    points = list(path)
    radii = list(radius) if hasattr(radius, "__len__") else [radius] * len(points)
    count = len(points)
    tangents = []
    for i in range(count):
        before = points[i - 1] if i or closed else points[i]
        after = points[(i + 1) % count] if i + 1 < count or closed else points[i]
        tangents.append(normalize(sub(after, before)))
    rings = list(zip(points, tangents, radii, (0.0,) * count))
    if not closed:
        caps = [(math.sin(a), math.cos(a)) for a in (math.pi * 0.5 * k / 4 for k in range(4, 0, -1))]
        head = [(add(points[0], scale(tangents[0], -radii[0] * s)), tangents[0], radii[0] * c, -s) for s, c in caps]
        tail = [(add(points[-1], scale(tangents[-1], radii[-1] * s)), tangents[-1], radii[-1] * c, s)
                for s, c in reversed(caps)]
        rings = head + rings + tail
    mesh = Mesh()
    helper = (0.0, 1.0, 0.0) if abs(rings[0][1][1]) < 0.9 else (1.0, 0.0, 0.0)
    side = normalize(cross(helper, rings[0][1]))
    for point, tangent, r, lean in rings:
        side = normalize(sub(side, scale(tangent, dot(side, tangent))))
        other = cross(tangent, side)
        for j in range(around):
            angle = 2.0 * math.pi * j / around
            out = add(scale(side, math.cos(angle)), scale(other, math.sin(angle)))
            normal = add(scale(out, math.sqrt(1.0 - lean * lean)), scale(tangent, lean))
            mesh.add_vertex(add(point, scale(out, max(r, 0.0))), normal)
    mesh.add_grid(around, len(rings) - (0 if closed else 1), wrap_columns=True, wrap_rows=closed)
    return mesh


def height_field(low, high, columns, rows, height, uv_per_meter=0.0):
    """A smooth surface y = height(x, z) between the corners (x, z), seen from above."""
    (x0, z0), (x1, z1) = low, high
    step = 0.25 * min((x1 - x0) / columns, (z1 - z0) / rows)
    mesh = Mesh()
    for row in range(rows + 1):
        z = z1 + (z0 - z1) * row / rows
        for column in range(columns + 1):
            x = x0 + (x1 - x0) * column / columns
            slope_x = (height(x + step, z) - height(x - step, z)) / (2.0 * step)
            slope_z = (height(x, z + step) - height(x, z - step)) / (2.0 * step)
            uv = (x * uv_per_meter, z * uv_per_meter) if uv_per_meter else None
            mesh.add_vertex((x, height(x, z), z), normalize((-slope_x, 1.0, -slope_z)), uv)
    mesh.add_grid(columns, rows)
    return mesh


def surface(place, columns, rows, wrap_columns=False, uv_scale=None):
    """A smooth surface through place(s, t) for s, t in [0, 1], whose front is where the change by s × that by t points.

    With `uv_scale` (u, v) it has texture coordinates, and no vertices are shared where it wraps.
    """
    mesh = Mesh()
    share = wrap_columns and not uv_scale
    for row in range(rows + 1):
        t = row / rows
        for column in range(columns if share else columns + 1):
            s = column / columns
            mesh.add_vertex(place(s, t), _normal_of(place, s, t, wrap_columns),
                            (s * uv_scale[0], t * uv_scale[1]) if uv_scale else None)
    mesh.add_grid(columns, rows, wrap_columns=share)
    return mesh


def _normal_of(place, s, t, wraps, step=1e-4):
    """The normal by differences, within [0, 1] and a little off the poles."""
    low_t, high_t = max(t - step, 0.0), min(t + step, 1.0)
    low_s, high_s = (s - step, s + step) if wraps else (max(s - step, 0.0), min(s + step, 1.0))
    middle_t = min(max(t, step), 1.0 - step)
    along = sub(place(high_s, middle_t), place(low_s, middle_t))
    across = sub(place(s, high_t), place(s, low_t))
    return normalize(cross(along, across))


def moved(mesh, place):
    """The mesh with place(position) for each position, which may shift and turn the mesh but not scale it."""
    result = Mesh()
    origin = place((0.0, 0.0, 0.0))
    for i in range(mesh.vertex_count):
        position = tuple(mesh.positions[3 * i:3 * i + 3])
        normal = tuple(mesh.normals[3 * i:3 * i + 3])
        result.add_vertex(place(position), sub(place(normal), origin))
    result.uvs.extend(mesh.uvs)
    result.indices.extend(mesh.indices)
    return result
