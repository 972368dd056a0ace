"""The Cornell box, from the data that the Cornell University Program of Computer Graphics measured and published
(https://www.graphics.cornell.edu/online/box/data.html, state of 1998). Published in mm, here in m.

Looking along +Z with +Y up, +X is on the left: the red wall at x ≈ 556 is left and the green one at x = 0 is right, as
in the published image, without mirroring.
"""

import math

from ..generated_scene import GeneratedScene
from ..mesh import Mesh
from ..spectra import emission_to_rec709, reflectance_to_rec709

_WAVELENGTHS = range(400, 701, 4)

WHITE = dict(zip(_WAVELENGTHS, (
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739, 0.767, 0.777, 0.765,
    0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747, 0.735, 0.732, 0.739, 0.734, 0.725, 0.721,
    0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736,
    0.734, 0.741, 0.740, 0.732, 0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.730,
    0.727, 0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740, 0.737)))

GREEN = dict(zip(_WAVELENGTHS, (
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096, 0.101, 0.103, 0.104,
    0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285, 0.343, 0.390, 0.435, 0.464, 0.472, 0.476,
    0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207,
    0.186, 0.171, 0.160, 0.148, 0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117,
    0.118, 0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157, 0.159)))

RED = dict(zip(_WAVELENGTHS, (
    0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061, 0.061, 0.060, 0.062,
    0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058, 0.056, 0.055, 0.056, 0.059, 0.057, 0.055,
    0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154,
    0.192, 0.255, 0.287, 0.349, 0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606, 0.609, 0.651, 0.612, 0.610,
    0.650, 0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642)))

LIGHT_EMISSION = {400: 0.0, 500: 8.0, 600: 15.6, 700: 18.4}
LIGHT_REFLECTANCE = 0.78
# The unit of the published emission is not stated. Twice its values exposes the picture without further settings.
LIGHT_SCALE = 2.0

LIGHT = ((343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0))
FLOOR = ((552.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 559.2), (549.6, 0.0, 559.2))
CEILING = ((556.0, 548.8, 0.0), (556.0, 548.8, 559.2), (0.0, 548.8, 559.2), (0.0, 548.8, 0.0))
BACK_WALL = ((549.6, 0.0, 559.2), (0.0, 0.0, 559.2), (0.0, 548.8, 559.2), (556.0, 548.8, 559.2))
GREEN_WALL = ((0.0, 0.0, 559.2), (0.0, 0.0, 0.0), (0.0, 548.8, 0.0), (0.0, 548.8, 559.2))
RED_WALL = ((552.8, 0.0, 0.0), (549.6, 0.0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0.0))

SHORT_BLOCK = (
    ((130.0, 165.0, 65.0), (82.0, 165.0, 225.0), (240.0, 165.0, 272.0), (290.0, 165.0, 114.0)),
    ((290.0, 0.0, 114.0), (290.0, 165.0, 114.0), (240.0, 165.0, 272.0), (240.0, 0.0, 272.0)),
    ((130.0, 0.0, 65.0), (130.0, 165.0, 65.0), (290.0, 165.0, 114.0), (290.0, 0.0, 114.0)),
    ((82.0, 0.0, 225.0), (82.0, 165.0, 225.0), (130.0, 165.0, 65.0), (130.0, 0.0, 65.0)),
    ((240.0, 0.0, 272.0), (240.0, 165.0, 272.0), (82.0, 165.0, 225.0), (82.0, 0.0, 225.0)))

TALL_BLOCK = (
    ((423.0, 330.0, 247.0), (265.0, 330.0, 296.0), (314.0, 330.0, 456.0), (472.0, 330.0, 406.0)),
    ((423.0, 0.0, 247.0), (423.0, 330.0, 247.0), (472.0, 330.0, 406.0), (472.0, 0.0, 406.0)),
    ((472.0, 0.0, 406.0), (472.0, 330.0, 406.0), (314.0, 330.0, 456.0), (314.0, 0.0, 456.0)),
    ((314.0, 0.0, 456.0), (314.0, 330.0, 456.0), (265.0, 330.0, 296.0), (265.0, 0.0, 296.0)),
    ((265.0, 0.0, 296.0), (265.0, 330.0, 296.0), (423.0, 330.0, 247.0), (423.0, 0.0, 247.0)))

# Camera: a film of 25 mm × 25 mm behind a focal length of 35 mm.
CAMERA_POSITION = (278.0, 273.0, -800.0)
CAMERA_YFOV = 2.0 * math.atan(0.5 * 25.0 / 35.0)


def build():
    scene, white = room()
    scene.gltf.add_node("short block", mesh=scene.gltf.add_mesh("short block", _quads(SHORT_BLOCK), white))
    scene.gltf.add_node("tall block", mesh=scene.gltf.add_mesh("tall block", _quads(TALL_BLOCK), white))
    # Two triangles for each of the 4 walls and floors, the light and the 10 faces; 8 for the ceiling around the light.
    scene.triangles = 2 * (4 + 1 + 10) + 8
    return scene


def room():
    """The empty room with its light and camera, for other scenes too, and the index of the white material."""
    scene = GeneratedScene()
    gltf = scene.gltf
    albedos = {"white": reflectance_to_rec709(WHITE), "green": reflectance_to_rec709(GREEN),
               "red": reflectance_to_rec709(RED), "light": [LIGHT_REFLECTANCE] * 3}
    scene.render_json = {f"/materials/{name}/diffuse/albedo": albedo for name, albedo in albedos.items()}
    emission = [LIGHT_SCALE * c for c in emission_to_rec709(LIGHT_EMISSION)]
    materials = {name: gltf.add_material(name, base_color=albedo, emission=emission if name == "light" else None)
                 for name, albedo in albedos.items()}
    for name, quads, material in (
            ("floor", [FLOOR], "white"), ("ceiling", _frame(CEILING, LIGHT), "white"),
            ("back wall", [BACK_WALL], "white"), ("green wall", [GREEN_WALL], "green"),
            ("red wall", [RED_WALL], "red"), ("light", [LIGHT], "light")):
        gltf.add_node(name, mesh=gltf.add_mesh(name, _quads(quads), materials[material]))
    # Looking along +Z is half a turn about +Y.
    gltf.add_camera("camera", position=tuple(1e-3 * c for c in CAMERA_POSITION), rotation=[0.0, 1.0, 0.0, 0.0],
                    yfov=CAMERA_YFOV, aspect_ratio=1.0)
    return scene, materials["white"]


def _quads(corner_lists):
    mesh = Mesh()
    for corners in corner_lists:
        mesh.add_quad([tuple(1e-3 * c for c in corner) for corner in corners])
    return mesh


def _frame(outer, inner):
    """The quadrilateral `outer` without `inner`: the published light lies in the ceiling's plane, so it gets a hole."""
    return [(outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]) for i in range(4)]
