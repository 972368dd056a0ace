"""10,000 instances of one mesh of 50,000 triangles: a torus knot on a rippled disk in a sunflower's pattern."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import Mesh, torus_knot
from ..sky import Sky
from ..vector import look_at, normalize, scale, standing_on

COUNT = 10_000
KNOT_ALONG, KNOT_AROUND = 250, 100
GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))
# Phyllotaxis (Vogel 1979): instance i at the radius SPREAD · sqrt(i) and the angle i · GOLDEN_ANGLE.
SPREAD = 0.62

# The ground is y = AMPLITUDE · cos(WAVE_NUMBER · r) · exp(-(r / DECAY)²).
AMPLITUDE, WAVE_NUMBER, DECAY = 3.0, 0.26, 70.0
GROUND_ALBEDO = (0.26, 0.22, 0.18)
GROUND_RADIUS, GROUND_RINGS, GROUND_SEGMENTS = 400.0, 300, 96

SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY, UNIT = math.radians(32.0), math.radians(250.0), 2.8, 20.0
SKY_WIDTH = 512


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    knot = torus_knot(2, 3, radius=0.34, reach=0.15, tube=0.075, along=KNOT_ALONG, around=KNOT_AROUND, color=_color)
    soil = _ground()
    glaze = gltf.add_material("glaze", base_color=(1.0, 1.0, 1.0), metallic=0.0, roughness=0.25)
    ground = gltf.add_material("ground", base_color=GROUND_ALBEDO, roughness=1.0)
    knot_index = gltf.add_mesh("knot", knot, glaze)
    gltf.add_node("ground", mesh=gltf.add_mesh("ground", soil, ground))
    for i in range(COUNT):
        gltf.add_node(mesh=knot_index, **_placement(i))
    scene.closed_meshes.add("knot")
    scene.triangles = 2 * KNOT_ALONG * KNOT_AROUND + soil.triangle_count

    sky = Sky(SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY, UNIT, GROUND_ALBEDO)
    scene.add_daylight(sky, SKY_WIDTH)
    position = (0.0, 8.5, 45.0)
    gltf.add_camera("camera", position, look_at(position, (0.0, 1.0, 12.0)), yfov=math.radians(38.0),
                    aspect_ratio=16.0 / 9.0)
    return scene


def height(r):
    return AMPLITUDE * math.cos(WAVE_NUMBER * r) * math.exp(-(r / DECAY) ** 2)


def slope(r):
    """dy/dr of `height`."""
    wave = WAVE_NUMBER * math.sin(WAVE_NUMBER * r) + 2.0 * r / DECAY ** 2 * math.cos(WAVE_NUMBER * r)
    return -AMPLITUDE * wave * math.exp(-(r / DECAY) ** 2)


def _placement(i):
    """Translation, rotation and scale of instance `i`, rounded to what a metre-sized thing needs."""
    r, angle = SPREAD * math.sqrt(i + 0.5), i * GOLDEN_ANGLE
    out = (math.cos(angle), math.sin(angle))
    normal = normalize((-slope(r) * out[0], 1.0, -slope(r) * out[1]))
    size = 0.90 + 0.15 * math.sin(0.55 * r)
    center = [a + b for a, b in zip((r * out[0], height(r), r * out[1]), scale(normal, 0.24 * size))]
    return {"translation": [round(c, 5) for c in center],
            # Seven digits keep the quaternion's length within what validators accept.
            "rotation": [round(c, 7) for c in standing_on(normal, 0.618 * i)],
            "scale": [round(size, 5)] * 3}


def _color(s, t):
    """Three hues along the knot, fading into each other, lighter on one side of the tube. Linear, as COLOR_0 is."""
    hues = ((0.80, 0.16, 0.05), (0.85, 0.50, 0.08), (0.08, 0.35, 0.42))
    weights = [max(0.0, math.cos(2.0 * math.pi * (s - i / 3.0))) ** 2 for i in range(3)]
    shade = (0.8 + 0.2 * math.cos(2.0 * math.pi * t)) / sum(weights)
    return [round(255.0 * shade * sum(w * hue[c] for w, hue in zip(weights, hues))) for c in range(3)] + [255]


def _ground():
    """The surface that the instances stand on, as rings about the Y axis with exact normals."""
    mesh = Mesh()
    for ring in range(GROUND_RINGS + 1):
        # Rings are dense where the ripples are high.
        r = GROUND_RADIUS * (ring / GROUND_RINGS) ** 2
        for segment in range(GROUND_SEGMENTS):
            angle = 2.0 * math.pi * segment / GROUND_SEGMENTS
            x, z = math.cos(angle), math.sin(angle)
            mesh.add_vertex((r * x, height(r), r * z), normalize((-slope(r) * x, 1.0, -slope(r) * z)))
    mesh.add_grid(GROUND_SEGMENTS, GROUND_RINGS, wrap_columns=True)
    return mesh
