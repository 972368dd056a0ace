"""Which materials have vertex colours in them: the exporter writes them for all meshes, and glTF multiplies by them. Takes
objects that look like Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from .nodes import VERTICES, Seen, active_output
from .textures import all_behind

COLORS, ALPHAS = ("Base Color", "Color"), ("Alpha",)


def attributes_before(shaders: Iterable[Seen], names: Iterable[str]) -> list[str]:
    """Returns the attributes that lead to inputs with these names, an empty name for a mesh's own choice."""
    sources = [source for shader in shaders for name in names if (source := shader.source(name)) is not None]
    found = [seen.node for source in sources for seen in all_behind(source) if seen.type in VERTICES]
    return [node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name for node in found]


def attributes_of(material: Any) -> tuple[list[str], list[str]]:
    """Returns the attributes that lead to the colour of the material, and those that lead to its alpha."""
    if not material.use_nodes or material.node_tree is None:
        return [], []
    output = active_output(material.node_tree, "OUTPUT_MATERIAL")
    surface = Seen(output).source("Surface") if output is not None else None
    return attributes_at(all_behind(surface)) if surface is not None else ([], [])


def attributes_at(shaders: Iterable[Seen]) -> tuple[list[str], list[str]]:
    """Returns those of shaders."""
    lit = [seen for seen in shaders if seen.type.startswith("BSDF_") or seen.type == "SUBSURFACE_SCATTERING"]
    return attributes_before(lit, COLORS), attributes_before(lit, ALPHAS)


def chosen(mesh: Any) -> int | None:
    """Returns the number of the colour attribute that the mesh's materials name, None where they leave it to the mesh."""
    names = [name for material in mesh.materials if material is not None for name in sum(attributes_of(material), [])]
    numbers = {attribute.name: number for number, attribute in enumerate(mesh.color_attributes)}
    return next((numbers[name] for name in names if name in numbers), None)


def choices(meshes: Iterable[Any]) -> Iterator[tuple[Any, str, int]]:
    """Yields the owner, the name and the value of each setting by which the exporter writes those attributes."""
    for mesh in meshes:
        if len(mesh.color_attributes) > 1:
            number = chosen(mesh)
            if number is not None:
                yield mesh.color_attributes, "render_color_index", number
