"""A prism that spreads the light of a slit into a spectrum on a screen."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import extrusion, ground, merged, panel, rectangle, wall
from ..vector import add, look_at, scale

# The prism stands on the table, pointed towards the viewer; light passes it half way between point and base.
SIDE, HEIGHT = 0.16, 0.26
INDEX, DISPERSION = 1.6, 2.5
# Least deviation: inside, light runs parallel to the base.
HALF_DEVIATION = math.asin(0.5 * INDEX) - math.radians(30.0)
TO_PRISM = (math.cos(HALF_DEVIATION), 0.0, math.sin(HALF_DEVIATION))
FROM_PRISM = (TO_PRISM[0], 0.0, -TO_PRISM[2])

# The lamp: a strip at the far end of a dark housing, whose front has a slit. Sizes are half widths and half heights.
STRIP, SLIT, HOUSING = (0.002, 0.08), (0.004, 0.11), (0.05, 0.125)
HOUSING_LENGTH, LAMP_DISTANCE, LAMP_HEIGHT = 0.28, 0.62, 0.13
LAMP_RADIANCE = 60000.0

SCREEN_DISTANCE, SCREEN_SIZE = 0.75, (0.9, 0.42)


def build():
    scene = GeneratedScene()
    scene.add_object("table", ground(2.2), scene.add_diffuse("table", (0.35, 0.33, 0.31)))
    scene.add_object("wall", rectangle((-2.2, 0.0, -1.5), (4.4, 0.0, 0.0), (0.0, 1.8, 0.0)),
                     scene.add_diffuse("wall", (0.22, 0.24, 0.27)))
    scene.add_object("screen", _screen(), scene.add_diffuse("screen", (0.80, 0.80, 0.80)))
    glass = scene.add_glass("glass", INDEX, thickness=0.5 * SIDE, dispersion=DISPERSION)
    reach = 0.25 * math.sqrt(3.0) * SIDE
    outline = ((0.0, reach), (0.5 * SIDE, -reach), (-0.5 * SIDE, -reach))
    # A hair above the table.
    scene.add_object("prism", extrusion(outline, 0.0005, HEIGHT), glass, closed=True)
    _add_lamp(scene)
    position = (0.14, 0.85, 1.45)
    scene.gltf.add_camera("camera", position, look_at(position, (0.16, 0.05, -0.16)), yfov=math.radians(35.0),
                          aspect_ratio=16.0 / 9.0)
    return scene


def _add_lamp(scene):
    """In a frame of its own, in which light leaves towards -Z."""
    position = add((-0.25 * SIDE, LAMP_HEIGHT, 0.0), scale(TO_PRISM, -LAMP_DISTANCE))
    place = {"translation": position, "rotation": look_at(position, add(position, TO_PRISM))}
    scene.add_lamp("lamp", panel(2.0 * STRIP[0], 2.0 * STRIP[1]), (LAMP_RADIANCE,) * 3, **place)
    scene.add_object("housing", _housing(), scene.add_diffuse("housing", (0.05, 0.05, 0.055)), **place)


def _housing():
    """Thin walls around the strip, from just behind it to the plate with the slit."""
    (w, h), (slit_w, slit_h), front, back = HOUSING, SLIT, -HOUSING_LENGTH, 0.01
    along = (0.0, 0.0, front - back)
    slit = ((w - slit_w, h - slit_h), (w + slit_w, h + slit_h))
    return merged([
        wall((w, -h, front), (-2.0 * w, 0.0, 0.0), (0.0, 2.0 * h, 0.0), [slit]),
        rectangle((-w, -h, back), (2.0 * w, 0.0, 0.0), (0.0, 2.0 * h, 0.0)),
        rectangle((w, -h, back), along, (0.0, 2.0 * h, 0.0)),
        rectangle((-w, h, back), along, (0.0, -2.0 * h, 0.0)),
        rectangle((-w, h, back), (2.0 * w, 0.0, 0.0), along),
        rectangle((w, -h, back), (-2.0 * w, 0.0, 0.0), along)])


def _screen():
    """Upright on the table, across the light that leaves the prism."""
    width, height = SCREEN_SIZE
    middle = add((0.25 * SIDE, 0.0, 0.0), scale(FROM_PRISM, SCREEN_DISTANCE))
    across = (-FROM_PRISM[2], 0.0, FROM_PRISM[0])
    return rectangle(add(middle, scale(across, -0.5 * width)), scale(across, width), (0.0, height, 0.0))
