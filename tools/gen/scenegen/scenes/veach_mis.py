"""Plates and lights for multiple importance sampling, after Veach and Guibas, "Optimally Combining Sampling Techniques
for Monte Carlo Rendering", SIGGRAPH 1995, and figure 9.2 of Veach's thesis (1997).

Positions follow the port that circulates with several renderers: a row of spheres of equal power along the X axis, four
plates below it, the camera in front. The tilt of each plate is not tabulated but derived: it mirrors the row of lights
into the camera.
"""

import math

from ..generated_scene import GeneratedScene
from ..mesh import Mesh, sphere
from ..spectra import luminance
from ..vector import add, cross, look_at, normalize, scale, sub

CAMERA_POSITION, CAMERA_TARGET, CAMERA_YFOV = (0.0, 2.0, 15.0), (0.0, -2.0, 2.5), math.radians(28.0)

# Name, centre of the plate in (y, z), and the GGX α of Veach's increasing blur; perceptual roughness is its root.
PLATES = (
    ("plate 1", (-2.39513, -0.13512), 0.005),
    ("plate 2", (-3.06341, 0.92313), 0.020),
    ("plate 3", (-3.58237, 2.22305), 0.050),
    ("plate 4", (-3.90842, 3.57446), 0.100))
PLATE_LENGTH, PLATE_DEPTH = 8.0, 1.0

# Name, x and radius of each sphere, and a hue, which is scaled to equal luminance: π L 4 π r² is the same for all.
LIGHTS = (
    ("light 1", -3.75, 1.0 / 30.0, (1.00, 0.55, 0.30)),
    ("light 2", -1.25, 0.1, (1.00, 0.90, 0.45)),
    ("light 3", 1.25, 0.3, (0.50, 1.00, 0.60)),
    ("light 4", 3.75, 0.9, (0.45, 0.65, 1.00)))
RADIANCE_TIMES_RADIUS_SQUARED = 1.0
LIGHT_FREQUENCY = 12

# A fifth, outside of the picture, that makes the room visible without drowning the reflections.
FILL_CENTER, FILL_RADIUS, FILL_RADIANCE = (10.0, 10.0, 4.0), 0.5, 250.0

FLOOR_Y, WALL_Z, ROOM_HALF_SIZE = -4.14615, -2.0, 10.0
ROOM_ALBEDO = 0.4


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    for name, center, alpha in PLATES:
        roughness = math.sqrt(alpha)
        material = gltf.add_material(name, base_color=(0.55, 0.56, 0.55), metallic=1.0, roughness=roughness)
        scene.add_object(name, _plate((0.0, *center)), material)
        scene.render_json[f"/materials/{name}/conductor"] = {"metal": "Cr", "roughness": roughness}
    scene.add_object("room", _room(), scene.add_diffuse("room", (ROOM_ALBEDO,) * 3))

    for name, x, radius, hue in LIGHTS:
        radiance = RADIANCE_TIMES_RADIUS_SQUARED / radius ** 2
        scene.add_lamp(name, sphere(radius, LIGHT_FREQUENCY), scale(hue, radiance / luminance(hue)), closed=True,
                       translation=(x, 0.0, 0.0))
    scene.add_lamp("fill", sphere(FILL_RADIUS, LIGHT_FREQUENCY), (FILL_RADIANCE,) * 3, closed=True,
                   translation=FILL_CENTER)

    gltf.add_camera("camera", CAMERA_POSITION, look_at(CAMERA_POSITION, CAMERA_TARGET), CAMERA_YFOV, 1.5)
    return scene


def _plate(center):
    """Its normal halves the angle between the directions to the lights' row and to the camera."""
    to_lights = normalize(scale(center, -1.0))
    to_camera = normalize(sub((0.0, *CAMERA_POSITION[1:]), center))
    normal = normalize(add(to_lights, to_camera))
    across = (0.5 * PLATE_LENGTH, 0.0, 0.0)
    back = scale(cross(normal, (1.0, 0.0, 0.0)), 0.5 * PLATE_DEPTH)
    mesh = Mesh()
    mesh.add_quad([add(center, corner) for corner in (
        scale(add(across, back), -1.0), sub(across, back), add(across, back), sub(back, across))])
    return mesh


def _room():
    h, y, z = ROOM_HALF_SIZE, FLOOR_Y, WALL_Z
    mesh = Mesh()
    mesh.add_quad([(-h, y, h), (h, y, h), (h, y, -h), (-h, y, -h)])
    mesh.add_quad([(-h, -h, z), (h, -h, z), (h, h, z), (-h, h, z)])
    return mesh
