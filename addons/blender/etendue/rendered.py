"""What of a scene is rendered. Takes objects that look like Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from .identity import uses_nodes
from .surfaces import is_copy


@dataclass
class Scattered:
    """An instance that geometry nodes make: whose they are, the object whose mesh it has, None for a mesh of their own, and
    where it stands."""

    instancer: Any
    source: Any
    matrix: Any


@dataclass
class Rendered:
    """What is rendered: the evaluated objects by their originals; those that stand in the view layer themselves; how often
    each pair of an instancer and what it instances is there; and instances of geometry nodes."""

    items: dict[Any, Any] = field(default_factory=dict)
    single: set[Any] = field(default_factory=set)
    instanced: Counter[tuple[Any, Any]] = field(default_factory=Counter)
    scattered: list[Scattered] = field(default_factory=list)


def source_of(mesh: Any, depsgraph: Any, objects: Iterable[Any]) -> Any:
    """Returns the object that a mesh of geometry nodes is a copy of, or None."""
    evaluated = ((item, item.evaluated_get(depsgraph)) for item in objects if item.type == "MESH")
    return next((item for item, other in evaluated if is_copy(mesh, other.data)), None)


def rendered_objects(depsgraph: Any, objects: Iterable[Any]) -> Rendered:
    """Finds what is rendered; `objects` are all that the sources of instances may be."""
    result = Rendered()
    sources: dict[int, Any] = {}
    for instance in depsgraph.object_instances:
        if not instance.show_self:
            continue
        item = instance.instance_object if instance.is_instance else instance.object
        if item is None:
            continue
        original = item.original
        result.items[original] = original.evaluated_get(depsgraph)
        if not instance.is_instance:
            result.single.add(original)
            continue
        instancer = instance.parent.original
        if instancer.is_instancer or not uses_nodes(instancer) or instance.object.type != "MESH":
            result.instanced[instancer, original] += 1
            continue
        source = original
        if instancer == original:
            mesh = instance.object.data
            key = mesh.as_pointer()
            if key not in sources:
                sources[key] = source_of(mesh, depsgraph, objects)
            source = sources[key]
            if source is not None:
                result.items[source] = source.evaluated_get(depsgraph)
        else:
            result.instanced[instancer, original] += 1
        result.scattered.append(Scattered(instancer, source, instance.matrix_world.copy()))
    return result
