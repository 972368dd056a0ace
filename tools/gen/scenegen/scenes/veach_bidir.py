"""A room with two lamps that hide their bulbs and a glass egg on a table, after the scene by which Veach showed
bidirectional path tracing: "Bidirectional Estimators for Light Transport" (EGRW 1994) and figure 10.3 of his thesis
(1997). The model is our own."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import lathe, merged, revolved, sampled_profile, sphere
from ..room import add_room
from ..vector import add, look_at, normalize, scale, standing_on, sub

ROOM_LOW, ROOM_HIGH = (-2.0, 0.0, -2.0), (2.0, 2.6, 2.4)
ALBEDOS = {"wall": (0.62, 0.60, 0.56), "ceiling": (0.78, 0.78, 0.76), "floor": (0.42, 0.28, 0.19),
           "table": (0.34, 0.20, 0.12), "brass": (0.45, 0.32, 0.12), "shade": (0.30, 0.30, 0.31),
           "iron": (0.03, 0.03, 0.035)}
WALLS = {"floor": "floor", "ceiling": "ceiling", "left": "wall", "right": "wall", "back": "wall", "front": "wall"}

TABLE_CENTER, TABLE_HEIGHT, TABLE_RADIUS = (0.25, 0.0), 0.62, 0.75
EGG_HALF_HEIGHT, EGG_RADIUS, EGG_POINTEDNESS, EGG_STEPS, EGG_SEGMENTS = 0.17, 0.125, 0.16, 96, 160
EGG_CENTER = (0.10, TABLE_HEIGHT + EGG_HALF_HEIGHT + 0.0005, 0.10)

# The standing lamp, open above.
STAND, SHADE_LOW, SHADE_HIGH = (-1.35, -1.15), (0.07, 1.55), (0.20, 1.78)
BULB_RADIUS, BULB_RADIANCE = 0.045, (1500.0, 1250.0, 920.0)
# The spot: a tube with a bulb at its far end, from the wall towards the egg.
TUBE_RADIUS, TUBE_LENGTH, TUBE_CENTER = 0.075, 0.30, (1.45, 1.95, -0.75)
SPOT_RADIUS, SPOT_RADIANCE = 0.035, (7000.0, 6500.0, 5900.0)


def build():
    scene = GeneratedScene()
    materials = {name: scene.add_diffuse(name, albedo) for name, albedo in ALBEDOS.items()}
    add_room(scene, ROOM_LOW, ROOM_HIGH, {side: materials[name] for side, name in WALLS.items()})
    scene.add_object("table", _table(), materials["table"])
    glass = scene.add_glass("glass", 1.5, thickness=2.0 * EGG_RADIUS)
    scene.add_object("egg", revolved(*sampled_profile(_egg, EGG_STEPS), EGG_SEGMENTS), glass, closed=True,
                     translation=EGG_CENTER)
    _add_standing_lamp(scene, materials)
    _add_spot(scene, materials)
    position = (-0.25, 1.35, 2.2)
    scene.gltf.add_camera("camera", position, look_at(position, (0.02, 1.02, -0.6)), yfov=math.radians(50.0),
                          aspect_ratio=4.0 / 3.0)
    return scene


def _egg(t):
    """Radius and height of the egg's outline, and their derivatives; the blunt end is below."""
    angle, k = math.pi * t, EGG_POINTEDNESS
    s, c = math.sin(angle), math.cos(angle)
    return (max(0.0, EGG_RADIUS * s * (1.0 + k * c)), -EGG_HALF_HEIGHT * c,
            EGG_RADIUS * (c + k * math.cos(2.0 * angle)), EGG_HALF_HEIGHT * s)


def _table():
    top, r = TABLE_HEIGHT, TABLE_RADIUS
    return merged([lathe(profile, 96, center=TABLE_CENTER) for profile in (
        ((0.0, top - 0.04), (r - 0.02, top - 0.04), (r, top - 0.02), (r, top), (0.0, top)),
        ((0.0, 0.0), (0.30, 0.0), (0.28, 0.03), (0.06, 0.06), (0.05, top - 0.03)))])


def _add_standing_lamp(scene, materials):
    x, z = STAND
    post = [lathe(profile, 48, center=STAND) for profile in (
        ((0.0, 0.0), (0.17, 0.0), (0.16, 0.025), (0.0, 0.03)), ((0.014, 0.02), (0.014, SHADE_LOW[1])))]
    scene.add_object("stand", merged(post), materials["brass"])
    scene.add_object("shade", lathe(((0.0, SHADE_LOW[1]), SHADE_LOW, SHADE_HIGH), 96, center=STAND),
                     materials["shade"])
    scene.add_lamp("bulb", sphere(BULB_RADIUS, 8), BULB_RADIANCE, closed=True,
                   translation=(x, SHADE_LOW[1] + BULB_RADIUS + 0.03, z))


def _add_spot(scene, materials):
    """In a frame of its own, in which it shines along +Y from the origin."""
    axis = normalize(sub(EGG_CENTER, TUBE_CENTER))
    place = {"translation": TUBE_CENTER, "rotation": standing_on(axis, 0.0)}
    tube = lathe(((0.0, -0.02), (TUBE_RADIUS, -0.02), (TUBE_RADIUS, TUBE_LENGTH)), 64)
    scene.add_object("tube", tube, materials["iron"], **place)
    scene.add_lamp("spot", lathe(((SPOT_RADIUS, 0.0), (0.0, 0.0)), 32), SPOT_RADIANCE, **place)
    x, _, z = add(TUBE_CENTER, scale(axis, 0.1))
    scene.add_object("rod", lathe(((0.012, TUBE_CENTER[1]), (0.012, ROOM_HIGH[1])), 24, center=(x, z)),
                     materials["brass"])
