"""A room lit by the gap of a door that is ajar: after the scene by which Veach and Guibas showed Metropolis light
transport (SIGGRAPH 1997). The model is our own."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import box, lathe, merged, panel, rectangle, sphere
from ..patterns import planks, plaster
from ..room import add_room, table
from ..vector import look_at, scale, standing_on

LOW, HIGH = (-2.0, 0.0, -1.6), (2.0, 2.5, 2.6)
# The room behind the door; the wall between them is what is left.
BEHIND_LOW, BEHIND_HIGH = (-3.4, 0.0, -4.2), (0.8, 2.5, -1.72)
# The opening's left edge, the width and height of the door, which opens into the room behind.
DOOR_LEFT, DOOR_WIDTH, DOOR_HEIGHT, DOOR_THICKNESS, DOOR_ANGLE = -1.25, 0.85, 2.05, 0.04, math.radians(14.0)
ALBEDOS = {"white": (0.72, 0.70, 0.66), "door": (0.55, 0.50, 0.42), "frame": (0.30, 0.20, 0.12),
           "wood": (0.36, 0.20, 0.10), "clay": (0.62, 0.60, 0.55), "cloth": (0.45, 0.09, 0.06)}
LAMP_SIZE, LAMP_CENTER, LAMP_RADIANCE = (0.8, 0.8), (-2.3, 2.45, -2.8), (700.0, 620.0, 510.0)
UV_PER_METER = 0.5
TABLE_TOP, TABLE_CENTER = 0.74, (0.25, 0.35)

# Profiles (radius, height) from bottom to top; those of vessels go on downwards inside.
JUG = ((0.0, 0.0), (0.09, 0.0), (0.13, 0.05), (0.135, 0.11), (0.11, 0.17), (0.065, 0.22), (0.06, 0.27), (0.08, 0.30),
       (0.075, 0.30), (0.055, 0.27), (0.06, 0.22), (0.0, 0.15))
BOWL = ((0.0, 0.0), (0.07, 0.0), (0.08, 0.015), (0.15, 0.08), (0.17, 0.13), (0.16, 0.13), (0.14, 0.085), (0.0, 0.03))


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    materials = {name: scene.add_diffuse(name, albedo) for name, albedo in ALBEDOS.items()}
    materials["boards"] = gltf.add_material("boards", roughness=0.35, base_color_texture=gltf.add_texture(
        "boards", planks(256, 6, (0.16, 0.09, 0.05), (0.42, 0.27, 0.15))))
    materials["plaster"] = gltf.add_material("plaster", base_color_texture=gltf.add_texture(
        "plaster", plaster(128, (0.58, 0.57, 0.50), 0.25)))
    _add_rooms(scene, materials)
    _add_door(scene, materials)
    _add_table(scene, materials)
    position = (0.85, 1.30, 1.95)
    gltf.add_camera("camera", position, look_at(position, (-0.12, 0.90, -0.3)), yfov=math.radians(44.0),
                    aspect_ratio=16.0 / 9.0)
    return scene


def _add_rooms(scene, materials):
    left = DOOR_LEFT - LOW[0]
    walls = {side: materials["plaster"] for side in ("left", "right", "back", "front")}
    add_room(scene, LOW, HIGH, {"floor": materials["boards"], "ceiling": materials["white"], **walls},
             {"back": [((left, 0.0), (left + DOOR_WIDTH, DOOR_HEIGHT))]}, UV_PER_METER)
    right = BEHIND_HIGH[0] - DOOR_LEFT - DOOR_WIDTH
    walls = {side: materials["white"] for side in ("ceiling", "left", "right", "back", "front")}
    add_room(scene, BEHIND_LOW, BEHIND_HIGH, {"floor": materials["boards"], **walls},
             {"front": [((right, 0.0), (right + DOOR_WIDTH, DOOR_HEIGHT))]}, UV_PER_METER, prefix="behind ")
    # Overhead, facing down.
    scene.add_lamp("lamp", panel(*LAMP_SIZE), LAMP_RADIANCE, translation=LAMP_CENTER,
                   rotation=standing_on((0.0, 0.0, 1.0), 0.0))


def _add_door(scene, materials):
    """The sides of the opening, a frame around it on our side, and the leaf on hinges at its right."""
    x0, x1, y1 = DOOR_LEFT, DOOR_LEFT + DOOR_WIDTH, DOOR_HEIGHT
    z0, z1 = BEHIND_HIGH[2], LOW[2]
    deep, up = (0.0, 0.0, z1 - z0), (0.0, y1, 0.0)
    scene.add_object("reveal", merged([
        rectangle((x0, 0.0, z1), scale(deep, -1.0), up), rectangle((x1, 0.0, z0), deep, up),
        rectangle((x0, y1, z0), (x1 - x0, 0.0, 0.0), deep),
        rectangle((x0, 0.0, z1), (x1 - x0, 0.0, 0.0), scale(deep, -1.0))]), materials["frame"])
    w, d = 0.08, 0.02
    scene.add_object("frame", merged([
        box((x0 - w, 0.0, z1), (x0, y1 + w, z1 + d)), box((x1, 0.0, z1), (x1 + w, y1 + w, z1 + d)),
        box((x0, y1, z1), (x1, y1 + w, z1 + d))]), materials["frame"])
    leaf = box((0.004 - DOOR_WIDTH, 0.004, -DOOR_THICKNESS), (0.0, DOOR_HEIGHT - 0.004, 0.0))
    x, y, half = 0.07 - DOOR_WIDTH, 1.02, 0.008
    knob = merged([sphere(0.028, 12, center=(x, y, 0.05)),
                   box((x - half, y - half, 0.0), (x + half, y + half, 0.04))])
    hinge = {"translation": (x1 - 0.002, 0.0, z0 + DOOR_THICKNESS),
             "rotation": (0.0, -math.sin(0.5 * DOOR_ANGLE), 0.0, math.cos(0.5 * DOOR_ANGLE))}
    scene.add_object("door", leaf, materials["door"], closed=True, **hinge)
    scene.add_object("knob", knob, _metal(scene, "brass", (0.89, 0.72, 0.37), 0.25), **hinge)


def _add_table(scene, materials):
    """Glass, metal and clay side by side."""
    x, z = TABLE_CENTER

    def place(dx, dz):
        # A hair above the table.
        return {"translation": (x + dx, TABLE_TOP + 0.0005, z + dz)}

    scene.add_object("table", table(1.5, 0.85, TABLE_TOP, 0.05, 0.07), materials["wood"], translation=(x, 0.0, z))
    cloth = box((-0.22, 0.0, -0.43), (0.22, 0.004, 0.43))
    scene.add_object("cloth", cloth, materials["cloth"], closed=True, **place(0.0, 0.0))
    glass = scene.add_glass("glass", 1.5, thickness=0.26)
    ball = sphere(0.13, 32, center=(0.0, 0.13, 0.0))
    scene.add_object("ball", ball, glass, closed=True, **place(-0.48, 0.08))
    steel = _metal(scene, "steel", (0.62, 0.62, 0.64), 0.12)
    scene.add_object("jug", lathe(JUG, 96), steel, closed=True, **place(0.02, 0.02))
    scene.add_object("bowl", lathe(BOWL, 96), materials["clay"], closed=True, **place(0.48, 0.06))


def _metal(scene, name, color, roughness):
    return scene.gltf.add_material(name, base_color=color, metallic=1.0, roughness=roughness)
