"""Blender's images as files inside a GLB."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy

from .textures import LINEAR

KINDS = {b"\x89PNG": "image/png", b"\xff\xd8\xff": "image/jpeg"}


def image_bytes(image: Any, path: Path | None, times_alpha: bool = False) -> tuple[bytes, str]:
    """Returns a PNG or JPEG file and its media type: the image's own, which is packed or at `path`, or one of its pixels,
    made sRGB where those are linear, or opaque and multiplied by their alpha if so asked; empty where the image is
    missing."""
    data, linear = b"", image.is_float or image.colorspace_settings.name in LINEAR
    if image.source == "FILE" and not image.is_dirty and not linear and not times_alpha:
        if image.packed_file is not None:
            data = bytes(image.packed_file.data)
        elif path is not None and path.is_file():
            data = path.read_bytes()
    for magic, kind in KINDS.items():
        if data.startswith(magic):
            return data, kind
    width, height = image.size
    if width == 0 or height == 0:
        return b"", ""
    flat = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(flat)
    pixels = flat.reshape(height, width, image.channels)[::-1]
    if image.channels != 4:
        color = pixels[..., :3] if image.channels == 3 else numpy.repeat(pixels[..., :1], 3, axis=2)
        pixels = numpy.concatenate([color, numpy.ones((height, width, 1), numpy.float32)], axis=2)
    if linear:
        color = numpy.clip(pixels[..., :3], 0.0, 1.0)
        color = numpy.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1.0 / 2.4) - 0.055)
        pixels = numpy.concatenate([color, pixels[..., 3:]], axis=2)
    if times_alpha:  # Cycles multiplies encoded colours, too.
        pixels = numpy.concatenate([pixels[..., :3] * pixels[..., 3:], numpy.ones_like(pixels[..., 3:])], axis=2)
    return png(numpy.rint(numpy.clip(pixels, 0.0, 1.0) * 255.0).astype(numpy.uint8)), "image/png"


def png(pixels: numpy.ndarray) -> bytes:
    """Returns a PNG of four channels of 8 bits, its first row on top."""
    height, width, _ = pixels.shape

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8), pixels.reshape(height, -1)], axis=1)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))
