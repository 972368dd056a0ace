"""What the header of an EXR says, for those who read its pixels and those who do not. Needs neither Blender nor numpy."""

from __future__ import annotations

import struct

MAGIC, MULTIPART, DEEP, TILED = 20000630, 0x1000, 0x800, 0x200


def read_attributes(data: bytes) -> tuple[dict[str, bytes], int]:
    """The attributes of a file of one part with scan lines, and where its table of offsets begins. ValueError if it is of
    another kind."""
    magic, version = struct.unpack_from("<II", data)
    if magic != MAGIC or version & (MULTIPART | DEEP | TILED):
        raise ValueError("this is no EXR of one part with scan lines")
    attributes, at = {}, 8
    while data[at]:
        end = data.index(0, at)
        kind_end = data.index(0, end + 1)
        size, = struct.unpack_from("<i", data, kind_end + 1)
        attributes[data[at:end].decode()] = data[kind_end + 5:kind_end + 5 + size]
        at = kind_end + 5 + size
    return attributes, at + 1


def channel_kinds(channels: bytes) -> list[tuple[str, int]]:
    """Names and types, in the order of the file, that the attribute `channels` has: 0, 1 and 2 are uint, half and float."""
    result, at = [], 0
    while channels[at]:
        end = channels.index(0, at)
        result.append((channels[at:end].decode(), struct.unpack_from("<i", channels, end + 1)[0]))
        at = end + 17
    return result
