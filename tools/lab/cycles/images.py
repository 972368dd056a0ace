"""Reading and averaging float EXRs as Etendue and Blender write them, with nothing but the standard library."""

import struct
import zlib
from array import array
from itertools import accumulate

from faults.pixels import ZIP, ZIP_ROWS, exr_attributes

FLOAT = 2


def _channels(data):
    """[(name, type)] in the file's order."""
    result, at = [], 0
    while data[at]:
        end = data.index(0, at)
        result.append((data[at:end].decode(), struct.unpack_from("<i", data, end + 1)[0]))
        at = end + 17
    return result


def _inflated(block, size):
    """What OpenEXR's ZIP has compressed: differences, of the even bytes and then of the odd ones."""
    if len(block) == size:
        return block
    halves = bytes(accumulate(zlib.decompress(block), lambda a, b: (a + b - 128) & 255))
    middle = (size + 1) // 2
    result = bytearray(size)
    result[0::2], result[1::2] = halves[:middle], halves[middle:]
    return bytes(result)


def read_rgb(path):
    """Width, height, and R, G, B of each pixel, rows from the top. ValueError if the file is of another kind."""
    data = path.read_bytes()
    attributes, at = exr_attributes(data)
    channels = _channels(attributes["channels"])
    if attributes["compression"] != bytes((ZIP,)) or any(kind != FLOAT for _, kind in channels):
        raise ValueError(f"{path} is no EXR of 32-bit floats compressed by ZIP")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names = [name for name, _ in channels]
    pixels = array("f", bytes(12 * width * height))
    at += 8 * ((height - 1) // ZIP_ROWS + 1)
    while at < len(data):
        first, size = struct.unpack_from("<iI", data, at)
        rows = min(ZIP_ROWS, y1 - first + 1)
        values = array("f", _inflated(data[at + 8:at + 8 + size], rows * width * 4 * len(names)))
        for row in range(rows):
            for place, channel in enumerate("RGB"):
                begin = (row * len(names) + names.index(channel)) * width
                target = 3 * width * (first - y0 + row) + place
                pixels[target:target + 3 * width:3] = values[begin:begin + width]
        at += 8 + size
    return width, height, pixels


def mean_colors(path):
    _, _, pixels = read_rgb(path)
    return [sum(pixels[c::3]) / (len(pixels) // 3) for c in range(3)]


def average(paths):
    """Width, height and pixels of the mean of images of one size."""
    read = [read_rgb(path) for path in paths]
    width, height, _ = read[0]
    return width, height, array("f", (sum(values) / len(values) for values in zip(*(image[2] for image in read))))


def relative_difference(a, b, references):
    """Mean of (a - b)² / (r² + 0.01), as relMSE has it but with both images on the same side. Takes paths of images; r is
    the average of `references`."""
    _, _, reference = average(references)
    pixels = [read_rgb(path)[2] for path in (a, b)]
    return sum((v - w) ** 2 / (r * r + 0.01) for v, w, r in zip(*pixels, reference)) / len(reference)
