"""Worlds: the entries `environment` and `mist` of render.json. Needs nothing of Blender."""

from __future__ import annotations

import math
from typing import Any

from .lamps import DEFAULT_MAX_BOUNCES
from .nodes import Seen, active_output, behind
from .written import Document, Written

HALF_PI = 0.5 * math.pi
BLACK = [0.0, 0.0, 0.0]


def environment(world: Any, transparent: bool, written: Written) -> Document | None:
    """The entry `environment`; its image is put into `written`."""
    if world is None:
        return None
    visible = not transparent and world_is_visible(world)
    if hides_from_rays(world):
        written.note("of the world's Ray Visibility, only Camera is brought over")
    if getattr(getattr(world, "cycles", None), "max_bounces", DEFAULT_MAX_BOUNCES) < DEFAULT_MAX_BOUNCES:
        written.note("the Max Bounces of the world are not brought over")
    result: Document = {} if visible else {"visible_to_camera": False}
    if not world.use_nodes or world.node_tree is None:
        return result | {"color": list(world.color)[:3]}
    output = active_output(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return None
    if Seen(output).source("Volume") is not None:
        written.note("the volume of the world is not brought over")
    background = lighting(Seen(output).source("Surface"), written)
    if background is None:
        return None
    result["scale"] = background.value("Strength")
    if result["scale"] is None:
        written.note("what is linked to the strength of the world is not brought over")
        result["scale"] = 1.0
    return result | colored(background, written)


def lighting(shader: Seen | None, written: Written) -> Seen | None:
    """Returns the Background of the branch that lights the scene, None if none does."""
    if shader is None or shader.type in ("BACKGROUND", "EMISSION"):
        return shader
    if shader.type not in ("MIX_SHADER", "ADD_SHADER"):
        written.note(f"the world's node '{shader.name}' is not brought over: only Background is")
        return None
    mixes = shader.type == "MIX_SHADER"
    branches = [shader.source(index) for index in ((1, 2) if mixes else (0, 1))]
    share = shader.value(0) if mixes else None
    factor = shader.source(0) if mixes else None
    if share is not None and (share <= 0.0 or share >= 1.0):
        return lighting(branches[int(share >= 1.0)], written)
    if factor is not None and factor.type == "LIGHT_PATH":
        # What is no ray of the camera has the first branch; of other kinds of rays nothing tells which light more.
        chosen = branches[0]
    elif share is not None:
        chosen = branches[int(share > 0.5)]
    else:
        chosen = next((branch for branch in branches if behind(branch, "TEX_ENVIRONMENT") is not None), branches[0])
    chosen = chosen or branches[0] or branches[1]
    if chosen is not None:
        written.note(f"of the world's node '{shader.name}', only '{chosen.name}' is brought over")
    return lighting(chosen, written)


def colored(background: Seen, written: Written) -> Document:
    """Returns the colour of a Background or its image."""
    color = background.value("Color")
    if color is not None:
        return {"color": [max(channel, 0.0) for channel in color]}
    source = background.source("Color")
    texture = behind(source, "TEX_ENVIRONMENT")
    if texture is not None and texture.node.image is not None and texture.node.projection == "EQUIRECTANGULAR":
        if texture.node is not source.node:
            written.note(f"the world's node '{source.name}' is not brought over, but the image behind it is")
        written.world_image = texture.node.image
        return {"image": "world.exr", "rotation": -HALF_PI - turn(texture, written)}
    color = constant_behind(source)
    if color is not None:
        written.note(f"the world's node '{source.name}' is not brought over, but the colour behind it is")
        return {"color": color}
    name = (texture or source or background).name
    written.note(f"the world's node '{name}' is not brought over: only colours and equirectangular images are")
    return {"color": BLACK}


def constant_behind(seen: Seen | None) -> list[float] | None:
    """Returns the first colour that is not black of the inputs of the node and of those behind it."""
    if seen is None:
        return None
    for socket in seen.node.inputs:
        if socket.name in ("Color", "Color1", "Color2", "A", "B") and hasattr(socket.default_value, "__len__"):
            color = seen.value_of(socket)
            found = constant_behind(seen.source_of(socket)) if color is None else [max(channel, 0.0) for channel in color]
            if found is not None and any(found):
                return found
    return None


def world_is_visible(world: Any) -> bool:
    """Returns whether the camera sees it: Blender has the switch in one place or the other."""
    if hasattr(world, "visible_camera"):
        return world.visible_camera
    return getattr(getattr(world, "cycles_visibility", None), "camera", True)


def hides_from_rays(world: Any) -> bool:
    """Returns whether the world is hidden from some kind of rays other than the camera's."""
    flags = getattr(world, "cycles_visibility", None)
    return not all(getattr(flags, name, True) for name in ("diffuse", "glossy", "transmission", "scatter"))


def mist(settings: Any) -> Document:
    return {"start": settings.start, "depth": max(settings.depth, 1e-6),
            "falloff": settings.falloff.lower().replace("_", "-")}


def turn(texture: Seen, written: Written) -> float:
    """Rotation about Z of the Mapping node before the texture."""
    mapping = texture.source("Vector")
    if mapping is None or mapping.type == "TEX_COORD":
        return 0.0
    if mapping.type != "MAPPING":
        written.note(f"the world's node '{mapping.name}' is not brought over: only Mapping is")
        return 0.0
    rotation, scale = mapping.value("Rotation"), mapping.value("Scale", default=[1.0, 1.0, 1.0])
    place = mapping.value("Location", default=[0.0, 0.0, 0.0])
    if rotation is None:
        written.note("what is linked to the rotation of the world is not brought over")
        return 0.0
    if any(abs(angle) > 1e-6 for angle in rotation[:2]):
        written.note("of the rotation of the world, only that about Z is brought over")
    if scale is None or scale[0] <= 0.0 or max(scale) - min(scale) > 1e-6 or place is None or any(place):
        written.note("the scale and the location of the world's Mapping are not brought over, nor is it mirrored")
    return -rotation[2] if mapping.node.vector_type == "TEXTURE" else rotation[2]
