"""A tiled pool under a lamp at dusk: light that the waves focus on the tiles, seen through the same waves."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import box, merged, sphere, wall, wavy_block
from ..patterns import tiles
from ..room import add_room
from ..vector import look_at

# The basin in (x, z), its floor, the water at rest; the deck around it is y = 0.
LOW, HIGH = (-1.7, -1.2), (1.7, 1.2)
BOTTOM, LEVEL = -1.05, -0.10
DECK_HALF_SIZE = 6.0
TILE = 0.12
# Steps down from the left wall, from the highest on.
STEPS, STEP_WIDTH = 4, 0.26

# Wavelength, direction in degrees and phase of each wave; all have the same curvature, which is what focuses light.
WAVES = ((0.92, 12.0, 0.3), (0.71, 75.0, 2.1), (0.58, -38.0, 4.0), (0.47, 118.0, 1.2), (0.36, 50.0, 5.1))
CURVATURE = 1.6
WATER_COLUMNS, WATER_ROWS = 240, 170
# The water reaches behind the tiles, so that no gap is between them.
OVERLAP = 0.02

LAMP_CENTER, LAMP_RADIUS, LAMP_RADIANCE, LAMP_FREQUENCY = (-0.9, 3.4, -1.1), 0.07, (4200.0, 3800.0, 3100.0), 8

# Name, position, what it looks at, and vertical angle in degrees of each camera.
VIEWS = (("above", (0.35, 3.1, 3.5), (0.0, -0.45, -0.05), 36.0), ("along", (1.55, 0.32, 1.75), (-0.35, -0.22, -0.75), 42.0))


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    blues = ((0.10, 0.34, 0.42), (0.20, 0.50, 0.55), (0.38, 0.66, 0.66), (0.55, 0.74, 0.70))
    mosaic = gltf.add_material("tiles", base_color_texture=gltf.add_texture("tiles", tiles(
        256, 8, blues, grout=(0.70, 0.70, 0.66), grout_width=0.07)))
    add_room(scene, (LOW[0], BOTTOM, LOW[1]), (HIGH[0], 0.0, HIGH[1]),
             {side: mosaic for side in ("floor", "left", "right", "back", "front")}, uv_per_meter=1.0 / (8.0 * TILE))
    scene.add_object("steps", steps(), mosaic)
    stone = scene.add_diffuse("stone", (0.52, 0.46, 0.38))
    scene.add_object("deck", _deck(), stone)
    scene.add_object("kerb", _kerb(), scene.add_diffuse("kerb", (0.70, 0.66, 0.58)))
    filling = scene.add_glass("water", 1.33, thickness=LEVEL - BOTTOM, attenuationColor=[0.55, 0.85, 0.92],
                            attenuationDistance=3.0)
    scene.add_object("water", water(), filling, closed=True)
    scene.add_object("ball", sphere(0.24, 24), scene.add_diffuse("ball", (0.75, 0.13, 0.06)), closed=True,
                     translation=(0.75, LEVEL + 0.12, -0.45))
    scene.add_lamp("lamp", sphere(LAMP_RADIUS, LAMP_FREQUENCY), LAMP_RADIANCE, closed=True, translation=LAMP_CENTER)
    for name, position, target, degrees in VIEWS:
        gltf.add_camera(name, position, look_at(position, target), yfov=math.radians(degrees), aspect_ratio=16.0 / 9.0)
    return scene


def wave(x, z):
    """Height of the water and its derivatives along x and z."""
    height, along_x, along_z = LEVEL, 0.0, 0.0
    for wavelength, degrees, phase in WAVES:
        number = 2.0 * math.pi / wavelength
        kx, kz = number * math.cos(math.radians(degrees)), number * math.sin(math.radians(degrees))
        amplitude = CURVATURE / number ** 2
        height += amplitude * math.sin(kx * x + kz * z + phase)
        slope = amplitude * math.cos(kx * x + kz * z + phase)
        along_x, along_z = along_x + kx * slope, along_z + kz * slope
    return height, along_x, along_z


def water():
    """The closed body of the water, under its waves."""
    low = (LOW[0] - OVERLAP, BOTTOM - OVERLAP, LOW[1] - OVERLAP)
    return wavy_block(low, (HIGH[0] + OVERLAP, HIGH[1] + OVERLAP), WATER_COLUMNS, WATER_ROWS, wave)


def steps():
    """Boxes whose backs and bottoms reach behind the tiles of the basin."""
    rise = (-BOTTOM + LEVEL) / (STEPS + 1)
    return merged([box((LOW[0] - OVERLAP, BOTTOM - OVERLAP, LOW[1] - OVERLAP),
                       (LOW[0] + STEP_WIDTH * (i + 1), LEVEL - rise * (i + 1), HIGH[1] + OVERLAP),
                       uv_per_meter=1.0 / (8.0 * TILE)) for i in range(STEPS)])


def _deck():
    h = DECK_HALF_SIZE
    hole = ((LOW[0] + h, h - HIGH[1]), (HIGH[0] + h, h - LOW[1]))
    return wall((-h, 0.0, h), (2.0 * h, 0.0, 0.0), (0.0, 0.0, -2.0 * h), [hole])


def _kerb(width=0.22, height=0.05):
    (x0, z0), (x1, z1) = LOW, HIGH
    return merged([box(low, high) for low, high in (
        ((x0 - width, 0.0, z1), (x1 + width, height, z1 + width)),
        ((x0 - width, 0.0, z0 - width), (x1 + width, height, z0)),
        ((x0 - width, 0.0, z0), (x0, height, z1)), ((x1, 0.0, z0), (x1 + width, height, z1)))])
