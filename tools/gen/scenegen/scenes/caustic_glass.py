"""A glass sphere on the floor of a room under one small lamp: half of a picture that path tracing finds at once, and a
caustic that it finds by chance."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import panel, sphere
from ..room import add_room
from ..vector import look_at

ROOM_LOW, ROOM_HIGH = (-1.0, 0.0, -1.0), (1.0, 1.9, 1.0)
ALBEDOS = {"white": (0.72, 0.71, 0.69), "rust": (0.62, 0.20, 0.11), "teal": (0.10, 0.36, 0.40)}
WALLS = {"floor": "white", "ceiling": "white", "left": "rust", "right": "teal", "back": "white"}

# A hair above the floor, which it would otherwise touch in a vertex.
SPHERE_RADIUS, SPHERE_CENTER, SPHERE_FREQUENCY = 0.34, (-0.25, 0.341, -0.15), 40
INDEX = 1.5
LAMP_SIZE, LAMP_CENTER, LAMP_RADIANCE = 0.04, (-0.93, 1.12, -0.75), (3200.0, 3000.0, 2700.0)


def build(sphere_frequency=SPHERE_FREQUENCY):
    scene = GeneratedScene()
    materials = {name: scene.add_diffuse(name, albedo) for name, albedo in ALBEDOS.items()}
    add_room(scene, ROOM_LOW, ROOM_HIGH, {side: materials[name] for side, name in WALLS.items()})
    glass = scene.add_glass("glass", INDEX, thickness=2.0 * SPHERE_RADIUS)
    scene.add_object("sphere", sphere(SPHERE_RADIUS, sphere_frequency), glass, closed=True, translation=SPHERE_CENTER)
    scene.add_lamp("lamp", panel(LAMP_SIZE, LAMP_SIZE), LAMP_RADIANCE, translation=LAMP_CENTER,
                   rotation=look_at(LAMP_CENTER, SPHERE_CENTER))
    position = (0.3, 1.5, 2.9)
    scene.gltf.add_camera("camera", position, look_at(position, (0.02, 0.56, 0.0)), yfov=math.radians(34.0),
                          aspect_ratio=1.0)
    return scene
