"""What of a scene's objects and view layer is not brought over, said once each. Needs nothing of Blender."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from .lamps import is_portal

SHOWN = 4  # names in a note
KINDS = {"VOLUME": "volumes", "GPENCIL": "grease pencil", "GREASEPENCIL": "grease pencil", "CURVES": "hair",
         "POINTCLOUD": "clouds of points"}
RAYS = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter", "visible_shadow")
# Kinds of objects that become meshes.
SURFACES = ("MESH", "CURVE", "SURFACE", "FONT", "META")


def notes(items: Iterable[Any], view_layer: Any) -> list[str]:
    """Says what is lost of these objects and of the view layer."""
    items = list(items)
    tests: list[tuple[Callable[[Any], bool], str]] = [
        (lambda item, kind=kind: item.type == kind, f"{name} are not brought over") for kind, name in KINDS.items()]
    tests += [(has_hair, "hair of particles is not brought over"),
              (lambda item: item.type in (*SURFACES, "LIGHT") and not is_portal_lamp(item)
               and not all(getattr(item, name, True) for name in RAYS),
               "of Ray Visibility, only Camera is brought over"),
              (casts_no_shadow, "lamps cast shadows even where they should not"),
              (lambda item: getattr(item, "is_holdout", False) or asks(item, "holdout_get", view_layer),
               "holdouts are not brought over"),
              (lambda item: any(getattr(getattr(item, "light_linking", None), name, None) is not None
                                for name in ("receiver_collection", "blocker_collection")),
               "light linking is not brought over")]
    groups = sorted(group.name for group in getattr(view_layer, "lightgroups", ()))
    said = [f"light groups are not brought over: {listed(groups)}"] if groups else []
    found = ((text, sorted({item.name for item in items if test(item)})) for test, text in tests)
    return said + [f"{text}: {listed(names)}" for text, names in found if names]


def listed(names: list[str]) -> str:
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(f"'{name}'" for name in names[:SHOWN]) + more


def moves_blurred(item: Any) -> bool:
    """Returns whether an object has its Motion Blur on."""
    return getattr(getattr(item, "cycles", None), "use_motion_blur", True)


def asks(item: Any, method: str, view_layer: Any) -> bool:
    """Returns what the collections of an object say for a view layer."""
    original = getattr(item, "original", item)
    return bool(hasattr(original, method) and getattr(original, method)(view_layer=view_layer))


def is_portal_lamp(item: Any) -> bool:
    return item.type == "LIGHT" and is_portal(item.data)


def casts_no_shadow(item: Any) -> bool:
    if item.type != "LIGHT" or is_portal(item.data):
        return False
    # Since Blender 4.2 the switch is the lamp's own, before it is that of Eevee.
    return not (item.data.cycles.cast_shadow if hasattr(getattr(item.data, "cycles", None), "cast_shadow")
                else getattr(item.data, "use_shadow", True))


def has_hair(item: Any) -> bool:
    return any(system.settings.type == "HAIR" and system.settings.render_type == "PATH"
               for system in getattr(item, "particle_systems", ()))


def is_indirect_only(item: Any, view_layer: Any) -> bool:
    """Returns whether collections hide an object from the camera."""
    return asks(item, "indirect_only_get", view_layer)


def shadow_catchers(items: Iterable[Any], integrator: str, say: Callable[[str], None]) -> Iterator[str]:
    """Yields the names of shadow catchers, where the integrator sees them."""
    names = sorted(item.name for item in items if item.type in SURFACES and getattr(item, "is_shadow_catcher", False))
    if names and integrator not in ("path", "direct", "naive", "auto"):
        say(f"shadow catchers are ordinary surfaces to the integrator '{integrator}': {listed(names)}")
        return
    yield from names
