"""Triangle meshes and the closed-form surfaces that the scenes are made of. Metres, +Y up, counter-clockwise fronts."""

import math
from array import array

from .vector import add, cross, dot, length, normalize, scale, sub


class Mesh:
    """Triangles with normals and, if wanted, tangents, texture coordinates and colours."""

    def __init__(self):
        self.positions = array("f")
        self.normals = array("f")
        self.tangents = array("f")
        self.uvs = array("f")
        self.colors = array("B")
        self.indices = array("I")

    @property
    def vertex_count(self):
        return len(self.positions) // 3

    @property
    def triangle_count(self):
        return len(self.indices) // 3

    def add_vertex(self, position, normal, uv=None, color=None, tangent=None):
        """Appends one vertex and returns its index.

        `uv`, `color` (RGBA bytes) and `tangent` (x, y, z, handedness) for all vertices or for none.
        """
        self.positions.extend(position)
        self.normals.extend(normal)
        if uv is not None:
            self.uvs.extend(uv)
        if color is not None:
            self.colors.extend(color)
        if tangent is not None:
            self.tangents.extend(tangent)
        return self.vertex_count - 1

    def add_triangle(self, a, b, c):
        self.indices.extend((a, b, c))

    def add_quad(self, corners, uvs=None):
        """A flat-shaded quadrilateral, counter-clockwise from its front, split at its first corner.

        One normal if it is flat; the triangles' own if it is not.
        """
        first = _face_normal(corners[0], corners[1], corners[2])
        second = _face_normal(corners[0], corners[2], corners[3])
        uvs = uvs or [None] * 4
        if dot(first, second) > 1.0 - 1e-12:
            a, b, c, d = (self.add_vertex(p, first, uv) for p, uv in zip(corners, uvs))
            self.add_triangle(a, b, c)
            self.add_triangle(a, c, d)
            return
        for normal, picked in ((first, (0, 1, 2)), (second, (0, 2, 3))):
            self.add_triangle(*(self.add_vertex(corners[i], normal, uvs[i]) for i in picked))

    def add_grid(self, columns, rows, wrap_columns=False, wrap_rows=False, first=0):
        """Triangles between (columns + 1) × (rows + 1) vertices stored row by row, or one less where it wraps.

        Fronts where column × row is the outward normal. Degenerate triangles, as at a pole, are left out.
        """
        stride = columns if wrap_columns else columns + 1
        height = rows if wrap_rows else rows + 1
        for row in range(rows):
            for column in range(columns):
                a = first + row * stride + column
                b = first + row * stride + (column + 1) % stride
                c = first + (row + 1) % height * stride + (column + 1) % stride
                d = first + (row + 1) % height * stride + column
                for corners in ((a, b, c), (a, c, d)):
                    if not self._is_degenerate(corners):
                        self.add_triangle(*corners)

    def position(self, index):
        return tuple(self.positions[3 * index:3 * index + 3])

    def _is_degenerate(self, corners):
        p, q, r = (self.position(i) for i in corners)
        return length(cross(sub(q, p), sub(r, p))) < 1e-12


def _face_normal(a, b, c):
    return normalize(cross(sub(b, a), sub(c, a)))


def ground(half_size, y=0.0, uv_per_meter=0.0):
    """A horizontal square facing up, centred on the origin; with texture coordinates if `uv_per_meter` is not 0."""
    h, t = half_size, half_size * uv_per_meter
    mesh = Mesh()
    uvs = ((-t, t), (t, t), (t, -t), (-t, -t)) if t else None
    mesh.add_quad(((-h, y, h), (h, y, h), (h, y, -h), (-h, y, -h)), uvs)
    return mesh


def rectangle(corner, right, up, uv_per_meter=0.0):
    """The rectangle of two perpendicular edges from a corner, whose front is where right × up points.

    Texture coordinates, if `uv_per_meter` is not 0, start at the corner and run along the edges, v downwards.
    """
    corners = (corner, add(corner, right), add(add(corner, right), up), add(corner, up))
    mesh = Mesh()
    u, v = length(right) * uv_per_meter, length(up) * uv_per_meter
    mesh.add_quad(corners, ((0.0, 0.0), (u, 0.0), (u, -v), (0.0, -v)) if uv_per_meter else None)
    return mesh


def panel(width, height):
    """A rectangle about the origin that faces -Z, where lights look."""
    return rectangle((-0.5 * width, -0.5 * height, 0.0), (0.0, height, 0.0), (width, 0.0, 0.0))


def wall(corner, right, up, openings, uv_per_meter=0.0):
    """`rectangle` with rectangular `openings`: (low, high) corners in metres along `right` and `up`, which do not
    overlap. Each piece has texture coordinates as if the wall were whole."""
    sizes = (length(right), length(up))
    axes = (normalize(right), normalize(up))
    cuts = [sorted({0.0, size, *(corner[k] for opening in openings for corner in opening)})
            for k, size in enumerate(sizes)]
    pieces = []
    for u0, u1 in zip(cuts[0], cuts[0][1:]):
        for v0, v1 in zip(cuts[1], cuts[1][1:]):
            if any(low[0] <= u0 < high[0] and low[1] <= v0 < high[1] for low, high in openings):
                continue
            start = add(corner, add(scale(axes[0], u0), scale(axes[1], v0)))
            piece = rectangle(start, scale(axes[0], u1 - u0), scale(axes[1], v1 - v0), uv_per_meter)
            for i in range(0, len(piece.uvs), 2):
                piece.uvs[i] += u0 * uv_per_meter
                piece.uvs[i + 1] -= v0 * uv_per_meter
            pieces.append(piece)
    return merged(pieces)


def box(low, high, uv_per_meter=0.0):
    """A closed box with its faces outwards."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    x, y, z = (x1 - x0, 0.0, 0.0), (0.0, y1 - y0, 0.0), (0.0, 0.0, z1 - z0)
    return merged([rectangle(corner, right, up, uv_per_meter) for corner, right, up in (
        ((x0, y0, z1), x, y), ((x1, y0, z0), scale(x, -1.0), y), ((x1, y0, z1), scale(z, -1.0), y),
        ((x0, y0, z0), z, y), ((x0, y1, z1), x, scale(z, -1.0)), ((x0, y0, z0), x, z))])


def extrusion(outline, low, high):
    """A closed upright body from y = low to high over a convex outline of points (x, z), counter-clockwise from
    above."""
    mesh = Mesh()
    for (x0, z0), (x1, z1) in zip(outline, [*outline[1:], outline[0]]):
        mesh.add_quad(((x0, low, z0), (x1, low, z1), (x1, high, z1), (x0, high, z0)))
    for y, corners in ((high, outline), (low, [outline[0], *outline[:0:-1]])):
        normal = (0.0, 1.0 if y == high else -1.0, 0.0)
        first, *others = (mesh.add_vertex((x, y, z), normal) for x, z in corners)
        for b, c in zip(others, others[1:]):
            mesh.add_triangle(first, b, c)
    return mesh


def wavy_block(low, high, columns, rows, wave):
    """A closed box from corner `low` to (x, z) `high` with a top of waves, which is smooth.

    `wave(x, z)` is the height and its derivatives along x and z. The sides and the bottom are flat.
    """
    (x0, bottom, z0), (x1, z1) = low, high
    mesh = Mesh()
    # From the front to the back, so that column × row points up.
    for row in range(rows + 1):
        z = z1 + (z0 - z1) * row / rows
        for column in range(columns + 1):
            x = x0 + (x1 - x0) * column / columns
            height, along_x, along_z = wave(x, z)
            mesh.add_vertex((x, height, z), normalize((-along_x, 1.0, -along_z)))
    mesh.add_grid(columns, rows)
    stride = columns + 1
    edges = ([*range(stride)], [columns + stride * row for row in range(rows + 1)],
             [stride * rows + column for column in range(columns, -1, -1)],
             [stride * row for row in range(rows, -1, -1)])
    middle = mesh.add_vertex((0.5 * (x0 + x1), bottom, 0.5 * (z0 + z1)), (0.0, -1.0, 0.0))
    for edge, normal in zip(edges, ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (-1.0, 0.0, 0.0))):
        _add_skirt(mesh, edge, bottom, normal, middle)
    return mesh


def _add_skirt(mesh, edge, bottom, normal, middle):
    """A flat side from the vertices `edge` down to `bottom`, and the bottom between it and the vertex `middle`."""
    first = mesh.vertex_count
    places = [mesh.position(i) for i in edge]
    for x, _, z in places:
        mesh.add_vertex((x, bottom, z), normal)
    for place in places:
        mesh.add_vertex(place, normal)
    mesh.add_grid(len(edge) - 1, 1, first=first)
    below = [mesh.add_vertex((x, bottom, z), (0.0, -1.0, 0.0)) for x, _, z in places]
    for a, b in zip(below, below[1:]):
        mesh.add_triangle(b, a, middle)


def sphere(radius, frequency, center=(0.0, 0.0, 0.0)):
    """A geodesic sphere of 20 · frequency² triangles with exact normals: a subdivided icosahedron, pushed outwards."""
    mesh = Mesh()
    index_of = {}

    def vertex(point):
        normal = normalize(point)
        # Corners shared by several faces come out of different sums: equal but for the last bits.
        key = tuple(round(c, 9) + 0.0 for c in normal)
        if key not in index_of:
            index_of[key] = mesh.add_vertex(add(center, scale(normal, radius)), normal)
        return index_of[key]

    for corners in _icosahedron():
        for indices in _subdivided(corners, frequency, vertex):
            mesh.add_triangle(*indices)
    return mesh


def mapped_sphere(radius, columns, rows):
    """A sphere about the origin with exact normals, texture coordinates and tangents: longitude and latitude.

    u runs once around from the seam at -Z, counter-clockwise seen from above; v from the top to the bottom, as in
    images; tangents lie along u. 2 · columns · (rows - 1) triangles.
    """
    mesh = Mesh()
    for row in range(rows + 1):
        # From the bottom, so that column × row points outwards; exactly on the axis at the poles.
        v = 1.0 - row / rows
        ring, height = (math.sin(math.pi * v), math.cos(math.pi * v)) if 0 < row < rows else (0.0, 1.0 - 2.0 * v)
        for column in range(columns + 1):
            angle = 2.0 * math.pi * (column % columns) / columns
            s, c = -math.sin(angle), -math.cos(angle)
            normal = (ring * s, height, ring * c)
            mesh.add_vertex(scale(normal, radius), normal, uv=(column / columns, v), tangent=(c, 0.0, -s, 1.0))
    mesh.add_grid(columns, rows)
    return mesh


def flat_inward_sphere(radius, frequency):
    """The same closed surface seen from inside: fronts inwards and one normal per triangle."""
    mesh = Mesh()
    for corners in _icosahedron():
        points = _subdivided(corners, frequency, lambda point: scale(normalize(point), radius))
        for a, b, c in points:
            normal = _face_normal(a, c, b)
            mesh.add_triangle(*(mesh.add_vertex(p, normal) for p in (a, c, b)))
    return mesh


def _icosahedron():
    """The 20 faces as triples of corners, counter-clockwise from outside."""
    g = (1.0 + math.sqrt(5.0)) / 2.0
    p = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
         (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = ((0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
             (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1))
    return [tuple(p[i] for i in face) for face in faces]


def _subdivided(corners, frequency, vertex):
    """The frequency² triangles of a triangle, with `vertex` applied to each point."""
    a, b, c = corners
    rows = [[vertex(add(scale(a, (frequency - i) / frequency),
                        add(scale(b, (i - j) / frequency), scale(c, j / frequency))))
             for j in range(i + 1)] for i in range(frequency + 1)]
    for i in range(frequency):
        for j in range(i + 1):
            yield rows[i][j], rows[i + 1][j], rows[i + 1][j + 1]
            if j < i:
                yield rows[i][j], rows[i + 1][j + 1], rows[i][j + 1]


def lathe(profile, segments, center=(0.0, 0.0)):
    """A surface of revolution about a vertical axis at (x, z) = `center`.

    `profile` is a list of points (radius, height) from bottom to top, with the outside on the right of the way up.
    Edges of the profile are flat bands with their own normals; around the axis it is smooth.
    """
    mesh = Mesh()
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        slope = math.hypot(r1 - r0, y1 - y0)
        nr, ny = (y1 - y0) / slope, (r0 - r1) / slope
        _add_rings(mesh, ((r0, y0), (r1, y1)), ((nr, ny), (nr, ny)), segments, center)
    return mesh


def dome(radius, base, segments, rings, center=(0.0, 0.0)):
    """The upper half of a sphere about (center x, base, center z), with exact normals and open below."""
    mesh = Mesh()
    angles = [0.5 * math.pi * i / rings for i in range(rings + 1)]
    # Exactly on the axis, so that the triangles of the last ring collapse to what add_grid leaves out.
    directions = [(math.cos(a), math.sin(a)) for a in angles[:-1]] + [(0.0, 1.0)]
    for low, high in zip(directions, directions[1:]):
        circles = [(radius * r, base + radius * y) for r, y in (low, high)]
        _add_rings(mesh, circles, (low, high), segments, center)
    return mesh


def revolved(points, normals, segments, loop=False):
    """A smooth surface of revolution about the Y axis, with the given normals.

    `points` are (radius, height) from bottom to top and `normals` (radial, up), with the outside on the right of the
    way up; with `loop` the profile is closed, and the surface a ring.
    """
    mesh = Mesh()
    _add_rings(mesh, points, normals, segments, loop=loop)
    return mesh


def sampled_profile(curve, steps):
    """Points and exact normals for `revolved` at steps + 1 places of a curve.

    `curve(t)` for t in [0, 1] is (radius, height) and their derivatives.
    """
    points, normals = [], []
    for i in range(steps + 1):
        radius, height, radius_rate, height_rate = curve(i / steps)
        rate = math.hypot(radius_rate, height_rate)
        points.append((radius, height))
        normals.append((height_rate / rate, -radius_rate / rate))
    return points, normals


def smooth_outline(outline, steps_per_point=8):
    """Points and normals, for `revolved`, of Catmull and Rom's cubics through points (radius, height) from the axis below
    to the axis above."""
    # Mirrored at the axis, so that it is smooth there.
    ends = [(-outline[1][0], outline[1][1]), *outline, (-outline[-2][0], outline[-2][1])]
    spans = len(outline) - 1

    def curve(t):
        span = min(int(t * spans), spans - 1)
        u = t * spans - span
        values = []
        for axis in range(2):
            p0, p1, p2, p3 = (point[axis] for point in ends[span:span + 4])
            a, b, c = 0.5 * (p2 - p0), p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3, 1.5 * (p1 - p2) + 0.5 * (p3 - p0)
            values.append((p1 + u * (a + u * (b + u * c)), a + u * (2.0 * b + 3.0 * u * c)))
        (radius, radius_rate), (height, height_rate) = values
        return max(radius, 0.0), height, radius_rate, height_rate

    points, normals = sampled_profile(curve, spans * steps_per_point)
    points[0], points[-1] = (0.0, points[0][1]), (0.0, points[-1][1])
    normals[0], normals[-1] = (0.0, -1.0), (0.0, 1.0)
    return points, normals


def ring(radius, half_thickness, height, segments, arc_steps):
    """An upright band about the Y axis that stands on y = 0: straight walls, rims rounded to half circles."""
    normals = []
    for i in range(2 * (arc_steps + 1)):
        # From the outer wall over the upper rim to the inner wall, and back below.
        angle = math.pi * (i - i // (arc_steps + 1)) / arc_steps
        normals.append((math.cos(angle), math.sin(angle)))
    middles = [height - half_thickness] * (arc_steps + 1) + [half_thickness] * (arc_steps + 1)
    points = [(radius + half_thickness * nr, middle + half_thickness * ny)
              for middle, (nr, ny) in zip(middles, normals)]
    return revolved(points, normals, segments, loop=True)


def _add_rings(mesh, points, normals, segments, center=(0.0, 0.0), loop=False):
    """Quadrilaterals between circles (radius, height), one after the other; normals in (radial, up)."""
    first = mesh.vertex_count
    for (radius, y), (nr, ny) in zip(points, normals):
        for i in range(segments):
            angle = 2.0 * math.pi * i / segments
            # Angles run from +Z to +X, so that around × up points outwards.
            s, c = math.sin(angle), math.cos(angle)
            mesh.add_vertex((center[0] + radius * s, y, center[1] + radius * c), (nr * s, ny, nr * c))
    mesh.add_grid(segments, len(points) - (0 if loop else 1), wrap_columns=True, wrap_rows=loop, first=first)


def torus_knot(p, q, radius, reach, tube, along, around, color):
    """A tube of radius `tube` about the (p, q) torus knot: 2 · along · around triangles, closed, with exact normals.

    The knot runs on the torus of the radii `radius` and `reach` about the Y axis. The torus's own normal is
    perpendicular to the knot everywhere and, with the tangent, gives the tube its frame without a seam.
    `color(s, t)` is RGBA bytes for s, t in [0, 1) along and around.
    """
    mesh = Mesh()
    for i in range(along):
        s = 2.0 * math.pi * i / along
        cp, sp, cq, sq = math.cos(p * s), math.sin(p * s), math.cos(q * s), math.sin(q * s)
        ring = radius + reach * cq
        point = (ring * cp, reach * sq, ring * sp)
        outward = -reach * q * sq
        tangent = normalize((outward * cp - ring * p * sp, reach * q * cq, outward * sp + ring * p * cp))
        normal = (cq * cp, sq, cq * sp)
        binormal = cross(tangent, normal)
        for j in range(around):
            t = 2.0 * math.pi * j / around
            # Turning from the normal to the binormal makes around × along point outwards.
            out = add(scale(normal, math.cos(t)), scale(binormal, math.sin(t)))
            mesh.add_vertex(add(point, scale(out, tube)), out, color=color(i / along, j / around))
    mesh.add_grid(around, along, wrap_columns=True, wrap_rows=True)
    return mesh


def convex(planes, slack=1e-7):
    """The flat-shaded body of all points with dot(normal, point) <= offset for each (unit normal, offset) of `planes`.

    A vertex is where three planes meet within all others; corners that lie within 100 `slack` are one.
    """
    corners = []
    for i, (n0, d0) in enumerate(planes):
        for j, (n1, d1) in enumerate(planes[:i]):
            along = cross(n0, n1)
            for n2, d2 in planes[:j]:
                volume = dot(along, n2)
                if abs(volume) < 1e-6:
                    continue
                point = scale(add(add(scale(cross(n1, n2), d0), scale(cross(n2, n0), d1)), scale(along, d2)), 1.0 / volume)
                if all(dot(n, point) <= d + slack for n, d in planes) and all(
                        length(sub(point, corner)) > 100.0 * slack for corner in corners):
                    corners.append(point)
    mesh = Mesh()
    for normal, offset in planes:
        face = [corner for corner in corners if abs(dot(normal, corner) - offset) <= 200.0 * slack]
        if len(face) < 3:
            continue
        right = normalize(cross(normal, (0.0, 0.0, 1.0) if abs(normal[2]) < 0.9 else (1.0, 0.0, 0.0)))
        up = cross(normal, right)
        middle = scale(tuple(map(sum, zip(*face))), 1.0 / len(face))
        face.sort(key=lambda point: math.atan2(dot(sub(point, middle), up), dot(sub(point, middle), right)))
        indices = [mesh.add_vertex(point, normal) for point in face]
        for b, c in zip(indices[1:], indices[2:]):
            mesh.add_triangle(indices[0], b, c)
    return mesh


def merged(meshes):
    """One mesh of all triangles; all must have the same attributes."""
    result = Mesh()
    for mesh in meshes:
        offset = result.vertex_count
        for name in ("positions", "normals", "tangents", "uvs", "colors"):
            getattr(result, name).extend(getattr(mesh, name))
        result.indices.extend(i + offset for i in mesh.indices)
    return result
