"""What image files say of their pixels, to the bit, and nothing else of what stands in them."""

import struct

EXR_OF_ONE_PART = bytes((0x76, 0x2F, 0x31, 0x01, 2, 0, 0, 0))
ZIP, ZIP_ROWS = 3, 16
PNG = b"\x89PNG\r\n\x1a\n"


def exr_attributes(data):
    """The values of the header by name, and where it ends."""
    attributes, at = {}, len(EXR_OF_ONE_PART)
    while data[at]:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        (size,) = struct.unpack_from("<I", data, type_end + 1)
        begin = type_end + 5
        attributes[data[at:name_end].decode()] = data[begin:begin + size]
        at = begin + size
    return attributes, at + 1


def exr_pixels(data):
    """Channels, data window and pixels, compressed as they are."""
    if not data.startswith(EXR_OF_ONE_PART):
        raise ValueError("no EXR file of one part, stored by rows")
    attributes, at = exr_attributes(data)
    if attributes["compression"] != bytes((ZIP,)):
        raise ValueError("not compressed as Etendue does it")
    _, first, _, last = struct.unpack("<4i", attributes["dataWindow"])
    blocks = (last - first) // ZIP_ROWS + 1
    at += 8 * blocks  # a table of where the blocks are
    pixels = data[at:]
    for _ in range(blocks):
        at += 8 + struct.unpack_from("<iI", data, at)[1]
    if at != len(data):
        raise ValueError(f"{len(data)} bytes where {at} are needed")
    return attributes["channels"], attributes["dataWindow"], pixels


def png_pixels(data):
    """Header and pixels, compressed as they are."""
    if not data.startswith(PNG):
        raise ValueError("no PNG file")
    at, pixels, kind = len(PNG), [], b""
    while kind != b"IEND":
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind in (b"IHDR", b"IDAT"):
            pixels.append(data[at + 8:at + 8 + size])
        at += 12 + size
    if at != len(data):
        raise ValueError(f"{len(data)} bytes where {at} are needed")
    return pixels


READERS = {".exr": exr_pixels, ".png": png_pixels}


def read_pixels(path):
    """What the pixels of an EXR or PNG file are: equal for equal images. Raises ValueError if the file is not whole."""
    try:
        return READERS[path.suffix](path.read_bytes())
    except (ValueError, KeyError, IndexError, struct.error) as error:
        raise ValueError(f"{path} is not a whole image: {error}") from error
