"""A room lit by a lamp that shines into a mirror: nothing sees the lamp but the mirror."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import lathe, merged, revolved, sampled_profile, sphere
from ..room import add_room, table
from ..vector import add, look_at, normalize, scale, standing_on, sub

ROOM_LOW, ROOM_HIGH = (-2.0, 0.0, -1.8), (2.0, 2.6, 2.6)
ALBEDOS = {"white": (0.74, 0.73, 0.70), "blue": (0.25, 0.38, 0.55), "ochre": (0.66, 0.46, 0.20),
           "boards": (0.46, 0.34, 0.24), "wood": (0.30, 0.17, 0.09), "clay": (0.55, 0.22, 0.12),
           "iron": (0.04, 0.04, 0.045)}
WALLS = {"floor": "boards", "ceiling": "white", "left": "blue", "right": "ochre", "back": "white", "front": "white"}

# A paraboloid so deep that all light of the lamp meets it; the curvature of its ripple makes rings. Lengths in metres.
DISH_RADIUS, FOCAL_LENGTH = 0.30, 0.14
RIPPLE, RIPPLES = 0.0009, 2.5
# Of the lamp above the bottom of the dish: below the focus, which spreads the light.
LAMP_HEIGHT = 0.10
DISH_STEPS, DISH_SEGMENTS = 160, 128
DISH_CENTER, DISH_TARGET = (-1.15, 0.75, -0.25), (0.45, 2.15, -1.8)
LAMP_RADIUS, CAP_RADIUS, LAMP_RADIANCE = 0.006, 0.02, (150000.0, 134000.0, 110000.0)


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    materials = {name: scene.add_diffuse(name, albedo) for name, albedo in ALBEDOS.items()}
    add_room(scene, ROOM_LOW, ROOM_HIGH, {side: materials[name] for side, name in WALLS.items()})
    mirror = gltf.add_material("mirror", base_color=(0.95, 0.94, 0.92), metallic=1.0, roughness=0.0)
    scene.render_json["/materials/mirror/conductor"] = {"metal": "Ag", "roughness": 0.0}

    axis = normalize(sub(DISH_TARGET, DISH_CENTER))
    place = {"translation": DISH_CENTER, "rotation": standing_on(axis, 0.0)}
    scene.add_object("dish", revolved(*sampled_profile(_dish, DISH_STEPS), DISH_SEGMENTS), mirror, **place)
    # Back towards the dish; the cap is what others would see of the lamp.
    y = LAMP_HEIGHT
    scene.add_lamp("lamp", lathe(((0.0, y), (LAMP_RADIUS, y)), 32), LAMP_RADIANCE, **place)
    cap = lathe(((LAMP_RADIUS, y), (CAP_RADIUS, y), (CAP_RADIUS, y + 0.03), (0.0, y + 0.04)), 32)
    scene.add_object("cap", cap, materials["iron"], **place)
    scene.add_object("stand", _stand(axis), materials["iron"])

    scene.add_object("table", table(1.1, 0.7, 0.62, 0.05, 0.06), materials["wood"], translation=(0.75, 0.0, -0.55))
    scene.add_object("ball", sphere(0.17, 24), materials["clay"], closed=True, translation=(0.55, 0.79, -0.55))
    vase = lathe(((0.0, 0.0), (0.08, 0.0), (0.13, 0.12), (0.12, 0.24), (0.06, 0.34), (0.09, 0.40), (0.0, 0.40)), 64)
    scene.add_object("vase", vase, materials["blue"], closed=True, translation=(1.02, 0.621, -0.62))
    position = (0.15, 1.25, 2.5)
    gltf.add_camera("camera", position, look_at(position, (0.0, 1.08, 0.0)), yfov=math.radians(50.0),
                    aspect_ratio=4.0 / 3.0)
    return scene


def _dish(t):
    """Radius and height of the mirror, and their derivatives."""
    radius, angle = DISH_RADIUS * t, 2.0 * math.pi * RIPPLES * t
    height = radius ** 2 / (4.0 * FOCAL_LENGTH) + RIPPLE * (math.cos(angle) - 1.0)
    rate = radius * DISH_RADIUS / (2.0 * FOCAL_LENGTH) - RIPPLE * 2.0 * math.pi * RIPPLES * math.sin(angle)
    return radius, height, DISH_RADIUS, rate


def _stand(axis):
    """A foot and a post up to the back of the dish."""
    x, y, z = add(DISH_CENTER, scale(axis, -0.01))
    return merged([lathe(((0.0, 0.0), (0.16, 0.0), (0.15, 0.025), (0.0, 0.03)), 48, center=(x, z)),
                   lathe(((0.018, 0.02), (0.018, y)), 24, center=(x, z))])
