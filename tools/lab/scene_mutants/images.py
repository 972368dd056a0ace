"""Whether the colours of an image that the program wrote are numbers."""

import struct
import zlib
from itertools import accumulate

from faults.pixels import EXR_OF_ONE_PART, ZIP, ZIP_ROWS, exr_attributes

SIZES = {0: 4, 1: 2, 2: 4}  # of unsigned integers, half and float, by their number in the list of channels
MASKS = {1: 0x7C00, 2: 0x7F800000}  # the exponent of halves and floats: all ones where the value is not finite
COLORS = {"R", "G", "B", "A"}


def channels(attribute):
    """Name and type of each, in the order of the file."""
    found, where = [], 0
    while attribute[where]:
        end = attribute.index(0, where)
        found.append((attribute[where:end].decode(), struct.unpack_from("<i", attribute, end + 1)[0]))
        where = end + 17
    return found


def unpacked(block, size):
    """The bytes of a block of rows: deflated, differences of neighbours, its even bytes before the odd ones."""
    if len(block) == size:
        return block
    difference = bytearray(zlib.decompress(block))
    parts = bytes(value & 255 for value in accumulate(difference, lambda before, one: before + one - 128))
    whole = bytearray(size)
    half = (size + 1) // 2
    whole[0::2], whole[1::2] = parts[:half], parts[half:]
    return bytes(whole)


def nonfinite_colors(path):
    """How many values of the colours R, G, B and A are not finite. Raises ValueError where the file is not whole."""
    data = path.read_bytes()
    if not data.startswith(EXR_OF_ONE_PART):
        raise ValueError("no EXR file of one part, stored by rows")
    try:
        return count_nonfinite(data)
    except (IndexError, KeyError, struct.error, zlib.error) as error:
        raise ValueError(str(error)) from error


def count_nonfinite(data):
    attributes, at = exr_attributes(data)
    if attributes["compression"] not in (b"\0", bytes((ZIP,))):
        raise ValueError("not compressed as Etendue does it")
    rows_of_block = ZIP_ROWS if attributes["compression"] == bytes((ZIP,)) else 1
    left, first, right, last = struct.unpack("<4i", attributes["dataWindow"])
    listed, width = channels(attributes["channels"]), right - left + 1
    blocks = (last - first) // rows_of_block + 1
    at, bad = at + 8 * blocks, 0
    for _ in range(blocks):
        y, size = struct.unpack_from("<iI", data, at)
        rows = min(rows_of_block, last - y + 1)
        block = unpacked(data[at + 8:at + 8 + size], rows * width * sum(SIZES[kind] for _, kind in listed))
        at += 8 + size
        bad += nonfinite_of_rows(block, listed, width, rows)
    if at != len(data):
        raise ValueError(f"{len(data)} bytes where {at} are needed")
    return bad


def nonfinite_of_rows(block, listed, width, rows):
    bad, where = 0, 0
    for _ in range(rows):
        for name, kind in listed:
            size = SIZES[kind] * width
            if name in COLORS and kind in MASKS:
                values = struct.unpack_from(f"<{width}{'H' if kind == 1 else 'I'}", block, where)
                mask = MASKS[kind]
                bad += sum(value & mask == mask for value in values)
            where += size
    return bad
