#!/usr/bin/env python3
"""Writes a GLB of one mesh, a rolling height field, with many triangles, in many places or under many lights: for
measuring memory, times of loading and building, and how rendering slows down.

    tests/bench/make_large_glb.py /tmp/large.glb --triangles 10000000
    tests/bench/make_large_glb.py /tmp/placed.glb --triangles 8 --instances 1000000
    tests/bench/make_large_glb.py /tmp/lit.glb --triangles 1000 --lights 100000

Places fill a square row by row, and the camera sees all of it from the same side whatever their number. Lights are points
in a square above; all of them together have the same intensity whatever their number. Without lights there are none, so
that a renderer's own environment shines.
"""
import argparse
import array
import json
import math
import struct


def square_side(count):
    """Of the smallest square that holds so many."""
    return math.isqrt(count - 1) + 1


def light_nodes(lights, width):
    """Evenly spaced above the field, as high as a tenth of its width."""
    side = square_side(lights)
    return [{"extensions": {"KHR_lights_punctual": {"light": 0}},
             "translation": [width * (i % side + 0.5) / side, 0.1 + 0.1 * width, width * (i // side + 0.5) / side]}
            for i in range(lights)]


def camera_node(width):
    """Looks down at the middle of the field, at 45 degrees."""
    return {"camera": 0, "translation": [0.5 * width, 0.9 * width, 1.4 * width],
            "rotation": [-math.sin(math.pi / 8), 0, 0, math.cos(math.pi / 8)]}


def write_glb(path, triangles, instances=1, lights=0):
    """Returns how many triangles the mesh has: the smallest square of cells with at least about so many."""
    side = max(2, math.isqrt((triangles + 1) // 2) + 1)
    cells = side - 1
    vertex_bytes = side * side * 12
    index_bytes = cells * cells * 6 * 4
    row = square_side(instances)
    nodes = [{"mesh": 0, "translation": [i % row, 0, i // row]} for i in range(instances)]
    nodes += light_nodes(lights, row) if lights else []
    nodes.append(camera_node(row))
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.001}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": 2 * vertex_bytes + index_bytes}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": vertex_bytes},
            {"buffer": 0, "byteOffset": vertex_bytes, "byteLength": vertex_bytes},
            {"buffer": 0, "byteOffset": 2 * vertex_bytes, "byteLength": index_bytes},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": side * side, "type": "VEC3",
             "min": [0, -0.1, 0], "max": [1, 0.1, 1]},
            {"bufferView": 1, "componentType": 5126, "count": side * side, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5125, "count": cells * cells * 6, "type": "SCALAR"},
        ],
    }
    if lights:
        # The illuminance of a point light falls with the square of the distance, which grows with the field.
        intensity = 100.0 * row * row / lights
        document["extensionsUsed"] = ["KHR_lights_punctual"]
        document["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": intensity}]}}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    size = 2 * vertex_bytes + index_bytes
    with open(path, "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 12 + 8 + len(text) + 8 + size))
        out.write(struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", size, 0x004E4942))
        waves = [40.0 * i / cells for i in range(side)]
        sines = [math.sin(w) for w in waves]
        slopes = [4.0 * math.cos(w) for w in waves]
        for z in range(side):
            row = array.array("f")
            for x in range(side):
                row.extend((x / cells, 0.1 * sines[x] * sines[z], z / cells))
            row.tofile(out)
        for z in range(side):
            row = array.array("f")
            for x in range(side):
                nx, nz = -slopes[x] * sines[z], -sines[x] * slopes[z]
                scale = 1.0 / math.sqrt(nx * nx + nz * nz + 1.0)
                row.extend((nx * scale, scale, nz * scale))
            row.tofile(out)
        for z in range(cells):
            row = array.array("I")
            for a in range(z * side, z * side + cells):
                b = a + side
                row.extend((a, b, a + 1, a + 1, b, b + 1))
            row.tofile(out)
    return 2 * cells * cells


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("output", help="the GLB to write")
    parser.add_argument("--triangles", type=int, default=10_000_000, help="at least about so many (default 10 million)")
    parser.add_argument("--instances", type=int, default=1, help="places of the mesh (default 1)")
    parser.add_argument("--lights", type=int, default=0, help="point lights above it (default 0)")
    arguments = parser.parse_args()
    if min(arguments.triangles, arguments.instances) < 1 or arguments.lights < 0:
        parser.error("--triangles and --instances have to be 1 or more, --lights 0 or more")
    print(write_glb(arguments.output, arguments.triangles, arguments.instances, arguments.lights), "triangles")


if __name__ == "__main__":
    main()
