"""GLB files: reading and writing them, and what the renderer needs otherwise than the exporter has it. Needs nothing of
Blender."""

from __future__ import annotations

import copy
import json
import struct
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

MAGIC, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 0x4E4F534A, 0x004E4942
FLOAT, LAMPS, SPECULAR = 5126, "KHR_lights_punctual", "KHR_materials_specular"
UNNAMED = "without a material"
SIZES = {5121: 1, 5123: 2, FLOAT: 4}  # bytes of a number, by its type

Document = dict[str, Any]
# A motion holds translations, rotations (x, y, z, w) and scales of a node, one for each moment.
Motion = dict[str, list[tuple[float, ...]]]


def read_glb(path: Path) -> tuple[Document, bytes]:
    data = path.read_bytes()
    magic, version, size = struct.unpack_from("<III", data)
    if magic != MAGIC or version != 2 or size > len(data):
        raise ValueError(f"{path} is no GLB file")
    document, binary, at = {}, b"", 12
    while at < size:
        length, kind = struct.unpack_from("<II", data, at)
        content = data[at + 8:at + 8 + length]
        if kind == JSON_CHUNK:
            document = json.loads(content)
        elif kind == BINARY_CHUNK:
            binary = content
        at += 8 + length
    return document, binary


def write_glb(path: Path, document: Document, binary: bytes) -> None:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    if binary:
        document_size = document["buffers"][0]["byteLength"]
        assert document_size <= len(binary)
    chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
    if binary:
        chunks += struct.pack("<II", len(binary), BINARY_CHUNK) + binary
    path.write_bytes(struct.pack("<III", MAGIC, 2, 12 + len(chunks)) + chunks)


def give_nodes_their_own(document: Document) -> None:
    """Each node has a camera and a lamp of its own, with its name: the names of objects alone say then which is meant."""
    cameras, lamps = document.get("cameras", []), document.get("extensions", {}).get(LAMPS, {}).get("lights", [])
    own_cameras, own_lamps = [], []
    for node in document.get("nodes", []):
        if "camera" in node:
            own_cameras.append({**cameras[node["camera"]], "name": node.get("name", "")})
            node["camera"] = len(own_cameras) - 1
        lamp = node.get("extensions", {}).get(LAMPS)
        if lamp is not None:
            own_lamps.append({**copy.deepcopy(lamps[lamp["light"]]), "name": node.get("name", "")})
            lamp["light"] = len(own_lamps) - 1
    if own_cameras:
        document["cameras"] = own_cameras
    if own_lamps:
        document["extensions"][LAMPS]["lights"] = own_lamps
    for lamp in own_lamps:
        lamp["intensity"] = max(lamp.get("intensity", 1.0), 0.0)  # render.json has the strength


def rename(document: Document, numbers: Sequence[int], taken: Collection[str]) -> None:
    """Gives the nodes with these numbers other names where theirs are taken."""
    for number in numbers:
        node = document["nodes"][number]
        while node.get("name") in taken:
            node["name"] += "."


def leave_out(document: Document, shown: Collection[int]) -> list[str]:
    """Takes meshes and lamps from the nodes that are not to be rendered, and returns their names; what hangs below them
    stays."""
    left_out = []
    for number, node in enumerate(document.get("nodes", [])):
        if number in shown:
            continue
        extensions = node.get("extensions", {})
        if "mesh" in node or LAMPS in extensions:
            left_out.append(node.get("name", ""))
        node.pop("mesh", None)
        node.pop("skin", None)
        extensions.pop(LAMPS, None)
        if not extensions:
            node.pop("extensions", None)
    return left_out


def keep_vertex_colors(document: Document, used: Sequence[tuple[bool, bool]]) -> list[int]:
    """Takes vertex colours from what has a material that does not use them. `used` says of each material whether it uses
    their colour and their alpha. Returns the materials that use the alpha alone, which are left without it."""
    alone: set[int] = set()
    opaque: dict[int, int] = {}
    accessors, views = document.get("accessors", []), document.get("bufferViews", [])
    for primitive in (primitive for mesh in document.get("meshes", []) for primitive in mesh["primitives"]):
        number = primitive["attributes"].get("COLOR_0")
        if number is None:
            continue
        material = primitive.get("material")
        color, alpha = used[material] if material is not None else (False, False)
        if not color:
            del primitive["attributes"]["COLOR_0"]
            alone |= {material} if alpha else set()
        elif not alpha and accessors[number]["type"] == "VEC4":
            if number not in opaque:
                old = accessors[number]
                view = {**views[old["bufferView"]], "byteStride": 4 * SIZES[old["componentType"]]}
                views.append(view)
                accessors.append({**old, "type": "VEC3", "bufferView": len(views) - 1})
                for bound in {"min", "max"} & set(old):
                    accessors[-1][bound] = old[bound][:3]
                opaque[number] = len(accessors) - 1
            primitive["attributes"]["COLOR_0"] = opaque[number]
    return sorted(alone)


def set_spots(document: Document, cones: Mapping[str, tuple[float, float]]) -> None:
    """Gives the spots of these nodes their inner and outer angles; each node has a lamp of its own."""
    lamps = document.get("extensions", {}).get(LAMPS, {}).get("lights", [])
    for node in document.get("nodes", []):
        lamp = node.get("extensions", {}).get(LAMPS)
        if lamp is not None and node.get("name") in cones:
            inner, outer = cones[node["name"]]
            lamps[lamp["light"]]["spot"] = {"innerConeAngle": inner, "outerConeAngle": outer}


def give_all_materials(document: Document) -> None:
    """Gives what has no material the one that Blender shows then: diffuse, with an albedo of 0.8. That of glTF is white metal."""
    without = [primitive for mesh in document.get("meshes", []) for primitive in mesh["primitives"] if "material" not in primitive]
    if not without:
        return
    materials = document.setdefault("materials", [])
    materials.append({"name": UNNAMED, "doubleSided": True, "extensions": {SPECULAR: {"specularFactor": 0.0}},
                      "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1.0], "metallicFactor": 0.0}})
    used = document.setdefault("extensionsUsed", [])
    if SPECULAR not in used:
        used.append(SPECULAR)
    for primitive in without:
        primitive["material"] = len(materials) - 1


def add_extras(document: Document, extras: Mapping[int, Mapping[str, Any]]) -> None:
    """Adds to the `etendue` of the extras of nodes, by their numbers."""
    for number, given in extras.items():
        own = document["nodes"][number].setdefault("extras", {})
        own["etendue"] = {**own.get("etendue", {}), **given}


def put_above(document: Document, number: int) -> int:
    """Puts a new node between a node and what it hangs below, and returns its number."""
    new = len(document["nodes"])
    for owner, key in [(node, "children") for node in document["nodes"]] + [(scene, "nodes") for scene in document["scenes"]]:
        if number in owner.get(key, ()):
            owner[key] = [new if child == number else child for child in owner[key]]
    document["nodes"].append({"children": [number]})
    return new


def add_motion(document: Document, binary: bytes, times: list[float], motions: Mapping[int, Motion]) -> bytes:
    """Adds an animation that moves the nodes with these numbers through these moments, in place of all others. A node with
    a matrix, which must not be animated, gets a node above it that moves. Returns the binary part with its numbers."""
    document.pop("animations", None)
    if not motions:
        return binary
    data = bytearray(binary) + b"\0" * (-len(binary) % 4)
    accessors, views = document.setdefault("accessors", []), document.setdefault("bufferViews", [])

    def accessor(values: list[tuple[float, ...]], kind: str, **bounds: Any) -> int:
        flat = [number for value in values for number in value]
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(flat)})
        data.extend(struct.pack(f"<{len(flat)}f", *flat))
        accessors.append({"bufferView": len(views) - 1, "componentType": FLOAT, "count": len(values), "type": kind, **bounds})
        return len(accessors) - 1

    clock = accessor([(time,) for time in times], "SCALAR", min=[min(times)], max=[max(times)])
    samplers, channels = [], []
    for number, motion in motions.items():
        if "matrix" in document["nodes"][number]:
            number = put_above(document, number)
        for path, values in motion.items():
            samplers.append({"input": clock, "output": accessor(values, "VEC4" if path == "rotation" else "VEC3"),
                             "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": number, "path": path}})
    document["animations"] = [{"name": "shutter", "samplers": samplers, "channels": channels}]
    if document.get("buffers"):
        document["buffers"][0]["byteLength"] = len(data)
    else:
        document["buffers"] = [{"byteLength": len(data)}]
    return bytes(data)


def give_own_materials(document: Document, names: Collection[str], suffix: str) -> dict[str, str]:
    """Gives the meshes of these objects materials of their own, with this suffix to their names. Returns which material
    each is a copy of, "" for the default one."""
    copies: dict[int | None, int] = {}
    origins: dict[str, str] = {}
    materials = document.setdefault("materials", [])
    meshes: dict[int, int] = {}
    for node in document.get("nodes", []):
        if node.get("name") not in names or "mesh" not in node:
            continue
        if node["mesh"] not in meshes:
            mesh = copy.deepcopy(document["meshes"][node["mesh"]])
            for primitive in mesh["primitives"]:
                old = primitive.get("material")
                if old not in copies:
                    original = {} if old is None else materials[old]
                    name = f"{original.get('name', 'default')} {suffix}"
                    materials.append({**copy.deepcopy(original), "name": name})
                    copies[old] = len(materials) - 1
                    origins[name] = original.get("name", "")
                primitive["material"] = copies[old]
            document["meshes"].append(mesh)
            meshes[node["mesh"]] = len(document["meshes"]) - 1
        node["mesh"] = meshes[node["mesh"]]
    if not materials:
        del document["materials"]
    return origins


def set_orthographic(document: Document, name: str, halves: tuple[float, float]) -> None:
    """Gives the orthographic camera of the node of this name what it sees: half the width and half the height, metres."""
    for node in document.get("nodes", []):
        if node.get("name") == name and "camera" in node:
            document["cameras"][node["camera"]]["orthographic"] |= {"xmag": halves[0], "ymag": halves[1]}


def ensure_camera(document: Document, name: str, matrix: Sequence[float]) -> None:
    """Gives the node of this name a camera where the exporter knows none of its kind: a panorama. A node that it has left
    out, below what makes instances, comes to stand at the matrix, column by column."""
    nodes = document.setdefault("nodes", [])
    node = next((node for node in nodes if node.get("name") == name), None)
    if node is None:
        node = {"name": name, "matrix": list(matrix)}
        nodes.append(node)
        document["scenes"][document.get("scene", 0)].setdefault("nodes", []).append(len(nodes) - 1)
    if "camera" not in node:
        cameras = document.setdefault("cameras", [])
        cameras.append({"name": name, "type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}})
        node["camera"] = len(cameras) - 1
