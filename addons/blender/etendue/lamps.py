"""Lamps: the entries of `lights` of render.json. Needs nothing of Blender."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from .nodes import Seen, active_output
from .written import Document, Written

LEAST_SPREAD = math.radians(1.0)
DEFAULT_MAX_BOUNCES = 1024  # bounces of light after which a lamp or a world is still seen, by default


def is_portal(light: Any) -> bool:
    """Returns whether it only guides Cycles' samples of the sky, and emits nothing."""
    return light.type == "AREA" and bool(getattr(getattr(light, "cycles", None), "is_portal", False))


def emission_of_nodes(name: str, light: Any, written: Written) -> tuple[list[float], float]:
    """Colour and strength of the emission of a lamp with nodes, by which its power is multiplied."""
    if not getattr(light, "use_nodes", False) or light.node_tree is None:
        return [1.0, 1.0, 1.0], 1.0
    output = active_output(light.node_tree, "OUTPUT_LIGHT")
    emission = Seen(output).source("Surface") if output is not None else None
    if emission is None:
        return [1.0, 1.0, 1.0], 0.0
    if emission.type != "EMISSION":
        written.note(f"lamp '{name}': its node '{emission.name}' is not brought over: only Emission is")
        return [1.0, 1.0, 1.0], 1.0
    color, strength = emission.value("Color"), emission.value("Strength")
    falloff = emission.source("Strength")
    if falloff is not None and falloff.type == "LIGHT_FALLOFF":
        strength = falloff.value("Strength")
        if falloff.output.name != "Quadratic" or falloff.value("Smooth") != 0.0:
            written.note(f"lamp '{name}': its light falls off with the square of the distance, whatever '{falloff.name}' says")
    for key, value in (("color", color), ("strength", strength)):
        if value is None:
            written.note(f"lamp '{name}': what is linked to the {key} of '{emission.name}' is not brought over")
    return [1.0, 1.0, 1.0] if color is None else color, 1.0 if strength is None else strength


def lamp(item: Any, version: Sequence[int], written: Written) -> Document:
    """An entry of `lights`, for Blender's `version`. The lamp stands at the node with its object's name, which the exporter
    leaves in any case."""
    light = item.data
    tint, strength = emission_of_nodes(item.name, light, written)
    power = light.energy * strength * 2.0 ** getattr(light, "exposure", 0.0)
    color = [a * b for a, b in zip(light.color, tint)]
    if power < 0.0 or min(color) < 0.0:
        written.note(f"lamp '{item.name}': light that is negative is not brought over")
        power, color = max(power, 0.0), [max(channel, 0.0) for channel in color]
    result: Document = {"color": color}
    if light.type == "SUN":
        return result | {"irradiance": power, "angle": min(light.angle, math.pi - 1e-3)}
    if light.type in ("POINT", "SPOT"):
        result["power"] = power
        return result | ({"radius": light.shadow_soft_size, **surface(item)} if light.shadow_soft_size > 0.0 else {})
    # Etendue's area lamps have a radiance of power / (pi area), as Cycles' have; before Blender 4.0, it was power / (4 area).
    result |= {"power": power if tuple(version) >= (4,) else power * 0.25 * math.pi, **surface(item)}
    if light.spread < math.pi:
        result["spread"] = max(light.spread, LEAST_SPREAD)
    if light.shape in ("SQUARE", "RECTANGLE"):
        height = light.size if light.shape == "SQUARE" else light.size_y
        return {"type": "rectangle", "width": light.size, "height": height, **result}
    height = light.size if light.shape == "DISK" else light.size_y
    return {"type": "disk", "width": light.size, "height": height, **result}


def surface(item: Any) -> Document:
    """What lamps with a size are for others. In Cycles they stop no light, and are hidden from the camera by default."""
    return {"stops_light": False, **({} if getattr(item, "visible_camera", False) else {"visible_to_camera": False})}


def spot_cones(light: Any) -> tuple[float, float]:
    """Inner and outer angle of a spot, from its axis. Cycles fades by a smooth step of the cosine between the rim and a
    share `spot_blend` of the way to the axis, glTF by a square: over three quarters of that way it fades to as much light."""
    outer = min(0.5 * light.spot_size, 0.5 * math.pi)
    rim = math.cos(outer)
    inner = math.acos(min(rim + 0.75 * light.spot_blend * (1.0 - rim), 1.0))
    return min(inner, outer * (1.0 - 1e-4)), outer
