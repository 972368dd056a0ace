"""Reading the EXRs that the program writes (scan lines, ZIP or no compression), and writing simple ones for it."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy

from .exr_header import MAGIC, channel_kinds, read_attributes

TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
ROWS = {0: 1, 2: 1, 3: 16}  # of a chunk, by compression: none, ZIPS, ZIP


@dataclass
class Exr:
    """Channels by name, each an array of rows from the top down."""

    x: int
    y: int
    width: int
    height: int
    channels: dict[str, numpy.ndarray]
    attributes: dict[str, bytes]

    def text(self, name: str) -> str:
        return self.attributes.get(name, b"").decode("utf-8", "replace")


def read_exr(path: Path) -> Exr:
    """ValueError if the file is of another kind."""
    data = path.read_bytes()
    try:
        attributes, at = read_attributes(data)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    kinds = [(name, TYPES[kind]) for name, kind in channel_kinds(attributes["channels"])]
    compression = attributes["compression"][0]
    if compression not in ROWS:
        raise ValueError(f"{path} is compressed otherwise than by ZIP")
    rows_of_chunk = ROWS[compression]
    line_size = width * sum(kind.itemsize for _, kind in kinds)
    channels = {name: numpy.empty((height, width), kind) for name, kind in kinds}
    chunks = -(-height // rows_of_chunk)
    for offset in struct.unpack_from(f"<{chunks}Q", data, at):
        first, size = struct.unpack_from("<iI", data, offset)
        rows = min(rows_of_chunk, y1 - first + 1)
        lines = numpy.frombuffer(inflated(data[offset + 8:offset + 8 + size], rows * line_size), numpy.uint8)
        lines = lines.reshape(rows, line_size)
        begin, top = 0, first - y0
        for name, kind in kinds:
            end = begin + width * kind.itemsize
            channels[name][top:top + rows] = numpy.ascontiguousarray(lines[:, begin:end]).view(kind)
            begin = end
    return Exr(x0, y0, width, height, channels, attributes)


def inflated(block: bytes, size: int) -> bytes:
    """Undoes OpenEXR's ZIP: differences of the even bytes and then of the odd ones."""
    if len(block) == size:
        return block
    steps = numpy.frombuffer(zlib.decompress(block), numpy.uint8).copy()
    steps[1:] -= 128
    halves = numpy.cumsum(steps, dtype=numpy.uint8)
    result = numpy.empty(size, numpy.uint8)
    middle = (size + 1) // 2
    result[0::2], result[1::2] = halves[:middle], halves[middle:]
    return result.tobytes()


def write_exr(path: Path, pixels: numpy.ndarray) -> None:
    """Writes R, G and B as 32-bit floats without compression. `pixels` has rows from the top down."""
    height, width = pixels.shape[:2]

    def attribute(name: str, kind: str, value: bytes) -> bytes:
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = struct.pack("<II", MAGIC, 2) + b"".join((
        attribute("channels", "chlist", channels), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)))) + b"\0"
    line_size = 12 * width
    first = len(header) + 8 * height
    table = b"".join(struct.pack("<Q", first + row * (8 + line_size)) for row in range(height))
    with path.open("wb") as file:
        file.write(header + table)
        for row in range(height):
            planes = numpy.ascontiguousarray(pixels[row, :, 2::-1].T, numpy.dtype("<f4"))
            file.write(struct.pack("<iI", row, line_size) + planes.tobytes())
