"""How images lie, and what Blender's exporter does not bring over of the nodes before a shader's inputs. Needs nothing of
Blender."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from typing import Any

from .nodes import Seen, behind, place
from .written import Document, Texture

# Nodes that the exporter reads, or of which others tell.
READ = ("TEX_IMAGE", "UVMAP", "NORMAL_MAP", "SEPARATE_COLOR", "SEPRGB", "VERTEX_COLOR", "ATTRIBUTE", "BUMP", "MAPPING", "TEX_COORD",
        "NORMAL", "GROUP_INPUT")
SHADERS = ("BSDF_", "MIX_SHADER", "ADD_SHADER", "EMISSION", "SUBSURFACE_SCATTERING", "HOLDOUT", "BACKGROUND", "EEVEE_")
SOURCES = {"SEQUENCE": "a sequence", "MOVIE": "a movie"}
# glTF's numbers for what happens beyond the edges of an image and between its pixels.
WRAPS = {"EXTEND": 33071, "CLIP": 33071, "MIRROR": 33648, "REPEAT": 10497}
LINEAR_FILTERS, CLOSEST_FILTERS = {"magFilter": 9729, "minFilter": 9987}, {"magFilter": 9728, "minFilter": 9984}
COLORS = ("Base Color", "Color", "Emission", "Emission Color", "Subsurface Color")  # inputs that are colours, not data
FACTORS = ("Metallic", "Roughness")  # inputs of which the exporter reads an image times a constant
LINEAR = ("Linear", "Linear Rec.709", "Non-Color", "Raw")  # spaces whose pixels are taken as they are


def notes(shader: Seen, own: Texture | None, exported: Collection[tuple[str, ...]] = ()) -> Iterator[str]:
    """Says what is lost of all that leads to a shader: nodes that change colours, and images that lie otherwise. `own` is
    the image that the add-on itself puts into the file, `exported` the places of shaders that the exporter reads."""
    unread: list[str] = []
    nodes = list(all_behind(shader))
    products = {place(source) for seen in nodes if place(seen) in exported
                for name, source in seen.sources() if is_product(name, source)}
    for seen in nodes:
        if seen.type == "TEX_IMAGE":
            yield from notes_of_image(seen)
        elif not (seen.type.startswith(SHADERS) or seen.type in READ or place(seen) in products
                  or seen.constant() is not None or seen.name in unread):
            unread.append(seen.name)
    for seen in nodes:
        if seen.type.startswith(SHADERS) and seen.type not in ("MIX_SHADER", "ADD_SHADER"):
            yield from notes_of_spaces(seen, own)
    if unread:
        yield f"nodes that are not brought over: {', '.join(repr(name) for name in unread)}"


def is_product(name: str, seen: Seen) -> bool:
    """Returns whether what is linked to an input of this name is an image times a constant, which the exporter makes a
    factor."""
    if name in COLORS and seen.type == "MIX":
        node = seen.node
        if node.data_type != "RGBA" or node.blend_type != "MULTIPLY" or seen.value(0) != 1.0:
            return False
        parts = [seen.socket(at) for at in (6, 7)]  # A and B of colours
    elif name in FACTORS and seen.type == "MATH" and seen.node.operation == "MULTIPLY":
        parts = [seen.socket(at) for at in (0, 1)]
    else:
        return False
    sources = [seen.source_of(part) for part in parts]
    return any(one is not None and one.type == "TEX_IMAGE" and (other is None or other.type in ("RGB", "VALUE"))
               for one, other in (sources, sources[::-1]))


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
    if not node.image.is_float and getattr(node.image, "alpha_mode", "") == "PREMUL":
        yield f"the image '{name}' is taken to have straight alpha, not premultiplied"
    if node.projection != "FLAT":
        yield f"the image '{name}' is laid by {node.projection.lower()} projection, which is not brought over"
    if node.extension == "CLIP":
        yield f"the image '{name}' goes on at its edges, and is not clipped"
    coordinates = texture.source("Vector")
    if coordinates is not None and coordinates.type == "MAPPING":
        if transform(coordinates) is None:
            yield f"'{coordinates.name}' before the image '{name}' is not brought over: only constants in its plane are"
        coordinates = coordinates.source("Vector")
    if coordinates is None or coordinates.type == "UVMAP":
        return
    if coordinates.type != "TEX_COORD":
        yield f"'{coordinates.name}' before the image '{name}' is not brought over: only UV maps are"
    elif coordinates.output.name != "UV":
        yield f"the image '{name}' is laid by UV maps, not by {coordinates.output.name} coordinates"


def notes_of_spaces(shader: Seen, own: Texture | None) -> Iterator[str]:
    """Says which images of a shader are of other colour spaces than glTF has: sRGB for colours, and none for data."""
    for name, source in shader.sources():
        texture = behind(source, "TEX_IMAGE") if source.type != "BUMP" else None
        image = texture.node.image if texture is not None else None
        if image is None or image.is_float or texture.output.name == "Alpha":
            continue
        space = image.colorspace_settings.name
        if own is not None and image == own.image and space in LINEAR:
            continue  # it becomes sRGB
        if name in COLORS and space != "sRGB":
            yield f"the image '{image.name}' is taken to be of sRGB, not of {space}"
        elif name not in COLORS and space not in LINEAR:
            yield f"the image '{image.name}' at '{name}' is taken to be data, not of {space}"


def laid(texture: Seen, with_alpha: bool) -> Texture:
    """Returns the image of a texture and how it lies."""
    node, coordinates, moved = texture.node, texture.source("Vector"), {}
    if coordinates is not None and coordinates.type == "MAPPING":
        moved, coordinates = transform(coordinates) or {}, coordinates.source("Vector")
    uv_map = coordinates.node.uv_map if coordinates is not None and coordinates.type == "UVMAP" else ""
    wrap, closest = WRAPS.get(node.extension, WRAPS["REPEAT"]), getattr(node, "interpolation", "Linear") == "Closest"
    sampler = {"wrapS": wrap, "wrapT": wrap, **(CLOSEST_FILTERS if closest else LINEAR_FILTERS)}
    return Texture(node.image, with_alpha, not with_alpha and is_darkened(texture), uv_map, moved, sampler)


def is_darkened(texture: Seen) -> bool:
    """Returns whether the alpha of an image darkens its colours: in Cycles it does unless something is linked to it."""
    image, alpha = texture.node.image, texture.node.outputs.get("Alpha")
    has_alpha = getattr(image, "alpha_mode", "NONE") == "STRAIGHT" and getattr(image, "depth", 0) == 32
    return has_alpha and not image.is_float and not (alpha is not None and alpha.is_linked)


def has_no_alpha(source: Seen | None) -> bool:
    """Returns whether what is linked to an input is the alpha of an image that is told to have none, which is 1."""
    return (source is not None and source.type == "TEX_IMAGE" and source.output.name == "Alpha"
            and getattr(source.node.image, "alpha_mode", "") == "NONE")


def transform(mapping: Seen) -> Document | None:
    """Returns KHR_texture_transform for a Mapping node, None where it has none: there v runs down, and a Mapping scales,
    turns and moves, or undoes that where it is of textures."""
    place, turn, scale = (mapping.value(name) for name in ("Location", "Rotation", "Scale"))
    kind = mapping.node.vector_type
    if kind == "VECTOR":
        place = [0.0] * 3
    if None in (place, turn, scale) or kind == "NORMAL" or any(abs(angle) > 1e-6 for angle in turn[:2]):
        return None
    (x, y), angle, (width, height) = place[:2], turn[2], scale[:2]
    if kind == "TEXTURE":
        if width == 0.0 or height == 0.0 or (abs(angle) > 1e-6 and abs(width - height) > 1e-6):
            return None
        angle, width, height = -angle, 1.0 / width, 1.0 / height
        x, y = width * (math.sin(angle) * y - math.cos(angle) * x), -height * (math.sin(angle) * x + math.cos(angle) * y)
    sine, cosine = math.sin(angle), math.cos(angle)
    return {"offset": [x - height * sine, 1.0 - y - height * cosine], "rotation": angle, "scale": [width, height]}
