"""A cut diamond in a ring of white gold on a table: dispersion, mirrors and facets in the light of a small lamp."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import convex, ground, panel, ring, sphere
from ..vector import look_at

TABLE_ALBEDO = (0.46, 0.40, 0.36)
# Diamond, with the dispersion that its Abbe number of 55 makes.
INDEX, DISPERSION = 2.418, 20.0 / 55.0
# Of a round brilliant, over the radius of its girdle: half the girdle's height, and the table's corners.
GIRDLE, TABLE = 0.02, 0.56
CROWN, STAR, UPPER, MAIN, LOWER = (math.radians(angle) for angle in (34.5, 21.0, 39.5, 40.9, 42.3))
STONE_RADIUS, RING_RADIUS, RING_HALF_THICKNESS, RING_HEIGHT = 0.50, 0.36, 0.035, 0.34
LAMP_CENTER, LAMP_RADIUS, LAMP_RADIANCE, LAMP_FREQUENCY = (-1.5, 2.0, -0.9), 0.04, (6000.0, 5800.0, 5500.0), 8
BOX_SIZE, BOX_CENTER, BOX_RADIANCE = 2.6, (1.8, 3.2, -1.6), (1.5, 1.7, 2.0)


def build():
    scene = GeneratedScene()
    scene.add_object("table", ground(5.0), scene.add_diffuse("table", TABLE_ALBEDO))
    gold = scene.gltf.add_material("white gold", base_color=(0.86, 0.83, 0.77), metallic=1.0, roughness=0.0)
    # The ring lies flat and carries the stone, whose pavilion stays a hair off its rim.
    scene.add_object("ring", ring(RING_RADIUS, RING_HALF_THICKNESS, RING_HEIGHT, 256, 12), gold, closed=True,
                     translation=(0.0, 0.001, 0.0))
    diamond = scene.add_glass("diamond", INDEX, thickness=STONE_RADIUS, dispersion=DISPERSION)
    # The cone around the pavilion touches the rounded rim where their slopes are equal.
    rim = (RING_RADIUS - RING_HALF_THICKNESS * math.sin(LOWER), RING_HEIGHT + RING_HALF_THICKNESS * (math.cos(LOWER) - 1.0))
    tip = rim[1] - rim[0] * math.tan(LOWER)
    girdle = tip + STONE_RADIUS * (1.006 * math.tan(LOWER) + GIRDLE)
    scene.add_object("stone", convex(brilliant(STONE_RADIUS)), diamond, closed=True, translation=(0.0, girdle + 0.004, 0.0),
                     rotation=(0.0, math.sin(0.15), 0.0, math.cos(0.15)))
    # A second one lies on the table beside it, on a facet of its pavilion.
    small = 0.5 * STONE_RADIUS
    turn = 0.5 * (0.5 * math.pi - (0.5 * math.pi - MAIN))
    height = small * (math.sin(MAIN) + GIRDLE * math.cos(MAIN))
    scene.add_object("second stone", convex(brilliant(small)), diamond, closed=True, translation=(0.62, height + 0.001, 0.52),
                     rotation=(0.0, 0.0, -math.sin(turn), math.cos(turn)))
    scene.add_lamp("lamp", sphere(LAMP_RADIUS, LAMP_FREQUENCY), LAMP_RADIANCE, closed=True, translation=LAMP_CENTER)
    scene.add_lamp("soft box", panel(BOX_SIZE, BOX_SIZE), BOX_RADIANCE, translation=BOX_CENTER,
                   rotation=look_at(BOX_CENTER, (0.0, 0.6, 0.0)))
    position = (0.45, 1.75, 2.6)
    scene.gltf.add_camera("camera", position, look_at(position, (0.12, 0.24, 0.1)), yfov=math.radians(30.0),
                          aspect_ratio=4.0 / 3.0)
    return scene


def brilliant(radius):
    """Planes of a round brilliant about the Y axis, whose girdle lies around the origin."""
    def plane(angle, azimuth, point):
        """That of a facet `angle` from the horizontal, facing up or, if negative, down, through (radius, height)."""
        out, up = abs(math.sin(angle)), math.copysign(math.cos(angle), angle)
        normal = (out * math.cos(azimuth), up, out * math.sin(azimuth))
        return normal, radius * (out * point[0] + up * point[1])

    eighth = 0.25 * math.pi
    table_height = GIRDLE + (1.0 - TABLE) * math.tan(CROWN)
    planes = [((0.0, 1.0, 0.0), radius * table_height)]
    for i in range(8):
        azimuth = i * eighth
        planes.append(plane(CROWN, azimuth, (1.0, GIRDLE)))
        planes.append(plane(STAR, azimuth + 0.5 * eighth, (TABLE * math.cos(0.5 * eighth), table_height)))
        planes.append(plane(-MAIN, azimuth, (1.0, -GIRDLE)))
        for side in (-0.27, 0.27):
            planes.append(plane(UPPER, azimuth + side * eighth, (1.004, GIRDLE)))
            planes.append(plane(-LOWER, azimuth + side * eighth, (1.006, -GIRDLE)))
    for i in range(48):
        azimuth = (i + 0.5) * math.pi / 24.0
        planes.append(((math.cos(azimuth), 0.0, math.sin(azimuth)), radius))
    return planes
