"""A gold ring on a table in the light of a small lamp from the side: the cardioid that its inner wall throws."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import ground, panel, ring, sphere
from ..vector import add, direction, look_at, scale

# Radius to the middle of the wall, half the wall's thickness, height.
RADIUS, HALF_THICKNESS, HEIGHT = 1.0, 0.05, 0.55
SEGMENTS, ARC_STEPS = 384, 12
TABLE_ALBEDO = (0.68, 0.60, 0.52)
LAMP_ELEVATION, LAMP_AZIMUTH, LAMP_DISTANCE = math.radians(36.0), math.radians(-118.0), 6.0
LAMP_RADIUS, LAMP_RADIANCE, LAMP_FREQUENCY = 0.10, (3600.0, 3300.0, 2900.0), 8
# A dim soft box overhead for the shadows, and for the gold to reflect.
BOX_SIZE, BOX_CENTER, BOX_RADIANCE = 4.0, (0.0, 6.0, -2.0), (0.42, 0.50, 0.64)


def build():
    scene = GeneratedScene()
    scene.add_object("table", ground(5.0), scene.add_diffuse("table", TABLE_ALBEDO))
    gold = scene.gltf.add_material("gold", base_color=(1.00, 0.77, 0.34), metallic=1.0, roughness=0.0)
    scene.render_json["/materials/gold/conductor"] = {"metal": "Au", "roughness": 0.0}
    # A hair above the table.
    scene.add_object("ring", ring(RADIUS, HALF_THICKNESS, HEIGHT, SEGMENTS, ARC_STEPS), gold, closed=True,
                     translation=(0.0, 0.001, 0.0))
    lamp = add((0.0, HEIGHT, 0.0), scale(direction(LAMP_ELEVATION, LAMP_AZIMUTH), LAMP_DISTANCE))
    scene.add_lamp("lamp", sphere(LAMP_RADIUS, LAMP_FREQUENCY), LAMP_RADIANCE, closed=True, translation=lamp)
    scene.add_lamp("soft box", panel(BOX_SIZE, BOX_SIZE), BOX_RADIANCE, translation=BOX_CENTER,
                   rotation=look_at(BOX_CENTER, (0.0, 0.0, 0.0)))
    position = (0.0, 4.3, 3.5)
    scene.gltf.add_camera("camera", position, look_at(position, (0.12, 0.1, 0.05)), yfov=math.radians(29.0),
                          aspect_ratio=4.0 / 3.0)
    return scene
