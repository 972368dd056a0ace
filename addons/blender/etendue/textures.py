"""What Blender's exporter does not bring over of the nodes before a shader's inputs. Needs nothing of Blender."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .nodes import Seen, place

# Nodes that the exporter reads, or of which others tell.
READ = ("TEX_IMAGE", "UVMAP", "NORMAL_MAP", "SEPARATE_COLOR", "SEPRGB", "VERTEX_COLOR", "ATTRIBUTE", "BUMP", "MAPPING", "TEX_COORD",
        "NORMAL", "GROUP_INPUT")
SHADERS = ("BSDF_", "MIX_SHADER", "ADD_SHADER", "EMISSION", "SUBSURFACE_SCATTERING", "HOLDOUT", "BACKGROUND", "EEVEE_")
SOURCES = {"SEQUENCE": "a sequence", "MOVIE": "a movie"}


def notes(shader: Seen) -> Iterator[str]:
    """Says what is lost of all that leads to a shader: nodes that change colours, and images that lie otherwise."""
    unread: list[str] = []
    for seen in all_behind(shader):
        if seen.type == "TEX_IMAGE":
            yield from notes_of_image(seen)
        elif not seen.type.startswith(SHADERS) and seen.type not in READ and seen.constant() is None and seen.name not in unread:
            unread.append(seen.name)
    if unread:
        yield f"nodes that are not brought over: {', '.join(repr(name) for name in unread)}"


def all_behind(shader: Seen) -> Iterator[Seen]:
    """Yields each node that leads to a shader once; what shifts images and bumps is no part of that."""
    waiting, known = [shader], set()
    while waiting:
        seen = waiting.pop(0)
        if place(seen) in known:
            continue
        known.add(place(seen))
        yield seen
        if seen.type not in ("TEX_IMAGE", "BUMP", "LIGHT_PATH") and not (seen is not shader and seen.constant() is not None):
            waiting += [source for _, source in seen.sources()]


def notes_of_image(texture: Seen) -> Iterator[str]:
    node: Any = texture.node
    if node.image is not None and node.image.source in SOURCES:
        yield f"the image '{node.image.name}' is {SOURCES[node.image.source]}, which is not brought over"
    elif node.image is None or tuple(node.image.size) == (0, 0):
        yield f"the image of '{texture.name}' is missing"
        return
    name = node.image.name
    if node.projection != "FLAT":
        yield f"the image '{name}' is laid by {node.projection.lower()} projection, which is not brought over"
    if node.extension == "CLIP":
        yield f"the image '{name}' is repeated, not clipped"
    coordinates = texture.source("Vector")
    while coordinates is not None and coordinates.type == "MAPPING":
        coordinates = coordinates.source("Vector")
    if coordinates is None or coordinates.type == "UVMAP":
        return
    if coordinates.type != "TEX_COORD":
        yield f"'{coordinates.name}' before the image '{name}' is not brought over: only UV maps are"
    elif coordinates.output.name != "UV":
        yield f"the image '{name}' is laid by UV maps, not by {coordinates.output.name} coordinates"
