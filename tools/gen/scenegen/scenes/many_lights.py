"""10,000 small lamps in a sunflower's pattern over a hilly field at night, among white balls."""

import math
from array import array

from ..generated_scene import GeneratedScene
from ..gltf import FLOAT
from ..mesh import Mesh, sphere
from ..vector import look_at, normalize

COUNT = 10_000
GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))
# Phyllotaxis (Vogel 1979): lamp i at the radius SPREAD · sqrt(i) and the angle i · GOLDEN_ANGLE.
SPREAD = 0.20
# Lamps of one hue are instances of one mesh; hues follow each other from the middle outwards.
HUES = ((1.00, 0.42, 0.10), (1.00, 0.62, 0.22), (1.00, 0.30, 0.28), (0.80, 0.24, 0.62), (0.42, 0.34, 1.00),
        (0.22, 0.52, 1.00), (0.20, 0.80, 0.92), (0.38, 0.92, 0.60))
LAMP_RADIUS, LAMP_HEIGHT, LAMP_RADIANCE, LAMP_FREQUENCY = 0.018, 0.07, 36.0, 1

# Hills: height · exp(-(distance / width)²) at (x, z).
HILLS = ((1.6, 4.2, -6.0, -8.0), (1.2, 3.4, 6.5, -6.0), (0.9, 3.0, 0.5, -2.5), (-0.5, 3.0, -5.0, 2.0),
         (2.4, 6.0, 3.0, -16.0), (0.5, 2.2, 4.5, 4.0))
FIELD_RADIUS, FIELD_RINGS, FIELD_SEGMENTS = 30.0, 120, 160
# x, z and radius.
BALLS = ((-2.6, 3.2, 0.75), (2.7, 1.2, 1.0), (-5.5, -2.5, 1.3), (0.6, 7.2, 0.42), (7.4, 0.6, 0.8), (-0.2, -6.5, 1.2))


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    scene.add_object("field", _field(), scene.add_diffuse("field", (0.42, 0.40, 0.38)))
    ball = sphere(1.0, 20)
    white = scene.add_diffuse("white", (0.78, 0.78, 0.78))
    index = gltf.add_mesh("ball", ball, white)
    scene.triangles += ball.triangle_count
    scene.closed_meshes.add("ball")
    for i, (x, z, radius) in enumerate(BALLS):
        gltf.add_node(f"ball {i + 1}", mesh=index, translation=(x, height(x, z) + 0.85 * radius, z),
                      scale=(radius, radius, radius))
    _add_lamps(scene)
    position = (0.0, 4.6, 14.5)
    gltf.add_camera("camera", position, look_at(position, (0.0, 0.1, 0.0)), yfov=math.radians(36.0),
                    aspect_ratio=16.0 / 9.0)
    return scene


def height(x, z):
    return sum(top * math.exp(-((x - hx) ** 2 + (z - hz) ** 2) / width ** 2) for top, width, hx, hz in HILLS)


def normal(x, z):
    along_x = along_z = 0.0
    for top, width, hx, hz in HILLS:
        rate = -2.0 * top * math.exp(-((x - hx) ** 2 + (z - hz) ** 2) / width ** 2) / width ** 2
        along_x, along_z = along_x + rate * (x - hx), along_z + rate * (z - hz)
    return normalize((-along_x, 1.0, -along_z))


def _add_lamps(scene):
    scene.gltf.use_extension("EXT_mesh_gpu_instancing", required=True)
    places = [array("f") for _ in HUES]
    for i in range(COUNT):
        r, angle = SPREAD * math.sqrt(i + 0.5), i * GOLDEN_ANGLE
        x, z = r * math.cos(angle), r * math.sin(angle)
        # Bands with frayed edges: each lamp is drawn a little inwards or outwards.
        band = len(HUES) * math.sqrt(i / COUNT) + 0.9 * (0.618 * i % 1.0 - 0.5)
        y = height(x, z) + LAMP_HEIGHT
        places[min(max(int(band), 0), len(HUES) - 1)].extend((x, y, z))
    bulb = sphere(LAMP_RADIUS, LAMP_FREQUENCY)
    for i, (hue, translations) in enumerate(zip(HUES, places)):
        attributes = {"TRANSLATION": scene.gltf.add_accessor(translations, FLOAT, "VEC3")}
        scene.add_lamp(f"lamps {i + 1}", bulb, [LAMP_RADIANCE * c for c in hue], closed=True,
                       extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})


def _field():
    """Rings about the Y axis, dense in the middle, with exact normals."""
    mesh = Mesh()
    for ring in range(FIELD_RINGS + 1):
        r = FIELD_RADIUS * (ring / FIELD_RINGS) ** 1.3
        for segment in range(FIELD_SEGMENTS):
            angle = 2.0 * math.pi * segment / FIELD_SEGMENTS
            x, z = r * math.cos(angle), r * math.sin(angle)
            mesh.add_vertex((x, height(x, z), z), normal(x, z))
    mesh.add_grid(FIELD_SEGMENTS, FIELD_RINGS, wrap_columns=True)
    return mesh
