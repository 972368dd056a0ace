"""A tiled pool in the morning sun: what the waves focus on the tiles, seen through the same waves."""

import math
import random

from ..mesh import sphere, wall, wavy_block
from ..patterns import tiles
from ..room import add_room
from ..scenes import caustic_pool as pool
from ..sky import Sky
from . import textures
from .shapes import rounded_box, surface, tube
from .stage import Stage, turned

SUN = math.radians(46.0), math.radians(-118.0)
UNIT, TURBIDITY, GROUND = 22.0, 2.8, (0.30, 0.29, 0.25)
SLAB, JOINT = 0.60, 0.004
# Wavelength, direction in degrees and phase of each wave, and the curvature of each: on the floor their light meets.
WAVES = ((1.30, 20.0, 0.3), (0.83, 71.0, 2.1), (0.61, -41.0, 4.0), (0.45, 128.0, 1.2), (0.33, 48.0, 5.1), (0.24, -12.0, 2.8),
         (0.19, 95.0, 0.7))
CURVATURE = 0.85


def build():
    scene = Stage()
    gltf = scene.gltf
    blues = ((0.16, 0.42, 0.50), (0.30, 0.58, 0.62), (0.45, 0.70, 0.72), (0.60, 0.78, 0.77))
    mosaic = gltf.add_material("tiles", roughness=0.25, base_color_texture=gltf.add_texture("tiles", tiles(
        512, 8, blues, grout=(0.62, 0.63, 0.60), grout_width=0.06)))
    low, high = pool.LOW, pool.HIGH
    add_room(scene, (low[0], pool.BOTTOM, low[1]), (high[0], 0.0, high[1]),
             {side: mosaic for side in ("floor", "left", "right", "back", "front")}, uv_per_meter=1.0 / (8.0 * pool.TILE))
    scene.add_object("steps", pool.steps(), mosaic)
    water = scene.add_glass("water", 1.333, thickness=1.0, attenuationColor=[0.50, 0.86, 0.93], attenuationDistance=3.2)
    scene.add_object("water", _water(), water)
    _deck(scene)
    _ladder(scene)
    _floats(scene)
    scene.add_daylight(Sky(*SUN, TURBIDITY, UNIT, GROUND), 256)
    scene.camera((1.05, 1.75, 2.75), (0.02, -0.36, 0.05), 33.0)
    scene.render_json.update({"/integrator/type": "vcm", "/integrator/max_depth": 16, "/lights/sun/angle": 0.0093})
    return scene


def _water():
    """The closed body of the water, which reaches behind the tiles."""
    def wave(x, z):
        height, along_x, along_z = pool.LEVEL, 0.0, 0.0
        for wavelength, degrees, phase in WAVES:
            number = 2.0 * math.pi / wavelength
            kx, kz = number * math.cos(math.radians(degrees)), number * math.sin(math.radians(degrees))
            # Crests lie a little askew, so that they do not run straight across the pool.
            angle = kx * x + kz * z + phase + 0.5 * math.sin(1.9 * x - 2.6 * z + 3.0 * phase)
            bend_x, bend_z = (c * 0.5 * math.cos(1.9 * x - 2.6 * z + 3.0 * phase) for c in (1.9, -2.6))
            amplitude = CURVATURE / number ** 2
            height += amplitude * math.sin(angle)
            along_x += amplitude * math.cos(angle) * (kx + bend_x)
            along_z += amplitude * math.cos(angle) * (kz + bend_z)
        return height, along_x, along_z

    low = (pool.LOW[0] - pool.OVERLAP, pool.BOTTOM - pool.OVERLAP, pool.LOW[1] - pool.OVERLAP)
    return wavy_block(low, (pool.HIGH[0] + pool.OVERLAP, pool.HIGH[1] + pool.OVERLAP), 400, 284, wave)


def _deck(scene):
    """Slabs of stone with rounded edges around the basin, and a kerb that hangs over it."""
    gltf = scene.gltf
    grain = gltf.add_texture("limestone", textures.mottled(512, (0.40, 0.36, 0.30), (0.60, 0.56, 0.48), 7, 6))
    pits = gltf.add_texture("pits", textures.relief(512, lambda u, v: textures.fractal(u, v, 24, 24, 4, 60), 2.0))
    stone = scene.textured("limestone", grain, pits, roughness=0.8)
    numbers = random.Random(8)
    (x0, z0), (x1, z1) = pool.LOW, pool.HIGH
    kerb = 0.30

    def slab(name, low, high, top, thickness=0.05):
        offset = (numbers.random(), numbers.random())
        mesh = rounded_box((low[0] + JOINT, top - thickness, low[1] + JOINT), (high[0] - JOINT, top, high[1] - JOINT), 0.008, 3,
                           0.9, offset)
        scene.add_object(name, mesh, stone)

    count = 0
    for k in range(6):
        a = x0 + (x1 - x0) * k / 6
        b = x0 + (x1 - x0) * (k + 1) / 6
        slab(f"kerb {count + 1}", (a, z1 - 0.02), (b, z1 + kerb), 0.045)
        slab(f"kerb {count + 2}", (a, z0 - kerb), (b, z0 + 0.02), 0.045)
        count += 2
    for k in range(5):
        a = z0 - kerb + (z1 - z0 + 2.0 * kerb) * k / 5
        b = z0 - kerb + (z1 - z0 + 2.0 * kerb) * (k + 1) / 5
        slab(f"kerb {count + 1}", (x0 - kerb, a), (x0 + 0.0, b), 0.044)
        slab(f"kerb {count + 2}", (x1 - 0.0, a), (x1 + kerb, b), 0.044)
        count += 2
    columns, rows = _cuts(x0 - kerb, x1 + kerb), _cuts(z0 - kerb, z1 + kerb)
    for i, (a, b) in enumerate(zip(columns, columns[1:])):
        for j, (c, d) in enumerate(zip(rows, rows[1:])):
            if b <= x0 - kerb or a >= x1 + kerb or d <= z0 - kerb or c >= z1 + kerb:
                slab(f"slab {i} {j}", (a, c), (b, d), 0.004 + 0.003 * numbers.random())
    gravel = scene.add_diffuse("bed", (0.24, 0.22, 0.18))
    bed, h = 0.06, 6.0
    scene.add_object("bed", wall((-h, -bed, h), (2 * h, 0.0, 0.0), (0.0, 0.0, -2 * h),
                                 [((x0 + h, h - z1), (x1 + h, h - z0))]), gravel)


def _cuts(low, high):
    """Joints along an axis: even ones between `low` and `high`, and a slab apart beyond."""
    inside = round((high - low) / SLAB)
    beyond = [SLAB * (k + 1) for k in range(7)]
    return ([low - away for away in reversed(beyond)] + [low + (high - low) * k / inside for k in range(inside + 1)]
            + [high + away for away in beyond])


def _ladder(scene):
    steel = scene.gltf.add_material("steel", base_color=(0.75, 0.76, 0.78), metallic=1.0, roughness=0.12)
    x, z0 = pool.HIGH[0], -0.62
    for k in range(2):
        z = z0 + 0.46 * k
        path = [(x + 0.42, 0.03, z), (x + 0.42, 0.30, z)]
        path += [(x + 0.17 + 0.25 * math.cos(a), 0.42 + 0.26 * math.sin(a), z)
                 for a in (math.pi * i / 16 for i in range(17))]
        path += [(x - 0.08, 0.30, z), (x - 0.08, -0.75, z)]
        scene.add_object(f"rail {k + 1}", tube(path, 0.019, 20), steel)
    for k in range(3):
        y = -0.22 - 0.24 * k
        scene.add_object(f"rung {k + 1}", tube([(x - 0.08, y, z0 + 0.01), (x - 0.08, y, z0 + 0.45)], 0.016, 16), steel)


def _floats(scene):
    """A beach ball and a ring, half in the water."""
    gltf = scene.gltf
    level = pool.LEVEL

    def torus(s, t):
        a, b = 2.0 * math.pi * s, 2.0 * math.pi * t
        r = 0.30 + 0.095 * math.cos(b)
        return (r * math.sin(a), 0.085 * math.sin(b), r * math.cos(a))

    for k in range(8):
        color = ("red rubber", (0.62, 0.03, 0.03)) if k % 2 else ("white rubber", (0.80, 0.79, 0.76))
        scene.add_object(f"ring {k + 1}", surface(lambda s, t, k=k: torus((k + s) / 8.0, t), 24, 48),
                         gltf.add_material(f"{color[0]} {k + 1}", base_color=color[1], roughness=0.3),
                         translation=(-0.35, level + 0.035, 0.30), rotation=turned((0.6, 0.0, 0.8), 4.0))
    scene.add_object("ball", sphere(0.17, 32), gltf.add_material("ball", base_color=(0.90, 0.55, 0.03), roughness=0.25),
                     translation=(0.62, level + 0.105, -0.52))
