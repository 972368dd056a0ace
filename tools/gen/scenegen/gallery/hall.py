"""A colonnade in the mist of an early morning: columns cut the low sun into shafts, and embers glow in bronze bowls. Metres."""

import math
import random

from ..mesh import box, ground, merged, revolved, smooth_outline
from ..vector import normalize, scale
from . import textures
from .shapes import rounded_box, surface, tube
from .stage import Stage

# Columns stand at ±ROW and every PITCH from the first on; the ceiling is above their beams.
ROW, PITCH, FIRST, COLUMNS, TALL, RADIUS = 2.9, 3.1, -1.2, 8, 5.6, 0.42
AISLE, BACK = 5.6, -27.0
SLAB = 1.15
SUN, FAR = normalize((0.80, 0.46, -0.38)), 46.0
# Metres that light goes in the mist before it meets a drop, and how much these throw it forwards.
MEAN_FREE_PATH, FORWARDS = 48.0, 0.45


def build():
    scene = Stage()
    gltf = scene.gltf
    gray = gltf.add_texture("marble", textures.mottled(512, (0.40, 0.37, 0.33), (0.66, 0.62, 0.55), 5, 6, 12))
    pits = gltf.add_texture("pits", textures.relief(256, lambda u, v: textures.fractal(u, v, 12, 12, 4, 61), 1.6))
    stone = scene.textured("stone", gray, pits, roughness=0.75, normal_scale=0.5)
    _floor(scene)
    _columns(scene, stone)
    _walls(scene, stone)
    _bowls(scene)
    mist = {"attenuationColor": [math.exp(-1.0)] * 3, "attenuationDistance": MEAN_FREE_PATH}
    air = gltf.add_material("mist", roughness=0.0, transmission=1.0, further_extensions={
        "KHR_materials_ior": {"ior": 1.0}, "KHR_materials_volume": {"thicknessFactor": 1.0, **mist},
        "KHR_materials_volume_scatter": {"multiscatterColor": [0.86, 0.87, 0.88], "scatterAnisotropy": FORWARDS}})
    scene.add_object("mist", box((-62.0, -1.5, -62.0), (62.0, 40.0, 30.0)), air)
    place, target = scale(SUN, FAR), (0.5, 1.5, -8.0)
    attenuation = math.exp(FAR / MEAN_FREE_PATH)
    scene.camera((-0.85, 1.62, 4.6), (0.10, 2.28, -9.0), 40.0)
    scene.render_json.update({
        "/integrator/type": "path", "/integrator/max_depth": 12, "/color/exposure": -0.6, "/environment/color": [0.16, 0.20, 0.27],
        "/lights/sun": {"type": "spot", "position": [a + b for a, b in zip(place, target)], "look_at": list(target),
                        "color": [1.0, 0.72, 0.44], "radius": 0.22, "outer_cone_angle": 0.42, "inner_cone_angle": 0.36,
                        "intensity": 20.0 * FAR * FAR * attenuation}})
    return scene


def _floor(scene):
    gltf = scene.gltf
    wear = gltf.add_texture("wear", textures.roughness(256, 0.10, 0.42, 4, 5, 17))
    tones = [scene.textured(name, gltf.add_texture(name, textures.mottled(256, first, second, 4, 5, seed)),
                            roughness_texture=wear)
             for name, first, second, seed in (("pale slabs", (0.36, 0.34, 0.30), (0.52, 0.49, 0.43), 5),
                                               ("dark slabs", (0.060, 0.062, 0.066), (0.12, 0.12, 0.125), 6))]
    numbers = random.Random(2)
    slabs = ([], [])
    for i in range(-5, 5):
        for k in range(28):
            x, z = SLAB * i, 6.0 - SLAB * k
            low, high = (x + 0.002, -0.06, z - SLAB + 0.002), (x + SLAB - 0.002, 0.003 * numbers.random(), z - 0.002)
            slabs[(i + k) % 2].append(rounded_box(low, high, 0.006, 2, 0.6, (numbers.random(), numbers.random())))
    for name, meshes, material in zip(("pale slabs", "dark slabs"), slabs, tones):
        scene.add_object(name, merged(meshes), material)
    earth = gltf.add_material("earth", base_color=(0.13, 0.115, 0.085), roughness=1.0)
    scene.add_object("earth", ground(90.0, -0.55), earth)
    steps = [rounded_box((-AISLE - 1.0 - 0.4 * k, -0.18 * (k + 1) - 0.10, BACK - 0.4),
                         (AISLE + 0.15 + 0.4 * k, -0.18 * k - 0.061, 7.0), 0.015, 2) for k in range(3)]
    scene.add_object("steps", merged(steps), gltf.add_material("steps", base_color=(0.45, 0.42, 0.37), roughness=0.8))


def _columns(scene, stone):
    """Twenty flutes on a shaft that swells a little, on a base of two rounds, below a round and a square."""
    low, high = 0.30, TALL - 0.42

    def shaft(s, t):
        angle = 2.0 * math.pi * s
        swell = 1.0 - 0.16 * t ** 1.7
        # Flutes end before the mouldings.
        depth = 0.034 * min(1.0, 24.0 * t, 24.0 * (1.0 - t)) ** 0.5
        r = RADIUS * swell - depth * abs(math.sin(10.0 * angle)) ** 0.8
        return (r * math.sin(angle), low + (high - low) * t, r * math.cos(angle))

    base = ((0.0, 0.10), (0.54, 0.10), (0.575, 0.125), (0.575, 0.155), (0.54, 0.182), (0.49, 0.195), (0.478, 0.215),
            (0.49, 0.235), (0.51, 0.25), (0.515, 0.27), (0.50, 0.29), (0.44, 0.305), (0.40, 0.32), (0.0, 0.33))
    capital = ((0.0, -0.02), (0.34, -0.02), (0.365, 0.0), (0.375, 0.02), (0.36, 0.04), (0.38, 0.07), (0.44, 0.13), (0.53, 0.20),
               (0.56, 0.235), (0.54, 0.26), (0.0, 0.27))
    parts = {"shaft": surface(shaft, 320, 40, wrap_columns=True, uv_scale=(2.0, 4.0)),
             "plinth": rounded_box((-0.60, -0.02, -0.60), (0.60, 0.10, 0.60), 0.012, 3, 0.7),
             "abacus": rounded_box((-0.60, high + 0.255, -0.60), (0.60, TALL, 0.60), 0.012, 3, 0.7)}
    smooth = scene.gltf.add_material("mouldings", base_color=(0.54, 0.50, 0.44), roughness=0.7)
    places = [{"translation": (side * ROW, 0.0, FIRST - PITCH * k)} for side in (-1.0, 1.0) for k in range(COLUMNS)]
    for name, mesh in parts.items():
        scene.copies(name, mesh, stone, places)
    for name, outline in (("base", base), ("capital", [(r, high + h) for r, h in capital])):
        scene.copies(name, revolved(*smooth_outline(outline, 4), 96), smooth, places)


def _walls(scene, stone):
    """Beams on the columns, coffers between, and walls of blocks on the left and behind."""
    numbers = random.Random(9)

    def uv():
        return (numbers.random(), numbers.random())

    front, last = FIRST + PITCH + 6.0, BACK
    beams = []
    for side in (-1.0, 1.0):
        for k in range(-2, COLUMNS + 1):
            z = FIRST - PITCH * k
            x0, x1 = sorted((side * (ROW - 0.46), side * (ROW + 0.46)))
            for out, low, high in ((0.0, 0.0, 0.62), (0.06, 0.62, 0.78)):
                beams.append(rounded_box((x0 - out, TALL + low, z - PITCH + 0.002), (x1 + out, TALL + high, z - 0.002),
                                         0.02, 2, 0.5, uv()))
    for k in range(-2, 2 * COLUMNS + 1):
        z = FIRST - 0.5 * PITCH * k
        beams.append(rounded_box((-AISLE, TALL + 0.781, z - 0.20), (AISLE + 0.2, TALL + 1.15, z + 0.20), 0.02, 2, 0.5,
                                 uv()))
    for x in (-1.75, -0.55, 0.65, 1.85):
        beams.append(rounded_box((x - 0.15, TALL + 0.86, last), (x + 0.05, TALL + 1.15, front), 0.02, 2, 0.5, uv()))
    beams.append(box((-AISLE - 0.4, TALL + 1.10, last - 0.4), (AISLE + 0.4, TALL + 1.5, front), 0.5))
    scene.add_object("beams", merged(beams), stone)
    blocks = []
    course, y = 0, -0.05
    while y < TALL + 1.1:
        tall = (0.62, 0.50, 0.56)[course % 3]
        z = front + (0.0, 0.5, 0.2)[course % 3]
        while z > last:
            deep = numbers.uniform(0.95, 1.35)
            face = -AISLE + 0.006 * numbers.random()
            blocks.append(rounded_box((-AISLE - 0.4, y + 0.002, z - deep + 0.002), (face, y + tall - 0.002, z - 0.002),
                                      0.012, 2, 0.5, uv()))
            z -= deep
        x = -AISLE
        while x < AISLE:
            deep = numbers.uniform(0.95, 1.35)
            end, face = min(x + deep, AISLE), last + 0.006 * numbers.random()
            blocks.append(rounded_box((x + 0.002, y + 0.002, last - 0.4), (end - 0.002, y + tall - 0.002, face),
                                      0.012, 2, 0.5, uv()))
            x += deep
        y, course = y + tall, course + 1
    scene.add_object("blocks", merged(blocks), stone)


def _bowls(scene):
    """Bronze bowls with embers on three legs."""
    gltf = scene.gltf
    bronze = gltf.add_material("bronze", base_color=(0.42, 0.26, 0.13), metallic=1.0, roughness=0.34)
    outline = ((0.0, 0.80), (0.10, 0.81), (0.22, 0.86), (0.30, 0.95), (0.335, 1.03), (0.355, 1.05), (0.350, 1.065),
               (0.325, 1.055), (0.285, 0.97), (0.20, 0.90), (0.0, 0.88))
    bowl = revolved(*smooth_outline(outline, 5), 96)
    def around(radius, height, turn):
        return (radius * math.sin(2.0 * math.pi * turn), height, radius * math.cos(2.0 * math.pi * turn))

    legs = [tube([around(0.27, 0.90, k / 3.0), around(0.20, 0.50, k / 3.0), around(0.30, 0.03, k / 3.0)],
                 [0.016, 0.016, 0.024], 16) for k in range(3)]
    legs = merged([*legs, tube([around(0.215, 0.42, k / 48.0) for k in range(48)], 0.010, 12, closed=True)])
    places = [{"translation": (-1.55, 0.0, FIRST - PITCH * (k + 0.5))} for k in (0, 2, 4, 6)]
    scene.copies("bowl", bowl, bronze, places)
    scene.copies("legs", legs, bronze, places)
    numbers = random.Random(6)
    dark = gltf.add_material("coal", base_color=(0.02, 0.018, 0.016), roughness=0.9)
    glowing = gltf.add_material("embers", base_color=(0.02, 0.018, 0.016), emission=(26.0, 7.5, 1.4))
    heaps = {dark: [], glowing: []}
    for _ in range(90):
        r, a = 0.27 * numbers.random() ** 0.5, 2.0 * math.pi * numbers.random()
        h = 0.035 * numbers.uniform(0.7, 1.3)
        x, y, z = r * math.sin(a), 0.975 + 0.05 * (1.0 - r / 0.27) + 0.02 * numbers.random(), r * math.cos(a)
        lump = rounded_box((x - h, y - 0.8 * h, z - h), (x + h, y + 0.8 * h, z + h), 0.4 * h, 2)
        heaps[glowing if numbers.random() < 0.45 else dark].append(lump)
    for name, (material, meshes) in zip(("coal", "embers"), heaps.items()):
        scene.copies(name, merged(meshes), material, places)
