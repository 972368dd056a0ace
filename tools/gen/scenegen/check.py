"""Checks of a generated scene, read back from the bytes that would be written. Functions return problems as text."""

import json
import math
from array import array

_ARRAY_TYPE = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
# What normalised integers are divided by.
_LARGEST = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535}
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
# render.json states derived numbers with four decimals.
_TOLERANCE = 6e-5


def check_scene(scene, render_json_text):
    """Everything that is wrong with a GeneratedScene and the render.json beside it."""
    contents = scene.contents()
    document, binary = json.loads(contents["scene.gltf"]), contents["scene.bin"]
    problems = check_buffers(document, binary)
    if problems:
        return problems
    return (check_nodes(document) + check_meshes(document, binary, scene.closed_meshes)
            + check_triangle_count(document, scene.triangles)
            + check_render_json(document, scene.render_json, render_json_text))


def check_buffers(document, binary):
    """Sizes, alignment, and the stated bounds of every accessor."""
    problems = []
    if document["buffers"][0]["byteLength"] != len(binary):
        problems.append("the buffer's length is not that of scene.bin")
    for i, view in enumerate(document["bufferViews"]):
        # What is compressed says elsewhere where its bytes are.
        view = view.get("extensions", {}).get("EXT_meshopt_compression", view)
        if view["byteOffset"] % 4 or view["byteOffset"] + view["byteLength"] > len(binary):
            problems.append(f"buffer view {i} is unaligned or leaves the buffer")
    if problems:
        return problems
    for i, accessor in enumerate(document["accessors"]):
        if is_compressed(document, i):
            continue
        values, n = read_accessor(document, binary, i), _COMPONENTS[accessor["type"]]
        if len(values) != accessor["count"] * n:
            problems.append(f"accessor {i} has {len(values)} components, not {accessor['count'] * n}")
        elif "min" in accessor and (accessor["min"] != [min(values[c::n]) for c in range(n)]
                                    or accessor["max"] != [max(values[c::n]) for c in range(n)]):
            problems.append(f"accessor {i} states wrong bounds")
        if accessor["componentType"] == 5126 and not all(map(math.isfinite, values)):
            problems.append(f"accessor {i} has values that are not finite")
    return problems


def is_compressed(document, index):
    """Whether the values of an accessor only come out of a decoder."""
    view = document["accessors"][index].get("bufferView")
    return view is None or "extensions" in document["bufferViews"][view]


def read_accessor(document, binary, index):
    """All components of an accessor, as an array; those of normalised integers as they are stored."""
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    values = array(_ARRAY_TYPE[accessor["componentType"]])
    size = values.itemsize * _COMPONENTS[accessor["type"]]
    begin, length = view["byteOffset"], view["byteLength"]
    for i in range(begin, begin + length, view.get("byteStride", length)):
        values.frombytes(binary[i:i + (size if "byteStride" in view else length)])
    return values


def read_vectors(document, binary, index):
    """The vectors of an accessor of three components, and how far rounding may have moved each component."""
    accessor = document["accessors"][index]
    values = read_accessor(document, binary, index)
    if not accessor.get("normalized"):
        return _triples(values), 0.0
    scale = 1.0 / _LARGEST[accessor["componentType"]]
    return _triples([value * scale for value in values]), 0.5 * scale


def check_nodes(document):
    """References and rotations of nodes, and that there is a camera."""
    problems = []
    for i, node in enumerate(document["nodes"]):
        if not 0 <= node.get("mesh", 0) < len(document["meshes"]):
            problems.append(f"node {i} refers to no mesh")
        if abs(sum(c * c for c in node.get("rotation", [0, 0, 0, 1])) - 1.0) > 1e-6:
            problems.append(f"node {i} has a rotation that is no unit quaternion")
    if not document.get("cameras"):
        problems.append("there is no camera")
    return problems


def check_meshes(document, binary, closed_meshes):
    """Indices, normals and winding of every mesh that is not compressed; that the `closed_meshes` are watertight."""
    problems = [f"there is no mesh '{name}'" for name in
                closed_meshes - {mesh["name"] for mesh in document["meshes"]}]
    checked = set()
    for mesh in document["meshes"]:
        primitive = mesh["primitives"][0]
        attributes = primitive["attributes"]
        closed = mesh["name"] in closed_meshes
        key = (attributes["POSITION"], primitive["indices"], closed)
        if key in checked or any(is_compressed(document, index) for index in key[:2]):
            continue
        checked.add(key)
        positions, _ = read_vectors(document, binary, attributes["POSITION"])
        triangles = _triples(read_accessor(document, binary, primitive["indices"]))
        found = []
        if "NORMAL" in attributes:
            normals, rounding = read_vectors(document, binary, attributes["NORMAL"])
            found = check_normals(positions, normals, triangles, 1e-5 + 4.0 * rounding)
        if closed and not found:
            found = check_watertight(positions, triangles)
        problems += [f"mesh '{mesh['name']}': {problem}" for problem in found]
    return problems


def check_normals(positions, normals, triangles, tolerance):
    """Unit normals on the front of every triangle, which has an area, and indices in range.

    Squared lengths may differ from 1 by `tolerance`."""
    if len(positions) != len(normals) or max(map(max, triangles)) >= len(positions):
        return ["attributes of different lengths, or an index out of range"]
    wrong_length = sum(abs(x * x + y * y + z * z - 1.0) > tolerance for x, y, z in normals)
    problems = [f"{wrong_length} normals are not of unit length"] if wrong_length else []
    degenerate = backward = 0
    for a, b, c in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = positions[a], positions[b], positions[c]
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        degenerate += nx * nx + ny * ny + nz * nz < 1e-24
        backward += any(nx * normal[0] + ny * normal[1] + nz * normal[2] <= 0.0
                        for normal in (normals[a], normals[b], normals[c]))
    if degenerate:
        problems.append(f"{degenerate} triangles have no area")
    if backward:
        problems.append(f"{backward} triangles wind against their normals")
    return problems


def check_watertight(positions, triangles):
    """That every edge is passed exactly once in each direction, vertices at the same place being one."""
    index_of = {}
    # Vertices that come out of different sums differ in their last bits.
    welded = [index_of.setdefault(tuple(round(c, 6) + 0.0 for c in p), i) for i, p in enumerate(positions)]
    edges = {}
    for triangle in triangles:
        a, b, c = (welded[i] for i in triangle)
        for edge in ((a, b), (b, c), (c, a)):
            edges[edge] = edges.get(edge, 0) + 1
    open_edges = sum(count != 1 or edges.get((b, a)) != 1 for (a, b), count in edges.items())
    return [f"{open_edges} of {len(edges)} edges are not watertight"] if open_edges else []


def check_triangle_count(document, expected):
    """The number of triangles of all meshes, each mesh once."""
    count = sum(document["accessors"][mesh["primitives"][0]["indices"]]["count"] // 3 for mesh in document["meshes"])
    return [f"there are {count} triangles, not {expected}"] if count != expected else []


def check_render_json(document, expected, text):
    """That render.json names only materials that exist, and states each expected value at its JSON pointer."""
    try:
        settings = json.loads(text)
    except json.JSONDecodeError as error:
        return [f"render.json is no JSON: {error}"]
    names = {material["name"] for material in document["materials"]}
    problems = [f"render.json overrides '{name}', which is no material of the scene"
                for name in settings.get("materials", {}) if name not in names]
    for pointer, value in expected.items():
        found = settings
        for key in pointer.split("/")[1:]:
            found = found.get(key) if isinstance(found, dict) else None
        if not _agree(found, value):
            problems.append(f"render.json has {json.dumps(found)} at {pointer}, not {json.dumps(_rounded(value))}")
    return problems


def _agree(found, expected):
    if isinstance(expected, dict):
        return isinstance(found, dict) and found.keys() == expected.keys() and all(
            _agree(found[key], value) for key, value in expected.items())
    if isinstance(expected, list):
        return isinstance(found, list) and len(found) == len(expected) and all(map(_agree, found, expected))
    if isinstance(expected, float):
        return isinstance(found, (int, float)) and abs(found - expected) < _TOLERANCE
    return found == expected


def _rounded(value):
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return round(value, 4) if isinstance(value, float) else value


def _triples(values):
    return list(zip(values[0::3], values[1::3], values[2::3]))
