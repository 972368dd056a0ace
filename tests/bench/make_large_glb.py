#!/usr/bin/env python3
"""Writes a GLB of one mesh, a rolling height field, with many triangles or in many places: for measuring memory and
build times.

    tests/bench/make_large_glb.py /tmp/large.glb --triangles 10000000
    tests/bench/make_large_glb.py /tmp/placed.glb --triangles 8 --instances 1000000
"""
import argparse
import array
import json
import math
import struct


def write_glb(path, triangles, instances):
    side = max(2, math.isqrt((triangles + 1) // 2) + 1)
    cells = side - 1
    vertex_bytes = side * side * 12
    index_bytes = cells * cells * 6 * 4
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(instances))}],
        "nodes": [{"mesh": 0, "translation": [i % 1000, 0, i // 1000]} for i in range(instances)],
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
    arguments = parser.parse_args()
    print(write_glb(arguments.output, arguments.triangles, arguments.instances), "triangles")


if __name__ == "__main__":
    main()
