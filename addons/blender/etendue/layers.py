"""The UV maps and the colour attributes of meshes that materials ask for. Takes objects that look like Blender's, and
needs nothing of Blender itself."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Any

from .overlooked import said
from .textures import all_behind, laid
from .vertex_colors import attributes_at
from .written import Written

Users = list[tuple[set[Any], Any]]  # for each object with a mesh: the names of its materials, and the object


def users(items: Iterable[Any], names: dict[Any, str], override: Any) -> Users:
    """Returns, for each of the objects that is a mesh, the names of its materials, and the object."""
    return [({names.get(material.original) for slot in item.material_slots if (material := override or slot.material)},
             item) for item in items if item.type == "MESH"]


def uv_sets(meshes: Users, written: Written) -> Callable[[str, str], int]:
    """Returns a function from the names of a material and of a UV map to the number of that map on the meshes with the
    material; an empty name is for the map that is rendered."""
    def number(material: str, uv_map: str) -> int:
        found = {index for used, item in meshes if material in used for index, layer in enumerate(item.data.uv_layers)
                 if (layer.name == uv_map if uv_map else layer.active_render)}
        if len(found) > 1:
            written.note(f"material '{material}': on some meshes, another UV map than its own lays its image")
        return min(found, default=0)

    return number


def uv_maps_behind(shaders: Iterable[Any]) -> Iterator[str]:
    """Yields the names of the UV maps that lay images of shaders, and of those whose tangents turn their normals."""
    for shader in shaders:
        if shader.type in ("MIX_SHADER", "ADD_SHADER"):
            continue
        for seen in all_behind(shader):
            if seen.type == "TEX_IMAGE":
                yield laid(seen, False).uv_map
            elif seen.type == "NORMAL_MAP":
                yield getattr(seen.node, "uv_map", "")


def missing(meshes: Users, written: Written) -> Iterator[str]:
    """Says where meshes lack a UV map or a colour attribute that one of their materials names."""
    def lacking(material: str, there: Callable[[Any], Collection[str]], name: str) -> list[Any]:
        return [item for used, item in meshes if material in used and name not in there(item.data)]

    for material, shaders in written.shown.items():
        for name in sorted(set(uv_maps_behind(shaders)) - {""}):
            yield from said(f"material '{material}': there is no UV map '{name}', and another is in its place",
                            lacking(material, lambda mesh: [layer.name for layer in mesh.uv_layers], name))
        for name in sorted(set(sum(attributes_at(shaders), [])) - {""}):
            yield from said(f"material '{material}': there is no colour attribute '{name}', and another or none shows",
                            lacking(material, lambda mesh: [layer.name for layer in mesh.color_attributes], name))


def tangents(written: Written, uv_set: Callable[[str, str], int]) -> Iterator[str]:
    """Says where a normal map is for the tangents of another UV map than the one that lays its image: glTF has no such
    maps."""
    for material, (image, tangent) in written.tangents.items():
        if uv_set(material, image) != uv_set(material, tangent):
            yield f"material '{material}': the tangents of its normal map are those of the UV map that lays it"
