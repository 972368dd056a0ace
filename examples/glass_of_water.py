"""Writes a scene directory with a glass of water on a table: python3 glass_of_water.py DIR."""
import base64, json, math, pathlib, struct, sys

GLASS = [(0, 0), (30, 0), (33, 1), (34, 4), (38, 100), (37, 101), (36, 100), (32, 10), (0, 10)]
WATER = [(0, 9), (31, 9), (33, 12), (35.5, 72), (0, 72)]  # into the glass, which has the higher priority
TABLE = [(600, -0.2), (0, -0.2)]


def lathe(outline, steps=96):
    """Points and triangles of an outline (radius, height), in millimetres, around the Y axis."""
    points = [(r * math.sin(a) / 1000, h / 1000, r * math.cos(a) / 1000)
              for r, h in outline for a in (2 * math.pi * i / steps for i in range(steps))]
    sides = [(j * steps + i, j * steps + (i + 1) % steps) for j in range(len(outline) - 1) for i in range(steps)]
    triangles = [t for a, b in sides for t in ((a, b, b + steps), (a, b + steps, a + steps))]
    return points, [k for t in triangles if len({points[k] for k in t}) == 3 for k in t]  # none without area on the axis


data, scene = b"", {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}], "nodes": [], "meshes": [],
                    "accessors": [], "bufferViews": [], "materials": [{"name": n} for n in ("glass", "water", "table")]}
for number, outline in enumerate((GLASS, WATER, TABLE)):
    points, triangles = lathe(outline)
    bounds = {"min": [min(axis) for axis in zip(*points)], "max": [max(axis) for axis in zip(*points)]}
    for values, kind in (([c for p in points for c in p], "f"), (triangles, "I")):
        scene["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(values)})
        data += struct.pack(f"<{len(values)}{kind}", *values)
    scene["accessors"] += [
        {"bufferView": 2 * number, "componentType": 5126, "count": len(points), "type": "VEC3", **bounds},
        {"bufferView": 2 * number + 1, "componentType": 5125, "count": len(triangles), "type": "SCALAR"}]
    scene["meshes"].append({"primitives": [{"attributes": {"POSITION": 2 * number}, "indices": 2 * number + 1, "material": number}]})
    scene["nodes"].append({"mesh": number})
scene["buffers"] = [{"uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode(), "byteLength": len(data)}]
settings = {"integrator": {"type": "vcm"}, "size": [640, 480], "environment": {"color": [0.4, 0.5, 0.6]},
            "camera": {"position": [0.05, 0.25, 0.42], "look_at": [0.02, 0.035, 0], "yfov": 0.45},
            "lights": {"sun": {"type": "sphere", "position": [-0.5, 0.6, -0.4], "radius": 0.02, "radiance": 2500}},
            "materials": {"glass": {"dielectric": {"ior": 1.5}, "priority": 1}, "water": {"dielectric": {"ior": 1.333}},
                          "table": {"diffuse": {"albedo": [0.35, 0.22, 0.13]}}}}
directory = pathlib.Path(sys.argv[1])
directory.mkdir(parents=True, exist_ok=True)
(directory / "scene.gltf").write_text(json.dumps(scene))
(directory / "render.json").write_text(json.dumps(settings))
