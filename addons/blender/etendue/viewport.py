"""What renders and viewports show differently. Blender's exporter takes what viewports show. Takes objects that look like
Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

# Settings of viewports, and of what is rendered in their place, of whichever kind has both.
MODIFIERS = (("show_viewport", "show_render"), ("levels", "render_levels"), ("steps", "render_steps"),
             ("viewport_resolution", "resolution"))
SIMPLIFY = (("simplify_subdivision", "simplify_subdivision_render"),
            ("simplify_child_particles", "simplify_child_particles_render"))
PARTICLES = (("child_nbr", "rendered_child_count"), ("child_percent", "rendered_child_count"))
RESOLUTIONS = (("resolution_u", "render_resolution_u"), ("resolution_v", "render_resolution_v"))

Change = tuple[Any, str, Any]


def layers_below(layer: Any) -> Iterator[Any]:
    """Yields a layer's collection and all those below it."""
    yield layer
    for child in layer.children:
        yield from layers_below(child)


def pairs(owner: Any, names: Iterable[tuple[str, str]]) -> Iterator[Change]:
    """Yields the changes of those pairs of settings of which the owner has both."""
    for name, rendered in names:
        if hasattr(owner, name) and hasattr(owner, rendered):
            yield owner, name, getattr(owner, rendered)


def differences(scene: Any, view_layer: Any, data: Any) -> Iterator[Change]:
    """Yields the owner, the name and the value of each setting by which viewports show what renders show."""
    for item in data.objects:
        yield item, "hide_viewport", False
        for modifier in item.modifiers:
            yield from pairs(modifier, MODIFIERS)
    for owner in (*data.collections, *layers_below(view_layer.layer_collection)):
        yield owner, "hide_viewport", False
    for curve in data.curves:
        for name, rendered in RESOLUTIONS:
            value = getattr(curve, rendered)
            if value > 0:
                # A text has no splines of its own; a curve would hand its resolution to all of them.
                for owner in curve.splines or [curve]:
                    yield owner, name, value
    for particles in data.particles:
        yield particles, "display_percentage", 100
        yield from pairs(particles, PARTICLES)
    yield from pairs(scene.render, SIMPLIFY)


@contextmanager
def changed(changes: Iterable[Change]) -> Iterator[None]:
    """Gives settings these values while this lasts."""
    kept = []
    try:
        for owner, name, value in changes:
            before = getattr(owner, name)
            if before != value:
                kept.append((owner, name, before))
                setattr(owner, name, value)
        yield
    finally:
        for owner, name, value in reversed(kept):
            setattr(owner, name, value)


def keyed(blocks: Iterable[Any]) -> Iterator[tuple[Any, str]]:
    """Yields the owner and the name of each property of these data-blocks that has keyframes, that of a custom one in
    brackets."""
    for block in blocks:
        action = getattr(getattr(block, "animation_data", None), "action", None)
        for path in {curve.data_path for curve in getattr(action, "fcurves", ())}:
            custom = path.endswith('"]')
            head, _, name = path.rpartition('["' if custom else ".")
            try:
                owner = block.path_resolve(head) if head else block
                found = owner[name[:-2]] if custom else getattr(owner, name)
            except (AttributeError, KeyError, ValueError):
                continue  # what it was for is gone
            if found is not None:
                yield owner, f'["{name}' if custom else name


def value_of(owner: Any, name: str) -> Any:
    value = owner[name[2:-2]] if name.startswith("[") else getattr(owner, name)
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


@contextmanager
def kept(properties: Iterable[tuple[Any, str]]) -> Iterator[None]:
    """Gives properties their values back when this ends: setting a frame undoes what users have changed without a keyframe."""
    before = [(owner, name, value_of(owner, name)) for owner, name in properties]
    try:
        yield
    finally:
        for owner, name, value in before:
            if value_of(owner, name) == value:
                continue
            if name.startswith("["):
                owner[name[2:-2]] = value
            else:
                setattr(owner, name, value)


@contextmanager
def as_rendered(scene: Any, view_layer: Any, data: Any) -> Iterator[None]:
    """Shows in viewports what renders show while this lasts, hidden objects included."""
    with changed(differences(scene, view_layer, data)):
        hidden = [item for item in view_layer.objects if item.hide_get(view_layer=view_layer)]
        for item in hidden:
            item.hide_set(False, view_layer=view_layer)
        try:
            yield
        finally:
            for item in hidden:
                item.hide_set(True, view_layer=view_layer)
