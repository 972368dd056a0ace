"""Newton's cradle on a desk in the evening: one ball swings while the shutter is open, before lamps out of focus. Metres."""

import math
import random
from array import array

from ..gltf import FLOAT
from ..images import exr, latitude_longitude
from ..mesh import panel, sphere
from ..vector import direction, dot, look_at
from . import textures
from .shapes import rounded_box, tube
from .stage import Stage, turned

RADIUS, BALLS, DROP, HALF_DEPTH = 0.0165, 5, 0.105, 0.045
BASE_TOP = 0.020
HEIGHT = BASE_TOP + 0.020 + RADIUS + DROP
# Degrees from the vertical, from when the shutter opens to when it closes.
SWING = (30.0, 41.0)
SHUTTER = 1.0 / 24.0


def build():
    scene = Stage()
    gltf = scene.gltf
    _desk(scene)
    chrome = gltf.add_material("chrome", base_color=(0.80, 0.81, 0.82), metallic=1.0, roughness=0.03)
    brushed = gltf.add_material("brushed", base_color=(0.62, 0.63, 0.65), metallic=1.0, roughness=0.20)
    wire = gltf.add_material("wire", base_color=(0.55, 0.55, 0.56), metallic=1.0, roughness=0.25)
    length = BALLS * 2.0 * RADIUS + 0.150
    for side in (-1.0, 1.0):
        scene.add_object(f"frame {side:+.0f}", tube(_frame(0.5 * length, side * HALF_DEPTH), 0.0034, 24), brushed)
    ball = sphere(RADIUS, 40)
    pieces = [("ball", ball, chrome, (0.0, -DROP, 0.0))]
    eye = tube([(0.0, RADIUS - 0.001 - DROP, 0.0), (0.0, RADIUS + 0.003 - DROP, 0.0)], 0.0016, 16)
    pieces.append(("eye", eye, brushed, (0.0, 0.0, 0.0)))
    for side in (-1.0, 1.0):
        strand = tube([(0.0, 0.0, side * HALF_DEPTH), (0.0, RADIUS + 0.003 - DROP, 0.0)], 0.00045, 8)
        pieces.append((f"strand {side:+.0f}", strand, wire, (0.0, 0.0, 0.0)))
    swinging = []
    for k in range(BALLS):
        x = (k - 0.5 * (BALLS - 1)) * (2.0 * RADIUS + 0.00005)
        angle = -SWING[0] if k == 0 else 0.0
        pivot = gltf.add("nodes", {"name": f"pivot {k + 1}", "translation": [x, HEIGHT, 0.0], "children": [],
                                   "rotation": turned((0.0, 0.0, 1.0), angle)})
        gltf.document["scenes"][0]["nodes"].append(pivot)
        for name, mesh, material, place in pieces:
            scene.triangles += mesh.triangle_count if k == 0 else 0
            node = gltf.add("nodes", {"name": f"{name} {k + 1}", "mesh": gltf.add_mesh(f"{name} {k + 1}", mesh, material),
                                      "translation": list(place)})
            gltf.document["nodes"][pivot]["children"].append(node)
        if k == 0:
            swinging.append(pivot)
    _swing(gltf, swinging)
    scene.files["evening.exr"] = exr(1024, 512, latitude_longitude(1024, 512, _Evening().radiance))
    center, target = (-0.42, 0.58, 0.50), (0.0, 0.06, 0.0)
    scene.add_lamp("lamp", panel(0.46, 0.34), (21.0, 18.0, 14.2), translation=center, rotation=look_at(center, target))
    center = (0.75, 0.40, 0.30)
    scene.add_lamp("window", panel(0.30, 0.60), (4.0, 5.2, 7.2), translation=center, rotation=look_at(center, target))
    scene.camera((0.165, 0.118, 0.505), (-0.012, 0.080, 0.0), 26.0)
    scene.render_json.update({
        "/integrator/type": "path", "/integrator/max_depth": 12, "/lens_radius": 0.0042, "/focus_distance": 0.525,
        "/environment/image": "evening.exr", "/shutter": [0.0, SHUTTER], "/time_code": 0.0, "/color/exposure": 0.5})
    return scene


def _frame(half, z):
    """Up, along and down again, with round corners."""
    r, low = 0.014, BASE_TOP - 0.002
    points = [(-half, low, z)]
    points += [(-half + r - r * math.cos(a), HEIGHT - r + r * math.sin(a), z) for a in (math.pi * k / 24 for k in range(13))]
    points += [(half - r + r * math.sin(a), HEIGHT - r + r * math.cos(a), z) for a in (math.pi * k / 24 for k in range(13))]
    return [*points, (half, low, z)]


def _swing(gltf, nodes):
    times, steps = array("f"), array("f")
    for k in range(9):
        times.append(SHUTTER * k / 8)
        steps.extend(turned((0.0, 0.0, 1.0), -SWING[0] - (SWING[1] - SWING[0]) * k / 8))
    sampler = {"input": gltf.add_accessor(times, FLOAT, "SCALAR", target=None, with_bounds=True),
               "output": gltf.add_accessor(steps, FLOAT, "VEC4", target=None)}
    gltf.add("animations", {"name": "swing", "samplers": [sampler], "channels": [
        {"sampler": 0, "target": {"node": node, "path": "rotation"}} for node in nodes]})


def _desk(scene):
    gltf = scene.gltf
    grain = gltf.add_texture("cherry", textures.wood(512, 512, (0.085, 0.030, 0.014), (0.30, 0.125, 0.055), 11, 6))
    wear = gltf.add_texture("wear", textures.roughness(256, 0.16, 0.36, 6))
    desk = scene.textured("desk", grain, roughness_texture=wear)
    scene.add_object("desk", rounded_box((-0.9, -0.04, -0.45), (0.9, 0.0, 0.9), 0.004, 4, 1.6, (0.13, 0.42)), desk)
    lacquer = gltf.add_material("lacquer", base_color=(0.012, 0.012, 0.014), roughness=0.25, further_extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.03}})
    scene.add_object("base", rounded_box((-0.172, 0.0006, -0.064), (0.172, BASE_TOP, 0.064), 0.0035, 5), lacquer)


class _Evening:
    """A town at dusk far out of focus: a sky that glows above the horizon, and discs of lamps."""

    def __init__(self):
        # Direction, cosines of the radius' outer and inner edge, and radiance of each disc, by tenths of a radian.
        self._discs = {}
        numbers = random.Random(5)
        for _ in range(120):
            azimuth = numbers.uniform(-1.6, 1.6)
            height = min(numbers.gauss(0.01, 0.06), 0.16)
            radius = numbers.uniform(0.021, 0.026)
            color = numbers.choice(((1.0, 0.52, 0.17), (1.0, 0.66, 0.30), (1.0, 0.80, 0.52), (1.0, 0.22, 0.07),
                                    (0.55, 0.75, 1.0)))
            strength = 0.25 + 2.2 * numbers.random() ** 3
            disc = (direction(height, azimuth), math.cos(1.04 * radius), math.cos(0.93 * radius),
                    [strength * c for c in color])
            for step in {math.floor(10.0 * (azimuth + side * 1.2 * radius)) for side in (-1.0, 1.0)}:
                self._discs.setdefault(step, []).append(disc)

    def radiance(self, toward):
        height = math.asin(max(min(toward[1], 1.0), -1.0))
        azimuth = math.atan2(toward[0], -toward[2])
        front = 0.5 + 0.5 * math.cos(azimuth)
        glow = math.exp(-((height - 0.10) / 0.16) ** 2) * front
        dusk = math.exp(-max(height, 0.0) / 0.6)
        if height > 0.0:
            color = textures.mix((0.030, 0.045, 0.085), (0.060, 0.075, 0.125), dusk)
        else:
            color = textures.mix((0.020, 0.020, 0.026), (0.060, 0.075, 0.125), math.exp(height / 0.05))
        color = [c + 0.16 * glow * g for c, g in zip(color, (1.0, 0.46, 0.24))]
        for center, outer, inner, light in self._discs.get(math.floor(10.0 * azimuth), ()):
            cosine = dot(toward, center)
            if cosine > outer:
                cover = min((cosine - outer) / (inner - outer), 1.0)
                color = [c + cover * e for c, e in zip(color, light)]
        return tuple(color)
