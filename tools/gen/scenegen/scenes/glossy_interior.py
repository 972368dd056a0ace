"""A living room in daylight: textures, a polished floor, and light that comes through two windows only."""

import math

from ..generated_scene import GeneratedScene
from ..images import linear_png
from ..mesh import box, lathe, merged, rectangle, sphere
from ..patterns import checker, planks, plaster, tiles
from ..room import add_room, table
from ..sky import Sky
from ..vector import look_at

LOW, HIGH = (-2.6, 0.0, -3.0), (2.6, 2.8, 3.4)
# Windows in the left wall: low and high corners in (z, y) as seen from inside, towards -Z.
WINDOWS = (((0.9, 0.55), (2.7, 2.35)), ((3.6, 0.55), (5.4, 2.35)))
WALL_THICKNESS, BAR = 0.22, 0.05
SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY = math.radians(36.0), math.radians(-68.0), 3.0
# Radiance 1 is 2.2 kcd/m²: exposed for the room, not for what is outside.
UNIT = 2.2
GROUND_ALBEDO = (0.22, 0.25, 0.16)
SKY_WIDTH = 256
UV_PER_METER = 0.5

# Name of the object, material, and boxes as (low, high) corners.
FURNITURE = (
    ("sofa", "cloth", (((1.35, 0.12, -2.0), (2.45, 0.42, 0.3)), ((2.15, 0.30, -2.0), (2.50, 0.85, 0.3)),
                       ((1.35, 0.12, -2.3), (2.50, 0.62, -2.0)), ((1.35, 0.12, 0.3), (2.50, 0.62, 0.6)))),
    ("cushions", "cushion", (((1.95, 0.42, -1.75), (2.14, 0.80, -1.35)), ((1.95, 0.42, -0.15), (2.14, 0.80, 0.25)))),
    ("shelf", "oak", (((-1.9, 0.0, -2.98), (-1.86, 1.9, -2.66)), ((-0.74, 0.0, -2.98), (-0.70, 1.9, -2.66)),
                      *(((-1.87, y, -2.98), (-0.73, y + 0.035, -2.66)) for y in (0.08, 0.52, 0.96, 1.40, 1.86)))),
)
# Width, height and colour of books from left to right, on each board of the shelf that has some.
BOOKS = ((0.04, 0.30, "red"), (0.05, 0.26, "green"), (0.035, 0.32, "paper"), (0.06, 0.28, "red"), (0.03, 0.24, "paper"),
         (0.05, 0.31, "green"), (0.045, 0.27, "paper"), (0.055, 0.30, "red"))


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    materials = _materials(scene)
    walls = {side: materials["plaster"] for side in ("left", "right", "back", "front", "ceiling")}
    add_room(scene, LOW, HIGH, {"floor": materials["parquet"], **walls}, {"left": WINDOWS}, UV_PER_METER)
    scene.add_object("windows", _windows(), materials["paint"])
    for name, material, boxes in FURNITURE:
        scene.add_object(name, merged([box(low, high, 1.0) for low, high in boxes]), materials[material])
    _add_books(scene, materials)
    _add_small_things(scene, materials)

    scene.add_daylight(Sky(SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY, UNIT, GROUND_ALBEDO), SKY_WIDTH)
    position = (1.25, 1.35, 3.25)
    gltf.add_camera("camera", position, look_at(position, (-0.05, 0.92, -1.2)), yfov=math.radians(52.0),
                    aspect_ratio=16.0 / 9.0)
    return scene


def _materials(scene):
    gltf = scene.gltf

    def textured(name, png, **factors):
        return gltf.add_material(name, base_color_texture=gltf.add_texture(name, png), **factors)

    return {
        "parquet": textured("parquet", planks(320, 10, (0.18, 0.09, 0.04), (0.48, 0.28, 0.14)), roughness=0.22),
        "plaster": textured("plaster", plaster(128, (0.80, 0.77, 0.70), 0.15)),
        "oak": textured("oak", planks(256, 3, (0.30, 0.19, 0.10), (0.55, 0.38, 0.22)), roughness=0.4),
        "rug": textured("rug", tiles(256, 12, ((0.45, 0.07, 0.05), (0.60, 0.16, 0.07), (0.10, 0.09, 0.16)),
                                     grout=(0.62, 0.55, 0.40), grout_width=0.10)),
        "picture": textured("picture", _picture(), roughness=0.5),
        "cloth": textured("cloth", checker(0.34, 0.42, 32, 32)),
        "cushion": gltf.add_material("cushion", base_color=(0.70, 0.42, 0.08)),
        "paint": gltf.add_material("paint", base_color=(0.80, 0.80, 0.80), roughness=0.4),
        "red": gltf.add_material("red", base_color=(0.42, 0.06, 0.04), roughness=0.5),
        "green": gltf.add_material("green", base_color=(0.07, 0.20, 0.13), roughness=0.5),
        "paper": gltf.add_material("paper", base_color=(0.68, 0.62, 0.50), roughness=0.7),
        "lacquer": gltf.add_material("lacquer", base_color=(0.02, 0.02, 0.022), roughness=0.08),
        "chrome": gltf.add_material("chrome", base_color=(0.62, 0.62, 0.62), metallic=1.0, roughness=0.05),
    }


def _windows():
    """The depth of the wall around each window, and bars that divide it into four panes."""
    parts = []
    x0, x1 = LOW[0] - WALL_THICKNESS, LOW[0]
    for (near, low), (far, high) in WINDOWS:
        z1, z0 = HIGH[2] - near, HIGH[2] - far
        out, along, up = (x0 - x1, 0.0, 0.0), (0.0, 0.0, z1 - z0), (0.0, high - low, 0.0)
        back = (x1 - x0, 0.0, 0.0)
        parts += [rectangle((x1, low, z1), out, (0.0, 0.0, z0 - z1)), rectangle((x1, high, z0), out, along),
                  rectangle((x0, low, z0), back, up), rectangle((x1, low, z1), out, up)]
        y, z, half = 0.5 * (low + high), 0.5 * (z0 + z1), 0.5 * BAR
        x = x1 - 0.6 * WALL_THICKNESS
        parts += [box((x - half, low, z - half), (x + half, high, z + half)),
                  box((x - half, y - half, z0), (x + half, y + half, z1))]
    return merged(parts)


def _add_books(scene, materials):
    books = {}
    for shelf, (y, skipped) in enumerate(((0.115, 2), (0.555, 0), (0.995, 3), (1.435, 1))):
        x = -1.84
        for i in range(16 - 3 * skipped):
            width, height, color = BOOKS[(5 * i + 3 * shelf) % len(BOOKS)]
            books.setdefault(color, []).append(box((x, y, -2.95), (x + width, y + height, -2.74)))
            x += width + 0.002
    for color, boxes in books.items():
        scene.add_object(f"{color} books", merged(boxes), materials[color])


def _add_small_things(scene, materials):
    rug = rectangle((-1.0, 0.0, 1.0), (2.2, 0.0, 0.0), (0.0, 0.0, -2.9), 0.5)
    scene.add_object("rug", rug, materials["rug"], translation=(0.0, 0.008, 0.0))
    scene.add_object("coffee table", table(1.1, 0.65, 0.40, 0.04, 0.05), materials["lacquer"],
                     translation=(0.25, 0.008, -0.85))
    scene.add_object("ball", sphere(0.11, 24), materials["chrome"], closed=True, translation=(0.45, 0.519, -0.80))
    vase = lathe(((0.0, 0.0), (0.07, 0.0), (0.11, 0.10), (0.10, 0.20), (0.04, 0.30), (0.06, 0.36), (0.0, 0.36)), 64)
    scene.add_object("vase", vase, materials["paint"], closed=True, translation=(0.0, 0.409, -0.95))
    scene.add_object("picture", rectangle((0.35, 1.15, -2.97), (1.5, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0),
                     materials["picture"])
    frame = [box(low, high) for low, high in (
        ((0.30, 1.10, -3.0), (0.35, 2.20, -2.95)), ((1.85, 1.10, -3.0), (1.90, 2.20, -2.95)),
        ((0.35, 1.10, -3.0), (1.85, 1.15, -2.95)), ((0.35, 2.15, -3.0), (1.85, 2.20, -2.95)))]
    scene.add_object("frame", merged(frame), materials["lacquer"])


def _picture():
    """Hills behind each other under an evening sky."""
    def texel(u, v):
        color = (0.85 - 0.5 * (1.0 - v), 0.45 - 0.1 * (1.0 - v), 0.22 + 0.3 * (1.0 - v))
        for layer in range(4):
            edge = 0.42 + 0.14 * layer + 0.06 * math.sin(2.0 * math.pi * ((1.0 + layer) * u + 0.37 * layer))
            if v > edge:
                color = tuple(c * (0.55 - 0.1 * layer) for c in (0.50, 0.42 + 0.1 * layer, 0.60 - 0.1 * layer))
        return color

    return linear_png(192, 192, texel)
