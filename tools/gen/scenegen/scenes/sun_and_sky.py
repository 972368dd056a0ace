"""A round temple with a pool under a clear sky: a directional light for the sun, an image for the sky."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import Mesh, dome, ground, lathe, merged, sphere
from ..sky import Sky
from ..vector import look_at

SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY = math.radians(38.0), math.radians(228.0), 3.0
# Radiance 1 is 20 kcd/m²: a white wall in this sun is then about as bright as white on a display.
UNIT = 20.0
GROUND_ALBEDO = (0.30, 0.29, 0.22)
SKY_WIDTH = 512

COLUMNS, COLUMN_CIRCLE = 12, 4.15
SEGMENTS = 96

# Profiles (radius, height) from bottom to top.
STEPS = ((0.0, -0.1), (6.2, -0.1), (6.2, 0.3), (5.6, 0.3), (5.6, 0.6), (5.0, 0.6), (5.0, 0.9), (0.0, 0.9))
COLUMN = ((0.0, 0.85), (0.48, 0.85), (0.48, 1.02), (0.40, 1.10), (0.36, 2.40), (0.31, 4.50), (0.34, 4.56),
          (0.46, 4.72), (0.46, 4.90), (0.0, 4.90))
ENTABLATURE = ((3.70, 4.85), (4.60, 4.85), (4.60, 5.25), (4.66, 5.25), (4.66, 5.55), (4.95, 5.65), (4.95, 5.85),
               (3.70, 5.85), (3.70, 4.85))
DRUM = ((4.20, 5.80), (4.20, 6.25), (4.05, 6.25))
DOME_RADIUS, DOME_BASE = 4.05, 6.25
FINIAL_RADIUS = 0.32

# The pool: low and high corner of its water in (x, z), and its rim.
POOL = ((-3.0, 8.0), (3.0, 16.0))
WATER_LEVEL, RIM_HEIGHT, RIM_WIDTH = 0.22, 0.38, 0.45

# x, z and height of the trees.
TREES = ((-9.5, -2.0, 6.5), (-11.5, 3.5, 5.0), (-13.0, -7.5, 7.5),
         (9.5, -4.5, 6.0), (7.5, -22.0, 7.5), (14.2, -16.0, 8.0))


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    stone = gltf.add_material("stone", base_color=(0.68, 0.63, 0.54), roughness=0.8)
    meshes = {
        "ground": (ground(400.0), gltf.add_material("ground", base_color=GROUND_ALBEDO, roughness=1.0)),
        "steps": (lathe(STEPS, SEGMENTS), stone),
        "column": (lathe(COLUMN, SEGMENTS // 2), stone),
        "entablature": (lathe(ENTABLATURE, SEGMENTS), stone),
        "roof": (merged([lathe(DRUM, SEGMENTS), dome(DOME_RADIUS, DOME_BASE, SEGMENTS, SEGMENTS // 4)]),
                 gltf.add_material("roof", base_color=(0.42, 0.13, 0.07), roughness=0.55, double_sided=True)),
        "finial": (sphere(FINIAL_RADIUS, 12),
                   gltf.add_material("gilding", base_color=(1.0, 0.77, 0.34), metallic=1.0, roughness=0.2)),
        "rim": (_rim(), stone),
        "water": (_water(), gltf.add_material("water", base_color=(0.01, 0.035, 0.045), roughness=0.03)),
        "tree": (sphere(1.0, 16), gltf.add_material("tree", base_color=(0.035, 0.085, 0.025), roughness=0.9)),
    }
    indices = {name: gltf.add_mesh(name, mesh, material) for name, (mesh, material) in meshes.items()}
    scene.triangles = sum(mesh.triangle_count for mesh, _ in meshes.values())
    scene.closed_meshes = {"steps", "column", "entablature", "finial", "rim", "tree"}
    _place(gltf, indices)

    sky = Sky(SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY, UNIT, GROUND_ALBEDO)
    scene.add_daylight(sky, SKY_WIDTH)
    position = (6.8, 1.75, 22.5)
    gltf.add_camera("camera", position, look_at(position, (-0.4, 4.1, 0.0)), yfov=math.radians(38.0),
                    aspect_ratio=16.0 / 9.0)
    return scene


def _place(gltf, indices):
    for name in ("ground", "steps", "entablature", "roof", "rim", "water"):
        gltf.add_node(name, mesh=indices[name])
    gltf.add_node("finial", mesh=indices["finial"],
                  translation=(0.0, DOME_BASE + DOME_RADIUS + 0.8 * FINIAL_RADIUS, 0.0))
    for i in range(COLUMNS):
        angle = 2.0 * math.pi * (i + 0.5) / COLUMNS
        gltf.add_node(f"column {i + 1}", mesh=indices["column"],
                      translation=(COLUMN_CIRCLE * math.sin(angle), 0.0, COLUMN_CIRCLE * math.cos(angle)))
    for i, (x, z, height) in enumerate(TREES):
        # A sphere, stretched: normals have to follow the inverse transpose.
        gltf.add_node(f"tree {i + 1}", mesh=indices["tree"], translation=(x, 0.48 * height, z),
                      scale=(0.16 * height, 0.5 * height, 0.16 * height))


def _rim():
    """A closed frame of four trapezoids each above, below, inside and outside."""
    w, low, high = RIM_WIDTH, -0.1, RIM_HEIGHT
    (x0, z0), (x1, z1) = POOL
    inner = ((x0, z1), (x1, z1), (x1, z0), (x0, z0))
    outer = ((x0 - w, z1 + w), (x1 + w, z1 + w), (x1 + w, z0 - w), (x0 - w, z0 - w))
    mesh = Mesh()
    for i in range(4):
        (ax, az), (bx, bz), (cx, cz), (dx, dz) = outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]
        mesh.add_quad([(ax, high, az), (bx, high, bz), (cx, high, cz), (dx, high, dz)])
        mesh.add_quad([(bx, low, bz), (ax, low, az), (dx, low, dz), (cx, low, cz)])
        mesh.add_quad([(ax, low, az), (bx, low, bz), (bx, high, bz), (ax, high, az)])
        mesh.add_quad([(cx, low, cz), (dx, low, dz), (dx, high, dz), (cx, high, cz)])
    return mesh


def _water():
    (x0, z0), (x1, z1) = POOL
    mesh = Mesh()
    mesh.add_quad([(x0, WATER_LEVEL, z1), (x1, WATER_LEVEL, z1), (x1, WATER_LEVEL, z0), (x0, WATER_LEVEL, z0)])
    return mesh
