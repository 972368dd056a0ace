"""The meshes that objects are rendered as. Takes objects that look like Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy

from .overlooked import SURFACES


def numbers_of(items: Any, name: str, kind: Any, width: int = 1) -> numpy.ndarray:
    """Returns a property of all items of a collection, a row for each if it has several numbers."""
    values = numpy.empty(len(items) * width, kind)
    items.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def is_closed(mesh: Any) -> bool:
    """Returns whether every edge is between two faces, or lies where another edge of one face does: texts and curves have
    seams."""
    if len(mesh.polygons) == 0:
        return False
    uses = numpy.bincount(numbers_of(mesh.loops, "edge_index", numpy.int32), minlength=len(mesh.edges))
    if numpy.any((uses != 1) & (uses != 2)):
        return False
    seams = numpy.flatnonzero(uses == 1)
    if len(seams) == 0:
        return True
    ends = numbers_of(mesh.edges, "vertices", numpy.int32, 2)[seams]
    places = numbers_of(mesh.vertices, "co", numpy.float32, 3).astype(numpy.float64)
    step = 1e-5 * max(float(numpy.ptp(places, axis=0).max()), 1e-30)
    _, welded = numpy.unique(numpy.rint(places[ends.ravel()] / step), axis=0, return_inverse=True)
    welded = numpy.sort(welded.reshape(-1, 2), axis=1)
    welded = welded[welded[:, 0] != welded[:, 1]]
    return bool(numpy.all(numpy.unique(welded, axis=0, return_counts=True)[1] % 2 == 0))


@dataclass
class Surface:
    """Describes the mesh that an object is rendered as: whether it bounds a volume, and which materials its faces have,
    in the order of their slots; None is for no material."""

    closed: bool
    parts: list[Any]

    @property
    def has_faces(self) -> bool:
        """Returns whether the mesh has faces."""
        return bool(self.parts)


def is_copy(mesh: Any, of: Any) -> bool:
    """Returns whether a mesh of geometry nodes is that of an object, untouched."""
    return (mesh.name_full == of.name_full and len(mesh.vertices) == len(of.vertices) and len(mesh.polygons) == len(of.polygons)
            and materials_in(mesh) == materials_in(of)
            and numpy.array_equal(*(numbers_of(one.vertices, "co", numpy.float32, 3) for one in (mesh, of))))


def materials_in(mesh: Any) -> set[Any]:
    """Returns the materials that faces of the mesh have."""
    numbers = numpy.unique(numbers_of(mesh.polygons, "material_index", numpy.int32))
    used = [mesh.materials[number] for number in numbers if number < len(mesh.materials)]
    return {material.original for material in used if material is not None}


def parts_of(item: Any, mesh: Any) -> list[Any]:
    """Returns the material of each slot of the evaluated object that faces of its mesh use; faces with a number beyond
    the last slot use the last."""
    slots = [slot.material and slot.material.original for slot in item.material_slots]
    numbers = numpy.unique(numbers_of(mesh.polygons, "material_index", numpy.int32))
    return [slots[min(int(number), len(slots) - 1)] if slots else None for number in numbers]


def surfaces_of(items: dict[Any, Any]) -> dict[Any, Surface]:
    """Looks at the mesh of each object that has one, by its original."""
    found = {}
    for original, item in items.items():
        if item.type not in SURFACES:
            continue
        mesh = item.data if item.type == "MESH" else item.to_mesh()
        if mesh is not None:
            found[original] = Surface(is_closed(mesh), parts_of(item, mesh))
        if item.type != "MESH":
            item.to_mesh_clear()
    return found


def materials_of(items: dict[Any, Any], surfaces: dict[Any, Surface], override: Any = None) -> list[tuple[Any, bool]]:
    """Each material that is used, with whether all meshes that have it are closed: that which overrides all others, if any."""
    if override is not None:
        return [(override, all(surface.closed for surface in surfaces.values() if surface.has_faces))]
    found: dict[Any, bool] = {}
    for original, surface in surfaces.items():
        for slot in items[original].material_slots:
            if slot.material is None:
                continue
            material = slot.material.original
            found[material] = found.get(material, True) and surface.closed
    return list(found.items())
