"""A glass of wine and a glass of water on a table in the low sun of a window: caustics, and what is seen through them."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import box, lathe, rectangle, revolved, smooth_outline, wall
from ..patterns import planks
from ..sky import Sky
from ..vector import look_at

# Bodies of revolution by points (radius, height) of their outlines, metres, from the axis below over the rim to the axis.
GOBLET = ((0.0, 0.0), (0.020, 0.0), (0.0335, 0.0002), (0.0360, 0.0016), (0.0335, 0.0030), (0.0150, 0.0056), (0.0062, 0.0110),
          (0.0041, 0.0260), (0.0040, 0.0600), (0.0060, 0.0780), (0.0180, 0.0885), (0.0335, 0.1070), (0.0408, 0.1340),
          (0.0398, 0.1650), (0.0372, 0.1840), (0.0358, 0.1920), (0.0352, 0.1960), (0.0349, 0.1975), (0.0342, 0.1983),
          (0.0335, 0.1975), (0.0336, 0.1960), (0.0343, 0.1920), (0.0356, 0.1840), (0.0380, 0.1650), (0.0390, 0.1340),
          (0.0318, 0.1098), (0.0170, 0.0937), (0.0060, 0.0905), (0.0, 0.0902))
WINE = ((0.0, 0.0885), (0.0070, 0.0890), (0.0178, 0.0918), (0.0328, 0.1088), (0.0399, 0.1340), (0.0397, 0.1440), (0.0, 0.1440))
TUMBLER = ((0.0, 0.0), (0.0240, 0.0), (0.0300, 0.0005), (0.0325, 0.0030), (0.0333, 0.0120), (0.0352, 0.0500), (0.0378, 0.0985),
           (0.0370, 0.1000), (0.0362, 0.0985), (0.0336, 0.0500), (0.0318, 0.0165), (0.0290, 0.0125), (0.0230, 0.0115), (0.0, 0.0115))
WATER = ((0.0, 0.0100), (0.0236, 0.0100), (0.0300, 0.0110), (0.0325, 0.0150), (0.0344, 0.0500), (0.0359, 0.0740), (0.0, 0.0740))
SEGMENTS, STEPS_PER_POINT = 160, 8

TABLE_HEIGHT, TABLE_HALF, TABLE_THICKNESS = 0.75, (0.55, 0.36), 0.03
SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY = math.radians(31.0), math.radians(-24.0), 3.0
# Radiance 1 is 9 kcd/m².
UNIT, GROUND_ALBEDO, SKY_WIDTH = 9.0, (0.20, 0.22, 0.16), 256
# The back wall, and the window in it.
WALL_Z, WALL_WIDTH, WALL_HEIGHT, WINDOW = -0.75, 2.4, 1.9, ((0.25, 0.86), (1.55, 1.72))


def build():
    scene = GeneratedScene()
    gltf = scene.gltf
    oak = gltf.add_material("oak", base_color_texture=gltf.add_texture(
        "oak", planks(256, 3, (0.17, 0.085, 0.04), (0.42, 0.25, 0.13))), roughness=0.55)
    (w, d), top = TABLE_HALF, TABLE_HEIGHT
    scene.add_object("table", box((-w, top - TABLE_THICKNESS, -d), (w, top, d), 1.2), oak)
    plaster = scene.add_diffuse("plaster", (0.58, 0.55, 0.50))
    scene.add_object("wall", wall((-0.5 * WALL_WIDTH, 0.0, WALL_Z), (WALL_WIDTH, 0.0, 0.0), (0.0, WALL_HEIGHT, 0.0), [WINDOW]),
                     plaster)
    scene.add_object("floor", rectangle((-1.2, 0.0, 1.4), (2.4, 0.0, 0.0), (0.0, 0.0, 1.4 - WALL_Z)), plaster)
    glass = scene.add_glass("glass", 1.5, thickness=0.002)
    wine = scene.add_glass("wine", 1.34, thickness=0.06, attenuationColor=[0.55, 0.02, 0.05], attenuationDistance=0.02)
    water = scene.add_glass("water", 1.33, thickness=0.06)
    # Liquids reach into the glass, which has precedence. A hair above the table.
    scene.render_json["/materials/glass/priority"] = 1
    for name, outline, contents, liquid, x, z in (("goblet", GOBLET, WINE, wine, -0.07, 0.03),
                                                  ("tumbler", TUMBLER, WATER, water, 0.085, 0.10)):
        place = {"closed": True, "translation": (x, top + 0.0003, z)}
        scene.add_object(name, revolved(*smooth_outline(outline, STEPS_PER_POINT), SEGMENTS), glass, **place)
        scene.add_object(f"drink in the {name}", lathe(contents, SEGMENTS), liquid, **place)
    scene.add_daylight(Sky(SUN_ELEVATION, SUN_AZIMUTH, TURBIDITY, UNIT, GROUND_ALBEDO), SKY_WIDTH)
    position = (0.06, 1.02, 0.80)
    gltf.add_camera("camera", position, look_at(position, (0.0, 0.805, 0.06)), yfov=math.radians(27.0),
                    aspect_ratio=4.0 / 3.0)
    return scene
