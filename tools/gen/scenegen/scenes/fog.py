"""A lantern of stone slats in fog: the lamp in it throws shafts of light, and shows itself through one gap."""

import math

from ..generated_scene import GeneratedScene
from ..mesh import box, ground
from ..vector import look_at

GROUND_ALBEDO, STONE_ALBEDO = (0.35, 0.34, 0.33), (0.45, 0.42, 0.38)
FOG_LOW, FOG_HIGH = (-12.0, -0.5, -12.0), (12.0, 8.0, 12.0)
# White light keeps 1/e over the mean free path, in metres.
MEAN_FREE_PATH, FOG_COLOR, FORWARD = 6.0, 0.9, 0.5
SLATS, SLAT_RADIUS, SLAT_SIZE, SLAT_HEIGHT = 11, 0.9, 0.13, 2.6
LAMP_HEIGHT = 1.3
CAMERA = (0.0, LAMP_HEIGHT, 6.1)


def build():
    scene = GeneratedScene()
    scene.add_object("ground", ground(11.0), scene.add_diffuse("ground", GROUND_ALBEDO))
    fog = scene.gltf.add_material("fog", roughness=0.0, transmission=1.0, further_extensions={
        "KHR_materials_ior": {"ior": 1.0},
        "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": MEAN_FREE_PATH,
                                 "attenuationColor": 3 * [math.exp(-1.0)]},
        "KHR_materials_volume_scatter": {"multiscatterColor": 3 * [FOG_COLOR], "scatterAnisotropy": FORWARD}})
    scene.add_object("fog", box(FOG_LOW, FOG_HIGH), fog, closed=True)
    stone = scene.add_diffuse("stone", STONE_ALBEDO)
    half = 0.5 * SLAT_SIZE
    slat = box((-2.0 * half, 0.0, -half), (2.0 * half, SLAT_HEIGHT, half))
    mesh = scene.gltf.add_mesh("slat", slat, stone)
    scene.triangles += slat.triangle_count
    scene.closed_meshes.add("slat")
    for i in range(SLATS):
        # The camera looks through the gap between the first and the last.
        angle = 2.0 * math.pi * (i + 0.5) / SLATS
        turn = 0.5 * angle
        scene.gltf.add_node(f"slat {i + 1}", mesh=mesh, rotation=(0.0, math.sin(turn), 0.0, math.cos(turn)),
                            translation=(SLAT_RADIUS * math.sin(angle), 0.0, SLAT_RADIUS * math.cos(angle)))
    cap = box((-1.15, SLAT_HEIGHT, -1.15), (1.15, SLAT_HEIGHT + 0.12, 1.15))
    scene.add_object("cap", cap, stone, closed=True)
    scene.gltf.add_camera("camera", CAMERA, look_at(CAMERA, (0.0, LAMP_HEIGHT, 0.0)), yfov=math.radians(44.0),
                          aspect_ratio=16.0 / 9.0)
    return scene
