"""EXT_mesh_gpu_instancing, which Blender 3.4 does not import, as nodes."""

import json
import struct
from pathlib import Path

EXTENSION = "EXT_mesh_gpu_instancing"
COMPONENTS = {"TRANSLATION": 3, "ROTATION": 4, "SCALE": 3}


def _values(document, folder, index, components):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    if accessor["componentType"] != 5126 or "byteStride" in view:
        raise ValueError("only tightly packed floats are read of instances")
    data = (folder / document["buffers"][view["buffer"]]["uri"]).read_bytes()
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    flat = struct.unpack_from(f"<{components * accessor['count']}f", data, start)
    return [list(flat[i:i + components]) for i in range(0, len(flat), components)]


def without_instancing(gltf, output):
    """`gltf` if it has none; else `output`, a copy in which each instance is a child of the node it belongs to."""
    gltf, output = Path(gltf), Path(output)
    document = json.loads(gltf.read_text())
    if EXTENSION not in document.get("extensionsUsed", []):
        return gltf
    for node in list(document["nodes"]):
        instancing = node.get("extensions", {}).pop(EXTENSION, None)
        if instancing is None:
            continue
        columns = {name: _values(document, gltf.parent, instancing["attributes"][name], count)
                   for name, count in COMPONENTS.items() if name in instancing["attributes"]}
        mesh = node.pop("mesh")
        for row in zip(*columns.values()):
            node.setdefault("children", []).append(len(document["nodes"]))
            document["nodes"].append({"mesh": mesh, **{name.lower(): value for name, value in zip(columns, row)}})
    for key in ("extensionsUsed", "extensionsRequired"):
        if EXTENSION in document.get(key, []):
            document[key].remove(EXTENSION)
            if not document[key]:
                del document[key]
    for buffer in document["buffers"]:
        buffer["uri"] = str((gltf.parent / buffer["uri"]).resolve())
    output.write_text(json.dumps(document))
    return output
