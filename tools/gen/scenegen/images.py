"""Images from the standard library alone: OpenEXR for environments, PNG and WebP for textures."""

import struct
import zlib
from array import array
from math import cos, pi, sin

# Pixel types: number in the header, bytes, format of struct.
_EXR_HALF, _EXR_FLOAT = (1, 2, "e"), (2, 4, "f")


def exr(width, height, pixels, full_floats=False):
    """Bytes of an uncompressed OpenEXR file of half-floats, or of `full_floats` of 32 bits, in linear Rec.709.

    `pixels` are R, G, B per pixel, rows from the top. Values must be finite, and as half-floats below 65504.
    """
    number, size, letter = _EXR_FLOAT if full_floats else _EXR_HALF

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", number, 0, 1, 1) for name in (b"B", b"G", b"R"))
    channels += b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join((
        attribute("channels", "chlist", channels),
        attribute("chromaticities", "chromaticities",
                  struct.pack("<8f", 0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)),
        attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window),
        attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"),
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)))) + b"\0"

    # One block per scan line: its number, its size, then each channel's values in alphabetical order.
    line_size = width * 3 * size
    first_block = len(header) + 8 * height
    offsets = struct.pack(f"<{height}Q", *(first_block + y * (8 + line_size) for y in range(height)))
    lines = []
    for y in range(height):
        row = pixels[3 * width * y:3 * width * (y + 1)]
        lines.append(struct.pack(f"<ii{3 * width}{letter}", y, line_size, *row[2::3], *row[1::3], *row[0::3]))
    return header + offsets + b"".join(lines)


def latitude_longitude(width, height, radiance):
    """Pixels of an environment: `radiance(direction)` at the centre of each, the middle of the image towards -Z.

    Columns go from +Z by -X, -Z and +X back to +Z, rows from +Y to -Y.
    """
    azimuths = [2.0 * pi * ((x + 0.5) / width - 0.5) for x in range(width)]
    columns = [(sin(a), -cos(a)) for a in azimuths]
    pixels = array("f")
    for y in range(height):
        polar = pi * (y + 0.5) / height
        horizontal, up = sin(polar), cos(polar)
        for x, z in columns:
            pixels.extend(radiance((x * horizontal, up, z * horizontal)))
    return pixels


def png(width, height, pixels, channels=3):
    """Bytes of an 8-bit PNG, RGB or with 4 `channels` RGBA. `pixels` are bytes, rows from the top."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    stride = channels * width
    color_type = {3: 2, 4: 6}[channels]
    # Filter type 0 in front of each row.
    rows = b"".join(b"\0" + pixels[stride * y:stride * (y + 1)] for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def webp(width, height, pixels):
    """Bytes of a lossless 8-bit RGB WebP. `pixels` as of png().

    The simplest stream of RFC 9649: no transforms, and a prefix code of 8 bits for each value of a channel.
    """
    stream = []  # bits

    def put(value, count):
        stream.extend(value >> i & 1 for i in range(count))

    put(0x2F, 8)
    put(width - 1, 14)
    put(height - 1, 14)
    put(0, 4)  # no alpha, version 0
    put(0, 3)  # no transform, no cache of colours, one group of codes
    for others in (24, 0, 0):
        # Green with the lengths of copies, red, blue. Lengths are 0 or 8, which one bit tells apart; those two are the
        # third and the twelfth in the order in which lengths are given codes.
        put(0, 1)
        put(12 - 4, 4)
        for i in range(12):
            put(1 if i in (2, 11) else 0, 3)
        put(0, 1)
        put((1 << 256) - 1, 256)
        put(0, others)
    put(0b11111111_101, 11)  # alpha is always 255
    put(0b0001, 4)  # distances of copies do not occur
    for i in range(0, 3 * width * height, 3):
        red, green, blue = pixels[i:i + 3]
        for value in (green, red, blue):
            # Prefix codes begin with their highest bit.
            put(int(f"{value:08b}"[::-1], 2), 8)
    put(0, -len(stream) % 16)  # chunks have even lengths
    data = bytes(sum(bit << i for i, bit in enumerate(stream[k:k + 8])) for k in range(0, len(stream), 8))
    return b"RIFF" + struct.pack("<I", len(data) + 12) + b"WEBPVP8L" + struct.pack("<I", len(data)) + data


def to_srgb_byte(linear):
    """A linear value in [0, 1] through the sRGB transfer function (IEC 61966-2-1), as a byte."""
    encoded = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1.0 / 2.4) - 0.055
    return round(255.0 * min(max(encoded, 0.0), 1.0))


def linear_png(width, height, color):
    """Bytes of a PNG of `color(u, v)`, linear R, G, B in [0, 1], at the centre of each pixel; v grows downwards."""
    pixels = bytearray()
    for y in range(height):
        for x in range(width):
            pixels.extend(map(to_srgb_byte, color((x + 0.5) / width, (y + 0.5) / height)))
    return png(width, height, bytes(pixels))
