"""A grid of spheres: roughness grows from left to right, materials change from front to back."""

import math

from ..generated_scene import GeneratedScene
from ..images import exr, latitude_longitude
from ..mesh import Mesh, sphere
from ..patterns import checker
from ..vector import direction, dot, look_at

COLUMNS = 7
RADIUS, SPACING, STEP_HEIGHT = 0.42, 1.10, 0.45
SPHERE_FREQUENCY = 24
FLOOR_HALF_SIZE = 30.0

# Front to back: name, material as plain glTF, and what render.json puts in its place.
ROWS = (
    ("glass", {"transmission": 1.0}, {"dielectric": {"ior": 1.5}}),
    ("film", {"base_color": (0.20, 0.62, 0.66), "transmission": 1.0, "double_sided": True}, None),
    ("plastic", {"base_color": (0.62, 0.03, 0.02)}, None),
    ("aluminium", {"base_color": (0.91, 0.92, 0.92), "metallic": 1.0}, {"conductor": {"metal": "Al"}}),
    ("gold", {"base_color": (1.00, 0.77, 0.34), "metallic": 1.0}, {"conductor": {"metal": "Au"}}))

# Studio: direction (elevation, azimuth in degrees), angular radius in degrees and radiance of round soft boxes.
SOFT_BOXES = (
    ((50.0, -140.0), 26.0, (9.0, 8.4, 7.6)),
    ((25.0, 105.0), 20.0, (2.6, 3.1, 4.0)),
    ((35.0, -35.0), 18.0, (3.6, 3.5, 3.4)))
ENVIRONMENT_WIDTH = 512


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    ball = sphere(RADIUS, SPHERE_FREQUENCY)
    for row, (name, factors, override) in enumerate(ROWS):
        for column in range(COLUMNS):
            roughness = column / (COLUMNS - 1)
            full_name = f"{name}-{round(100 * roughness):03d}"
            material = gltf.add_material(full_name, roughness=roughness, **factors)
            # Each sphere is a mesh of its own because glTF ties the material to it; they share their data.
            gltf.add_node(full_name, mesh=gltf.add_mesh(full_name, ball, material),
                          translation=((column - 0.5 * (COLUMNS - 1)) * SPACING, row * STEP_HEIGHT + RADIUS,
                                       -row * SPACING))
            scene.closed_meshes.add(full_name)
            for model, values in (override or {}).items():
                scene.render_json[f"/materials/{full_name}/{model}"] = {**values, "roughness": roughness}

    texture = gltf.add_texture("checker", checker(0.07, 0.30, 256, 256))
    floor = gltf.add_material("floor", base_color_texture=texture)
    gltf.add_node("floor", mesh=gltf.add_mesh("floor", _stairs(), floor))
    position = (0.0, 5.6, 8.4)
    gltf.add_camera("camera", position, look_at(position, (0.0, 1.05, -1.75)), yfov=math.radians(27.0),
                    aspect_ratio=16.0 / 9.0)

    height = ENVIRONMENT_WIDTH // 2
    scene.files["studio.exr"] = exr(ENVIRONMENT_WIDTH, height,
                                    latitude_longitude(ENVIRONMENT_WIDTH, height, _studio()))
    scene.render_json["/environment/image"] = "studio.exr"
    scene.triangles = len(ROWS) * COLUMNS * 20 * SPHERE_FREQUENCY ** 2 + 2 * (2 * len(ROWS) - 1)
    return scene


def _stairs():
    """One tread per row, the first and the last of them wide; texture coordinates follow the surface in metres."""
    mesh = Mesh()
    h = FLOOR_HALF_SIZE
    # Points (z, y) of the profile from front to back; the treads begin half a step in front of their spheres.
    profile = [(h, 0.0)]
    for row in range(1, len(ROWS)):
        z = (0.5 - row) * SPACING
        profile += [(z, (row - 1) * STEP_HEIGHT), (z, row * STEP_HEIGHT)]
    profile.append((-h, (len(ROWS) - 1) * STEP_HEIGHT))
    v = 0.0
    for (z0, y0), (z1, y1) in zip(profile, profile[1:]):
        next_v = v - math.hypot(z1 - z0, y1 - y0)
        mesh.add_quad([(-h, y0, z0), (h, y0, z0), (h, y1, z1), (-h, y1, z1)],
                      [(-h, v), (h, v), (h, next_v), (-h, next_v)])
        v = next_v
    return mesh


def _studio():
    """Radiance of a grey room with soft boxes whose edges fade over a tenth of their radius."""
    boxes = []
    for (elevation, azimuth), radius, color in SOFT_BOXES:
        inner, outer = math.cos(math.radians(0.9 * radius)), math.cos(math.radians(radius))
        boxes.append((direction(math.radians(elevation), math.radians(azimuth)), inner, outer, color))

    def radiance(toward):
        height = 0.5 + 0.5 * toward[1]
        color = [0.10 + 0.22 * height, 0.10 + 0.24 * height, 0.10 + 0.28 * height]
        for center, inner, outer, box in boxes:
            t = min(max((dot(toward, center) - outer) / (inner - outer), 0.0), 1.0)
            weight = t * t * (3.0 - 2.0 * t)
            color = [c + weight * b for c, b in zip(color, box)]
        return color

    return radiance
