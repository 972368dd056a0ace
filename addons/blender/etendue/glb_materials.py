"""Changes of the materials of the exporter's GLB. Needs nothing of Blender."""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from .written import Document, Texture, Written

STRENGTH, TRANSFORM = "KHR_materials_emissive_strength", "KHR_texture_transform"


def mend(document: Document, binary: bytes, written: Written, image_bytes: Callable[[Any, bool], tuple[bytes, str]],
         uv_set: Callable[[str, str], int]) -> bytes:
    """Makes all changes that reading the materials has asked for. `image_bytes` returns the file of an image and its
    media type, with colours times alpha if its second argument is true; `uv_set` returns the number of a UV map on the
    meshes of a material, by the names of both. Returns the binary part with the images."""
    leave_out(document, written.left_out)
    strip(document, written.bare, written.dark)
    shine_both_ways(document)
    remove_bumps(document, written.unbumped)
    binary = add_textures(document, binary, written.textures, image_bytes, uv_set)
    blend(document, written.blended, written.alphas)
    for material in named(document, written.opaque - written.blended):
        material.pop("alphaMode", None)
        material.pop("alphaCutoff", None)
    return binary


def named(document: Document, names: Collection[str]) -> list[Document]:
    return [material for material in document.get("materials", []) if material.get("name") in names]


def override(document: Document, name: str) -> None:
    """Gives all surfaces one material, whose entry in render.json says all of it."""
    materials = document.setdefault("materials", [])
    number = next((number for number, material in enumerate(materials) if material.get("name") == name), len(materials))
    if number == len(materials):
        materials.append({"name": name})
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            primitive["material"] = number


def give_parts(document: Document, parts: Mapping[int, Sequence[Any]], materials: Sequence[Any]) -> list[int]:
    """Gives the mesh of each node in `parts`, by the node's number, the materials that its primitives are rendered
    with; None is for no material. `materials` are those of the file. Returns the nodes where that is not possible."""
    failed, copies = [], {}
    for number, wanted in parts.items():
        node = document["nodes"][number]
        mesh = document["meshes"][node["mesh"]]
        given = [materials[primitive["material"]] if "material" in primitive else None
                 for primitive in mesh["primitives"]]
        if given == list(wanted):
            continue
        if len(given) != len(wanted) or any(part is not None and part not in materials for part in wanted):
            failed.append(number)
            continue
        key = (node["mesh"], *(None if part is None else materials.index(part) for part in wanted))
        if key not in copies:
            own = copy.deepcopy(mesh)
            for primitive, part in zip(own["primitives"], key[1:]):
                primitive.pop("material", None)
                primitive |= {} if part is None else {"material": part}
            copies[key] = add(document, "meshes", own)
        node["mesh"] = copies[key]
    return failed


def leave_out(document: Document, names: Collection[str]) -> None:
    """Takes the surfaces of these materials away, and meshes of which nothing is left from their nodes."""
    numbers = {number for number, material in enumerate(document.get("materials", [])) if material.get("name") in names}
    empty = set()
    for number, mesh in enumerate(document.get("meshes", [])):
        left = [primitive for primitive in mesh["primitives"] if primitive.get("material") not in numbers]
        if left:
            mesh["primitives"] = left
        else:
            empty.add(number)
    for node in document.get("nodes", []):
        if node.get("mesh") in empty:
            del node["mesh"]


def strip(document: Document, bare: Collection[str], dark: Collection[str]) -> None:
    """Takes the surface of some materials away and the light of some: what is shown is another shader."""
    for material in named(document, bare):
        for key in ("pbrMetallicRoughness", "normalTexture", "occlusionTexture", "alphaMode", "alphaCutoff"):
            material.pop(key, None)
        material["extensions"] = {key: value for key, value in material.get("extensions", {}).items() if key == STRENGTH}
    for material in named(document, dark):
        for key in ("emissiveFactor", "emissiveTexture"):
            material.pop(key, None)
        material.get("extensions", {}).pop(STRENGTH, None)


def shine_both_ways(document: Document) -> None:
    """Makes all materials double-sided: Cycles does not look at Backface Culling, and glTF's single sides emit from one."""
    for material in document.get("materials", []):
        material["doubleSided"] = True


def remove_bumps(document: Document, names: Collection[str]) -> None:
    """Takes maps of normals away that are images of heights."""
    for material in named(document, names):
        material.pop("normalTexture", None)
        material.get("extensions", {}).get("KHR_materials_clearcoat", {}).pop("clearcoatNormalTexture", None)


def blend(document: Document, names: Collection[str], alphas: Mapping[str, float]) -> None:
    """Makes the alpha of materials coverage, which the exporter drops or cuts as Eevee does, and multiplies it."""
    for material in named(document, names):
        material["alphaMode"] = "BLEND"
        material.pop("alphaCutoff", None)
        factor = alphas.get(material["name"], 1.0)
        if factor != 1.0:
            surface = material.setdefault("pbrMetallicRoughness", {})
            color = surface.get("baseColorFactor", [1.0] * 4)
            surface["baseColorFactor"] = [*color[:3], color[3] * factor]


def add_textures(document: Document, binary: bytes, textures: Mapping[str, Texture],
                 image_bytes: Callable[[Any, bool], tuple[bytes, str]], uv_set: Callable[[str, str], int]) -> bytes:
    """Gives materials images as base colours, where the exporter has no image, or where the image's alpha counts or
    darkens its colours."""
    data = bytearray(binary)
    # An image, with whether its alpha darkens it, and its number; different images may have equal names.
    sources: list[tuple[tuple[Any, bool], int]] = []
    for name, texture in textures.items():
        for material in named(document, {name}):
            surface = material.setdefault("pbrMetallicRoughness", {})
            given = copy.deepcopy(surface.get("baseColorTexture"))
            if given is not None and not (texture.with_alpha or texture.times_alpha):
                continue
            wanted = (texture.image, texture.times_alpha)
            source = next((number for other, number in sources if other == wanted), None)
            if source is None:
                content, kind = image_bytes(*wanted)
                if not content:
                    continue
                data += b"\0" * (-len(data) % 4)
                view = {"buffer": 0, "byteOffset": len(data), "byteLength": len(content)}
                data += content
                source = add(document, "images", {"name": texture.image.name, "mimeType": kind,
                                                  "bufferView": add(document, "bufferViews", view)})
                sources.append((wanted, source))
            sampler = index_of(document, "samplers", texture.sampler)
            number = index_of(document, "textures", {"source": source, "sampler": sampler})
            surface["baseColorTexture"] = {**(laid(document, texture, uv_set(name, texture.uv_map)) if given is None else given),
                                           "index": number}
            if texture.with_alpha:
                material["alphaMode"] = "BLEND"
                material.pop("alphaCutoff", None)
    if sources:
        buffers = document.setdefault("buffers", [{}])
        buffers[0]["byteLength"] = len(data)
    return bytes(data)


def laid(document: Document, texture: Texture, uv_set: int) -> Document:
    """What says how a texture lies where a material has it."""
    if texture.transform:
        used = document.setdefault("extensionsUsed", [])
        used += [TRANSFORM] if TRANSFORM not in used else []
    return {**({"texCoord": uv_set} if uv_set else {}),
            **({"extensions": {TRANSFORM: texture.transform}} if texture.transform else {})}


def index_of(document: Document, kind: str, item: Document) -> int:
    """Returns the number of an item of a list of the document, which gets it if it has none like it."""
    items = document.setdefault(kind, [])
    return items.index(item) if item in items else add(document, kind, item)


def add(document: Document, kind: str, item: Document) -> int:
    """Returns the number of an item that is added to a list of the document."""
    document.setdefault(kind, []).append(item)
    return len(document[kind]) - 1
