"""Images that drive one parameter each. What the parameter must not read is filled with something else, so that a
channel taken for another, or data taken for a colour, changes the picture."""

import math

from ..images import png, to_srgb_byte

WIDTH, HEIGHT = 64, 32


def channel(name):
    """A data image with its ramp in the channel "R", "G", "B" or "A", and the opposite in the others."""
    wanted = "RGBA".index(name)

    def texel(u, _):
        return [_byte(ramp(u) if i == wanted else 1.0 - ramp(u)) for i in range(4 if name == "A" else 3)]

    return _image(texel)


def color_bands(encode=png):
    """A colour image: hues around, bright and dark bands from the top to the bottom. `encode` is png or webp of
    images."""
    def texel(u, v):
        band = 1.0 if int(6 * v) % 2 else 0.5
        return [to_srgb_byte(band * (0.5 + 0.5 * math.cos(2.0 * math.pi * (2.0 * u - phase / 3.0))))
                for phase in range(3)]

    return encode(WIDTH, HEIGHT, _pixels(texel))


def anisotropy():
    """A data image: the direction turns once from left to right of the front, in R and G; the strength in B."""
    def texel(u, v):
        angle = 2.0 * math.pi * (2.0 * u - 0.5)
        strength = 1.0 if int(6 * v) % 2 else 0.6
        return [_byte(0.5 + 0.5 * math.cos(angle)), _byte(0.5 + 0.5 * math.sin(angle)), _byte(strength)]

    return _image(texel)


def waves():
    """A normal map of waves around and, half as steep, from the top to the bottom."""
    def texel(u, v):
        x, y = 0.5 * math.sin(2.0 * math.pi * 8.0 * u), 0.25 * math.sin(2.0 * math.pi * 5.0 * v)
        z = math.sqrt(1.0 - x * x - y * y)
        return [_byte(0.5 + 0.5 * c) for c in (x, y, z)]

    return _image(texel)


def ramp(u):
    """0 on the left of a mapped sphere's front to 1 on the right, without a seam behind."""
    return 0.5 - 0.5 * math.cos(2.0 * math.pi * (u - 0.25))


def _image(texel):
    pixels = _pixels(texel)
    return png(WIDTH, HEIGHT, pixels, len(pixels) // (WIDTH * HEIGHT))


def _pixels(texel):
    pixels = bytearray()
    for y in range(HEIGHT):
        for x in range(WIDTH):
            pixels.extend(texel((x + 0.5) / WIDTH, (y + 0.5) / HEIGHT))
    return bytes(pixels)


def _byte(value):
    return round(255.0 * value)
