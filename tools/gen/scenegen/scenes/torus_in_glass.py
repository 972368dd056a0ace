"""A matte torus in a block of glass under a small lamp: all that is seen of it is light that passes the glass twice."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import box, ground, panel, revolved
from ..vector import look_at

GROUND_ALBEDO, TORUS_ALBEDO = (0.55, 0.53, 0.50), (0.78, 0.28, 0.10)
# A hair above the ground.
BLOCK_LOW, BLOCK_HIGH, INDEX = (-0.6, 0.001, -0.6), (0.6, 0.761, 0.6), 1.5
TORUS_RADIUS, TUBE_RADIUS, TORUS_HEIGHT = 0.30, 0.115, 0.36
SEGMENTS, TUBE_SEGMENTS, TILT = 160, 64, math.radians(24.0)
LAMP_SIZE, LAMP_CENTER, LAMP_RADIANCE = 0.10, (-1.3, 2.5, 0.9), (900.0, 840.0, 740.0)
BOX_SIZE, BOX_CENTER, BOX_RADIANCE = 5.0, (1.0, 5.0, -2.0), (0.30, 0.36, 0.46)


def build():
    scene = GeneratedScene()
    scene.add_object("ground", ground(4.0), scene.add_diffuse("ground", GROUND_ALBEDO))
    glass = scene.add_glass("glass", INDEX, thickness=BLOCK_HIGH[1] - BLOCK_LOW[1])
    scene.add_object("block", box(BLOCK_LOW, BLOCK_HIGH), glass, closed=True)
    tilt = (math.sin(0.5 * TILT), 0.0, 0.0, math.cos(0.5 * TILT))
    scene.add_object("torus", _torus(), scene.add_diffuse("torus", TORUS_ALBEDO), closed=True,
                     translation=(0.0, TORUS_HEIGHT, 0.0), rotation=tilt)
    scene.add_lamp("lamp", panel(LAMP_SIZE, LAMP_SIZE), LAMP_RADIANCE, translation=LAMP_CENTER,
                   rotation=look_at(LAMP_CENTER, (0.0, 0.3, 0.0)))
    scene.add_lamp("soft box", panel(BOX_SIZE, BOX_SIZE), BOX_RADIANCE, translation=BOX_CENTER,
                   rotation=look_at(BOX_CENTER, (0.0, 0.0, 0.0)))
    position = (0.95, 1.75, 2.55)
    scene.gltf.add_camera("camera", position, look_at(position, (0.02, 0.31, 0.05)), yfov=math.radians(29.0),
                          aspect_ratio=4.0 / 3.0)
    return scene


def _torus():
    angles = [2.0 * math.pi * i / TUBE_SEGMENTS for i in range(TUBE_SEGMENTS)]
    normals = [(math.cos(angle), math.sin(angle)) for angle in angles]
    points = [(TORUS_RADIUS + TUBE_RADIUS * radial, TUBE_RADIUS * up) for radial, up in normals]
    return revolved(points, normals, SEGMENTS, loop=True)
