"""Breakfast by a window: a goblet of wine, a tumbler of iced water and a carafe in the morning sun."""

import math
import random

from ..mesh import lathe, revolved, smooth_outline, wall
from ..scenes.caustic_glasses import GOBLET, TUMBLER, WATER, WINE
from ..sky import Sky
from . import textures
from .shapes import rounded_box, surface
from .stage import Stage, turned

SEGMENTS = 192
CARAFE = ((0.0, 0.0), (0.036, 0.0), (0.0450, 0.0010), (0.0490, 0.0050), (0.0520, 0.0200), (0.0520, 0.0700), (0.0440, 0.1150),
          (0.0280, 0.1500), (0.0200, 0.1780), (0.0195, 0.2050), (0.0240, 0.2300), (0.0290, 0.2420), (0.0285, 0.2440),
          (0.0270, 0.2430), (0.0215, 0.2300), (0.0172, 0.2050), (0.0177, 0.1780), (0.0255, 0.1490), (0.0415, 0.1140),
          (0.0495, 0.0700), (0.0495, 0.0220), (0.0460, 0.0110), (0.0360, 0.0085), (0.0, 0.0080))
CARAFE_WATER = ((0.0, 0.0070), (0.0370, 0.0075), (0.0470, 0.0100), (0.0508, 0.0220), (0.0508, 0.0700), (0.0450, 0.1060),
                (0.0, 0.1060))
TOP, TABLE_HALF = 0.75, (0.62, 0.42)
BOARD, GAP = 0.118, 0.0006
SUN = math.radians(27.0), math.radians(-33.0)
UNIT, TURBIDITY, GROUND, LEAVES = 7.0, 3.5, (0.16, 0.20, 0.09), 1.5
# No more of the wall than the camera and the sun's shadows need: the smaller the scene, the more of the sun's light
# subpaths meet the glasses.
FOOT, WALL_Z, WINDOW_LOW, WINDOW_HIGH = 0.55, -0.56, (-0.62, 0.80), (0.62, 1.42)


def build():
    scene = Stage()
    gltf = scene.gltf
    _table(scene)
    _window(scene)
    glass = scene.add_glass("glass", 1.5, thickness=0.002)
    wine = scene.add_glass("wine", 1.34, thickness=0.06, attenuationColor=[0.60, 0.02, 0.05], attenuationDistance=0.04)
    water = scene.add_glass("water", 1.333, thickness=0.06)
    ice = scene.add_glass("ice", 1.309, thickness=0.02)
    scene.render_json["/materials/glass/priority"] = 2
    scene.render_json["/materials/ice/priority"] = 1
    for name, outline, contents, liquid, x, z in (
            ("goblet", GOBLET, WINE, wine, -0.085, 0.045), ("tumbler", TUMBLER, WATER, water, 0.065, 0.115),
            ("carafe", CARAFE, CARAFE_WATER, water, 0.19, -0.10)):
        place = {"translation": (x, TOP + 0.0003, z)}
        scene.add_object(name, revolved(*smooth_outline(outline), SEGMENTS), glass, **place)
        scene.add_object(f"drink in the {name}", lathe(contents, SEGMENTS), liquid, **place)
    cube = rounded_box((-0.0115, -0.0105, -0.0115), (0.0115, 0.0105, 0.0115), 0.0032, 5)
    scene.copies("ice cube", cube, ice, [
        {"translation": (0.065 + x, TOP + y, 0.115 + z), "rotation": turned(axis, degrees)} for x, y, z, axis, degrees in (
            (-0.013, 0.0665, 0.010, (0.0, 0.8, 0.6), 25.0), (0.014, 0.0685, 0.006, (0.6, 0.0, 0.8), 22.0),
            (0.002, 0.0660, -0.016, (0.8, 0.6, 0.0), -28.0))])
    _lemons(scene)
    _napkin(scene)
    scene.add_daylight(_Garden(*SUN, TURBIDITY, UNIT, GROUND), 1024)
    scene.camera((0.070, 0.925, 0.88), (0.025, 0.832, 0.0), 23.5)
    scene.render_json.update({
        "/integrator/type": "vcm", "/integrator/max_depth": 24, "/f_stop": 6.3, "/focus_distance": 0.80,
        "/lights/sun/angle": 0.0093})
    return scene


class _Garden(Sky):
    """The sky above a garden that is far out of focus: clouds of leaves, and discs where the sun comes through."""

    def __init__(self, *arguments):
        # Azimuth, elevation, radius (radians) and radiance of each disc, by steps of a tenth of a radian of the azimuth.
        self._discs = {}
        super().__init__(*arguments)
        numbers = random.Random(11)
        for _ in range(900):
            disc = (numbers.uniform(-1.2, 1.2), numbers.gauss(0.02, 0.10), numbers.uniform(0.010, 0.020),
                    numbers.choice(((0.9, 1.0, 0.30), (0.5, 0.8, 0.2), (1.2, 1.25, 0.8), (0.35, 0.6, 0.12))), numbers.random())
            for step in {math.floor(10.0 * (disc[0] + side * disc[2])) for side in (-1.0, 1.0)}:
                self._discs.setdefault(step, []).append(disc)

    def radiance(self, toward):
        x, y, z = toward
        azimuth = math.atan2(x, -z)
        around = (azimuth / (2.0 * math.pi)) % 1.0
        height = math.asin(max(min(y, 1.0), -1.0))
        sky = super().radiance((x, max(y, 1e-3), z))
        line = 0.05 + 0.20 * textures.fractal(around, 0.0, 16, 1, 3, 5)
        if height > line + 0.05:
            return sky
        v = (height / math.pi) % 1.0
        tone = textures.fractal(around, v, 32, 16, 3, 9)
        leaves = [LEAVES * c for c in textures.mix((0.018, 0.045, 0.010), (0.42, 0.58, 0.11), smooth(0.30, 0.85, tone) ** 1.5)]
        for disc_azimuth, elevation, radius, color, strength in self._discs.get(math.floor(10.0 * azimuth), ()):
            if height < line:
                away = math.hypot((azimuth - disc_azimuth) * math.cos(height), height - elevation)
                cover = 1.0 - smooth(0.85 * radius, 1.1 * radius, away)
                leaves = [c + 0.8 * cover * strength * strength * e for c, e in zip(leaves, color)]
        return tuple(textures.mix(leaves, sky, smooth(line - 0.05, line + 0.05, height + 0.12 * (tone - 0.5))))


def smooth(low, high, value):
    """0 below `low`, 1 above `high`, and smooth between them."""
    t = min(max((value - low) / (high - low), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def _table(scene):
    gltf = scene.gltf
    grain = gltf.add_texture("oak", textures.wood(1024, 1024, (0.055, 0.026, 0.012), (0.30, 0.165, 0.078), rings=16))
    wear = gltf.add_texture("wear", textures.roughness(256, 0.32, 0.62))
    oak = scene.textured("oak", grain, roughness_texture=wear)
    random_numbers = random.Random(4)
    w, d = TABLE_HALF
    count = int(2.0 * d / BOARD)
    for i in range(count):
        z = -d + i * BOARD
        offset = (random_numbers.random(), random_numbers.random())
        scene.add_object(f"board {i + 1}", rounded_box((-w, TOP - 0.028, z + GAP), (w, TOP, z + BOARD - GAP), 0.0022, 3, 0.9,
                                                       offset), oak)


def _window(scene):
    plaster = scene.add_diffuse("plaster", (0.62, 0.58, 0.52))
    paint = scene.gltf.add_material("paint", base_color=(0.78, 0.76, 0.71), roughness=0.45)
    (x0, y0), (x1, y1) = WINDOW_LOW, WINDOW_HIGH
    left, width, depth = x0 - 0.03, x1 - x0 + 0.06, 0.12
    opening = ((x0 - left, y0 - FOOT), (x1 - left, y1 - FOOT))
    scene.add_object("wall", wall((left, FOOT, WALL_Z), (width, 0.0, 0.0), (0.0, y1 + 0.05 - FOOT, 0.0), [opening]), plaster)
    z0, z1 = WALL_Z - depth, WALL_Z
    bars = {"sill": ((x0 - 0.05, y0 - 0.03, z0), (x1 + 0.05, y0, z1 + 0.035)),
            "lintel": ((x0, y1, z0), (x1, y1 + 0.03, z1)),
            "left jamb": ((x0 - 0.03, y0, z0), (x0, y1, z1)), "right jamb": ((x1, y0, z0), (x1 + 0.03, y1, z1)),
            "lower rail": ((x0, y0, z0), (x1, y0 + 0.05, z0 + 0.045)),
            "left stile": ((x0, y0, z0), (x0 + 0.05, y1, z0 + 0.045)),
            "right stile": ((x1 - 0.05, y0, z0), (x1, y1, z0 + 0.045)),
            "first mullion": ((-0.33, y0, z0 + 0.004), (-0.29, y1, z0 + 0.04)),
            "second mullion": ((0.39, y0, z0 + 0.004), (0.43, y1, z0 + 0.04))}
    for name, (low, high) in bars.items():
        scene.add_object(name, rounded_box(low, high, 0.004), paint)


def _lemons(scene):
    gltf = scene.gltf
    pores = gltf.add_texture("pores", textures.relief(
        256, lambda u, v: textures.fractal(u, v, 22, 22, 2, 31), 2.2))
    peel = scene.textured("peel", normal=pores, base_color=(0.80, 0.52, 0.035), roughness=0.38)

    def lemon(s, t):
        angle, polar = 2.0 * math.pi * s, math.pi * t
        radius = 0.027 * math.sin(polar) ** 0.92 + 0.0016 * math.sin(polar) * math.cos(3.0 * angle + 2.0 * polar)
        along = -0.033 * math.cos(polar) - 0.008 * math.cos(polar) ** 9
        return (radius * math.sin(angle), along, radius * math.cos(angle))

    mesh = surface(lemon, 96, 64, wrap_columns=True, uv_scale=(3.0, 2.0))
    scene.copies("lemon", mesh, peel, [
        {"translation": (-0.170, TOP + 0.0265, 0.150), "rotation": turned((0.0, 0.3162, 0.9487), 84.0)},
        {"translation": (-0.222, TOP + 0.0270, 0.095), "rotation": turned((0.9487, 0.3162, 0.0), 96.0)}])


def _napkin(scene):
    """Folded linen: one sheet to and fro, with round bends, that does not lie quite flat."""
    gltf = scene.gltf
    weave = gltf.add_texture("weave", textures.weave(512, 48))
    linen = scene.textured("linen", normal=weave, base_color=(0.60, 0.62, 0.64), roughness=0.95, double_sided=True,
                           further_extensions={"KHR_materials_sheen": {"sheenColorFactor": [0.2, 0.2, 0.2],
                                                                       "sheenRoughnessFactor": 0.6}})
    width, length, bend, layers = 0.15, 0.23, 0.0022, 5
    leg, arc = width, math.pi * bend
    whole = layers * leg + (layers - 1) * arc

    def place(s, t):
        run, x, y = s * whole, 0.0, 0.0
        layer = min(int(run / (leg + arc)), layers - 1)
        rest = run - layer * (leg + arc)
        forth = layer % 2 == 0
        if rest <= leg:
            x, y = (rest if forth else leg - rest), 2.0 * bend * layer
        else:
            angle = (rest - leg) / bend
            out = bend * math.sin(angle)
            x, y = (leg + out if forth else -out), 2.0 * bend * layer + bend * (1.0 - math.cos(angle))
        u, v = x / width - 0.5, t - 0.5
        edge = max(4.0 * u * u, 4.0 * v * v)
        ripple = 0.0016 * math.sin(7.0 * v + 5.0 * u + 0.9) + 0.0010 * math.sin(17.0 * v - 3.0 * u + 0.4 * layer)
        lift = edge * (0.0016 + ripple) * (0.4 + 0.35 * layer)
        return (x + 0.0016 * math.sin(9.0 * v + layer), y + max(lift, 0.0), (0.5 - t) * (length - 0.0015 * layer))

    mesh = surface(place, 480, 60, uv_scale=(whole * 11.0, length * 11.0))
    scene.add_object("napkin", mesh, linen, translation=(0.172, TOP + 0.0008, 0.195), rotation=turned((0.0, 1.0, 0.0), 26.0))
