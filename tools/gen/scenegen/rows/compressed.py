"""A row of what comes compressed, and the same uncompressed in front of it."""

import math
import struct
from array import array

from ..encoder import encode
from ..gltf import BYTE, FLOAT, SHORT, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT
from ..images import webp
from ..mesh import mapped_sphere
from ..patterns import checker
from ..vector import add, normalize
from . import textures
from .stage import LOWER, RADIUS, UPPER, Stage

DRACO, MESHOPT, WEBP = "KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_texture_webp"


def compressed():
    """Draco with texture coordinates and with colours, meshopt's filters, instances turned by compressed rotations,
    WebP."""
    stage = Stage()
    gltf = stage.scene.gltf
    ball = _leaning_ball()
    bands = stage.texture("bands", textures.color_bands())
    banded = gltf.add_material("banded", roughness=0.5, base_color_texture=bands)
    painted = gltf.add_material("painted", roughness=0.5)
    by_webp = gltf.add_material("webp", roughness=0.5, base_color_texture=_webp_texture(stage))
    plain = _plain_attributes(gltf, ball)
    mapped = {name: plain[name] for name in ("POSITION", "NORMAL", "TEXCOORD_0")}
    colored = {name: plain[name] for name in ("POSITION", "NORMAL", "COLOR_0")}

    def add(row, column, name, attributes, material, **further):
        place = stage.place(row, column, RADIUS + 0.01)
        return stage.add_primitive(name, ball, attributes, material, place, **further)

    _add_draco(gltf, ball, add, 0, "draco", mapped, banded)
    _add_draco(gltf, ball, add, 1, "draco colors", colored, painted)
    attributes, indices = _filtered(gltf, ball)
    add(UPPER, 2, "meshopt", attributes, banded, indices=indices)
    add(UPPER, 3, "meshopt instances", mapped, painted, indices=_sequence(gltf, ball),
        extensions=_instances(gltf, _compressed_rotations))
    add(UPPER, 4, "webp", mapped, by_webp)
    add(LOWER, 0, "plain", mapped, banded)
    add(LOWER, 1, "plain colors", colored, painted)
    add(LOWER, 2, "plain again", mapped, banded)
    add(LOWER, 3, "plain instances", mapped, painted, extensions=_instances(gltf, _plain_rotations))
    add(LOWER, 4, "png", mapped, banded)
    return stage.finish()


def _leaning_ball():
    """A sphere whose normals lean to the right, away from the lamp: without them it would be brighter."""
    ball = mapped_sphere(RADIUS, columns=48, rows=24)
    for i in range(0, len(ball.normals), 3):
        x, y, z = ball.normals[i:i + 3]
        ball.normals[i:i + 3] = array("f", normalize(add((x, y, z), (0.5, 0.0, 0.0))))
        ball.colors.extend((*(round(255.0 * (0.5 + 0.5 * c)) for c in (x, y, z)), 255))
    return ball


def _plain_attributes(gltf, ball):
    return {"POSITION": gltf.add_accessor(ball.positions, FLOAT, "VEC3", with_bounds=True),
            "NORMAL": gltf.add_accessor(ball.normals, FLOAT, "VEC3"),
            "TEXCOORD_0": gltf.add_accessor(ball.uvs, FLOAT, "VEC2"),
            "COLOR_0": gltf.add_accessor(ball.colors, UNSIGNED_BYTE, "VEC4", normalized=True)}


def _add_draco(gltf, ball, add_ball, column, name, plain, material):
    """The attributes `plain` in one block of Draco data, with accessors that have no bytes of their own."""
    gltf.use_extension(DRACO, required=True)
    values = {"POSITION": (ball.positions, 3), "NORMAL": (ball.normals, 3), "TEXCOORD_0": (ball.uvs, 2),
              "COLOR_0": (ball.colors, 4)}
    corners = bytearray()
    for attribute in plain:
        numbers, width = values[attribute]
        for i in ball.indices:
            corners += numbers[width * i:width * (i + 1)].tobytes()
    encoded = encode(corners, "draco", *plain)
    (vertices,), data = struct.unpack("<I", encoded[:4]), encoded[4:]

    def described(accessor, count):
        kept = {key: value for key, value in gltf.document["accessors"][accessor].items() if key != "bufferView"}
        return gltf.add("accessors", {**kept, "count": count})

    indices = gltf.add("accessors", {"componentType": UNSIGNED_INT, "count": len(ball.indices), "type": "SCALAR"})
    mesh = add_ball(UPPER, column, name, {key: described(index, vertices) for key, index in plain.items()}, material,
                    indices=indices)
    mesh["primitives"][0]["extensions"] = {DRACO: {
        "bufferView": gltf.add_view(data), "attributes": {attribute: i for i, attribute in enumerate(plain)}}}


def _filtered(gltf, ball):
    """Positions through the exponential filter, normals through the octahedral one, coordinates through none."""
    gltf.use_extension("KHR_mesh_quantization", required=True)
    count = ball.vertex_count
    padded = array("f", (c for i in range(count) for c in (*ball.normals[3 * i:3 * i + 3], 0.0)))
    views = {
        "POSITION": _meshopt_view(gltf, encode(_exponential(ball.positions).tobytes(), "meshopt-attributes", 12), count,
                                  12, filter="EXPONENTIAL"),
        "NORMAL": _meshopt_view(gltf, encode(padded.tobytes(), "meshopt-octahedral"), count, 4, filter="OCTAHEDRAL"),
        "TEXCOORD_0": _meshopt_view(gltf, encode(ball.uvs.tobytes(), "meshopt-attributes", 8), count, 8)}
    position, normal, uv = ({"bufferView": view, "componentType": FLOAT, "count": count, "type": "VEC3"}
                            for view in views.values())
    position.update(min=[-RADIUS] * 3, max=[RADIUS] * 3)
    normal.update(componentType=BYTE, normalized=True)
    uv.update(type="VEC2")
    attributes = {name: gltf.add("accessors", accessor) for name, accessor in zip(views, (position, normal, uv))}
    encoded = encode(ball.indices.tobytes(), "meshopt-triangles")
    view = _meshopt_view(gltf, encoded, len(ball.indices), 4, mode="TRIANGLES")
    return attributes, gltf.add("accessors", {
        "bufferView": view, "componentType": UNSIGNED_INT, "count": len(ball.indices), "type": "SCALAR"})


def _exponential(values):
    """What the exponential filter makes `values` of, to 16 bits. The library's encoder for it takes other arguments
    in later versions."""
    words = array("I")
    for value in values:
        exponent = math.frexp(value)[1] - 16
        mantissa = round(math.ldexp(value, -exponent))
        words.append((exponent & 0xFF) << 24 | mantissa & 0xFFFFFF)
    return words


def _sequence(gltf, ball):
    """Indices of 16 bits that need not be triangles."""
    view = _meshopt_view(gltf, encode(ball.indices.tobytes(), "meshopt-indices"), len(ball.indices), 2, mode="INDICES")
    return gltf.add("accessors", {
        "bufferView": view, "componentType": UNSIGNED_SHORT, "count": len(ball.indices), "type": "SCALAR"})


def _instances(gltf, add_rotations):
    """Seven discs around each other, each turned its own way."""
    gltf.use_extension("EXT_mesh_gpu_instancing", required=True)
    rotations, translations = array("f"), array("f")
    for i in range(7):
        angle = 2.0 * math.pi * i / 7.0
        axis = normalize((math.sin(3.0 * angle), math.cos(angle), 0.5))
        half = 0.3 + 0.2 * i
        rotations.extend((*(math.sin(half) * c for c in axis), math.cos(half)))
        translations.extend((0.22 * math.cos(angle), 0.22 * math.sin(angle), 0.0))
    attributes = {"TRANSLATION": gltf.add_accessor(translations, FLOAT, "VEC3"),
                  "ROTATION": add_rotations(gltf, rotations),
                  "SCALE": gltf.add_accessor(array("f", (0.5, 0.15, 0.5) * 7), FLOAT, "VEC3")}
    return {"EXT_mesh_gpu_instancing": {"attributes": attributes}}


def _plain_rotations(gltf, rotations):
    return gltf.add_accessor(rotations, FLOAT, "VEC4")


def _compressed_rotations(gltf, rotations):
    count = len(rotations) // 4
    view = _meshopt_view(gltf, encode(rotations.tobytes(), "meshopt-quaternion"), count, 8, filter="QUATERNION")
    return gltf.add("accessors", {
        "bufferView": view, "componentType": SHORT, "count": count, "type": "VEC4", "normalized": True})


def _meshopt_view(gltf, encoded, count, stride, mode="ATTRIBUTES", **further):
    """A view into a buffer that nobody has, whose content is what `encoded` (bytes) decodes to."""
    gltf.use_extension(MESHOPT, required=True)
    source = gltf.document["bufferViews"][gltf.add_view(encoded)]
    fallback = next((i for i, buffer in enumerate(gltf.document["buffers"]) if "uri" not in buffer), None)
    if fallback is None:
        fallback = gltf.add("buffers", {"byteLength": 0, "extensions": {MESHOPT: {"fallback": True}}})
    buffer = gltf.document["buffers"][fallback]
    view = {"buffer": fallback, "byteOffset": buffer["byteLength"], "byteLength": count * stride, "extensions": {
        MESHOPT: {**source, "byteStride": stride, "count": count, "mode": mode, **further}}}
    if mode == "ATTRIBUTES":
        view["byteStride"] = stride
    # The next view starts at a multiple of 4 bytes.
    buffer["byteLength"] += -(-count * stride // 4) * 4
    return gltf.add("bufferViews", view)


def _webp_texture(stage):
    """The bands as WebP; who does not know it gets a checker."""
    gltf = stage.scene.gltf
    gltf.use_extension(WEBP)
    texture = stage.texture("bands, by WebP", checker(0.1, 0.9, textures.WIDTH, textures.HEIGHT))
    image = gltf.add_image("bands.webp", textures.color_bands(webp), "image/webp")
    gltf.document["textures"][texture]["extensions"] = {WEBP: {"source": image}}
    return texture
