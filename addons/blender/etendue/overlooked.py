"""What of a scene's objects and view layer is not brought over, said once each. Takes objects that look like Blender's, and
needs nothing of Blender itself."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

from .identity import Tree
from .lamps import DEFAULT_MAX_BOUNCES, is_portal
from .written import Document

SHOWN = 4  # names in a note
KINDS = {"META": "metaballs", "VOLUME": "volumes", "GPENCIL": "grease pencil", "GREASEPENCIL": "grease pencil", "CURVES": "hair",
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
              (asks_for_viewports, "geometry nodes ask for Is Viewport, which is true in renders too"),
              (casts_no_shadow, "lamps cast shadows even where they should not"),
              (has_max_bounces, "the Max Bounces of lamps are not brought over"),
              (lambda item: any(getattr(getattr(item, "light_linking", None), name, None) is not None
                                for name in ("receiver_collection", "blocker_collection")),
               "light linking is not brought over")]
    return [*said("light groups are not brought over", getattr(view_layer, "lightgroups", ())),
            *said("shader AOVs are not brought over", getattr(view_layer, "aovs", ())),
            *(note for flag, text in (("use_volumes", "volumes"), ("use_solid", "surfaces"))
              if not getattr(view_layer, flag, True)
              for note in said(f"{text} are shown in view layers without them", [view_layer])),
            *(note for test, text in tests for note in said(text, filter(test, items)))]


def lost(scene: Any, document: Document, tree: Tree, rendered: Any, surfaces: Mapping[Any, Any],
         brought: Collection[tuple[Any, Any]]) -> list[str]:
    """Says what is rendered and has nothing in the file. `brought` are the file's pairs of an instancer and what it
    instances."""
    own = {item: document["nodes"][number] for number, item in tree.own().items()}

    def shows(item: Any) -> bool:
        return item.type not in KINDS and (item.type == "LIGHT" or (item in surfaces and surfaces[item].has_faces))

    missing = [item for item in rendered.single & set(scene.objects)
               if shows(item) and (item not in own if item.type == "LIGHT" else "mesh" not in own.get(item, {}))]
    # A curve is an instance of its own mesh, too.
    instances: dict[Any, list[Any]] = {}
    for instancer, item in rendered.instanced:
        if instancer != item and shows(item) and (instancer, item) not in brought:
            instances.setdefault(instancer, []).append(item)
    sets = [scene.background_set] if scene.background_set is not None else []
    return [*said("Blender's exporter leaves objects out", missing),
            *said("instances of meshes that geometry nodes make are not brought over",
                  [instance.instancer for instance in rendered.scattered if instance.source is None]),
            *(note for instancer, items in instances.items()
              for note in said(f"instances by '{instancer.name}' are not brought over", items)),
            *said("background sets are not brought over", sets)]


def said(text: str, blocks: Iterable[Any]) -> list[str]:
    """Returns a note with the names of the data-blocks, none where there are no data-blocks."""
    names = sorted({block.name for block in blocks})
    return [f"{text}: {listed(names)}"] if names else []


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


def has_max_bounces(item: Any) -> bool:
    """Returns whether a lamp is not seen after some bounces of light."""
    settings = getattr(item.data, "cycles", None)
    return item.type == "LIGHT" and getattr(settings, "max_bounces", DEFAULT_MAX_BOUNCES) < DEFAULT_MAX_BOUNCES


def has_hair(item: Any) -> bool:
    return any(system.settings.type == "HAIR" and system.settings.render_type == "PATH"
               for system in getattr(item, "particle_systems", ()))


def asks_for_viewports(item: Any) -> bool:
    """Returns whether geometry nodes of the object have Is Viewport, be it in groups."""
    waiting = [modifier.node_group for modifier in getattr(item, "modifiers", ()) if modifier.type == "NODES"]
    for group in waiting:
        for node in group.nodes if group is not None else ():
            if getattr(node, "bl_idname", "") == "GeometryNodeIsViewport":
                return True
            inner = getattr(node, "node_tree", None)
            waiting += [inner] if inner is not None and inner not in waiting else []
    return False


def is_hidden(item: Any, view_layer: Any) -> bool:
    """Returns whether the object itself or its collections hide a surface from the camera."""
    return item.type in SURFACES and (not getattr(item, "visible_camera", True) or asks(item, "indirect_only_get", view_layer))


def is_holdout(item: Any, view_layer: Any) -> bool:
    """Returns whether the object itself or its collections cut a hole into the image."""
    return item.type in SURFACES and (getattr(item, "is_holdout", False) or asks(item, "holdout_get", view_layer))


def is_shadow_catcher(item: Any) -> bool:
    return item.type in SURFACES and getattr(item, "is_shadow_catcher", False)


def replaced(items: Iterable[Any], view_layer: Any, integrator: str, say: Callable[[str], None]) -> list[Any]:
    """Returns the holdouts and the shadow catchers, none where the integrator has no alpha."""
    found = [item for item in items if is_holdout(item, view_layer) or is_shadow_catcher(item)]
    if integrator != "light":
        return found
    for text in said("holdouts and shadow catchers are ordinary surfaces to the integrator 'light'", found):
        say(text)
    return []
