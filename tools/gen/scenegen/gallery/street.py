"""A street at night: some thousand lit windows and lamps, and what a wet pavement makes of them. Metres."""

import math
import random

from ..images import linear_png
from ..mesh import box, ground, merged, rectangle, sphere
from ..noise import hashed
from . import textures
from .shapes import rounded_box, tube
from .stage import Stage

STREET, PAVEMENT, KERB = 3.6, 2.6, 0.14
LENGTH, NEAR = 130.0, 6.0
STOREY = 3.3


def build():
    scene = Stage()
    gltf = scene.gltf
    puddles = gltf.add_texture("puddles", textures.roughness(512, 0.03, 0.55, 5, 5, 21))
    asphalt_relief = gltf.add_texture("asphalt relief", textures.relief(
        512, lambda u, v: textures.fractal(u, v, 64, 64, 2, 70), 0.8))
    asphalt = scene.textured("asphalt", None, asphalt_relief, puddles, base_color=(0.035, 0.036, 0.040), normal_scale=0.25)
    scene.add_object("road", ground(140.0, 0.0, 0.16), asphalt)
    numbers = random.Random(12)
    flags = scene.textured("flags", None, asphalt_relief, puddles, base_color=(0.10, 0.095, 0.09), normal_scale=0.25)
    for side in (-1.0, 1.0):
        a, b = sorted((side * STREET, side * (STREET + PAVEMENT)))
        for k in range(int((LENGTH + NEAR) / 1.5)):
            z = NEAR - 1.5 * k
            scene.add_object(f"flag {side:+.0f} {k}", rounded_box((a, -0.05, z - 1.494), (b, KERB + 0.004 * numbers.random(), z), 0.02,
                                                                  2, 0.3, (numbers.random(), numbers.random())), flags)
    walls = [gltf.add_material(f"wall {k + 1}", base_color=color, roughness=0.85) for k, color in enumerate((
        (0.34, 0.17, 0.11), (0.42, 0.36, 0.28), (0.24, 0.25, 0.27), (0.46, 0.30, 0.18), (0.30, 0.11, 0.08)))]
    frame = gltf.add_material("frame", base_color=(0.05, 0.05, 0.055), roughness=0.5)
    trim = gltf.add_material("trim", base_color=(0.45, 0.42, 0.37), roughness=0.8)
    glass = gltf.add_material("dark pane", base_color=(0.01, 0.012, 0.016), roughness=0.04)
    shops = [gltf.add_material(f"shop {k + 1}", base_color=(0, 0, 0), emission=color, emissive_texture=gltf.add_texture(
        f"shop {k + 1}", _shop(256, k))) for k, color in enumerate(((1.5, 0.95, 0.46), (1.4, 0.78, 0.32), (1.2, 1.02, 0.76)))]
    lit = []
    for k, color in enumerate(((1.0, 0.62, 0.28), (1.0, 0.72, 0.42), (1.0, 0.50, 0.18), (0.72, 0.84, 1.0), (1.0, 0.80, 0.56))):
        for level in (0.5, 1.1, 2.2):
            lit.append(gltf.add_material(f"lit {k} {level}", base_color=(0, 0, 0), emission=[level * c for c in color]))
    for side in (-1.0, 1.0):
        z, count = NEAR, 0
        while z > -LENGTH:
            width = numbers.choice((7.0, 8.4, 9.8, 11.2))
            _house(scene, side, z, width, numbers, walls[numbers.randrange(len(walls))], trim, frame, glass, lit, shops, count)
            z -= width
            count += 1
    _lanterns(scene, numbers)
    # Level and shifted, so that what is upright stays so.
    scene.camera((-1.75, 1.72, 3.4), (0.75, 1.72, -22.0), 46.0)
    scene.render_json["/cameras/camera/shift"] = [0.0, 0.105]
    scene.render_json.update({"/integrator/type": "path", "/integrator/max_depth": 8, "/integrator/light_samples": 2,
                              "/environment/color": [0.010, 0.014, 0.026], "/color/exposure": 0.2})
    return scene


def _house(scene, side, front, width, numbers, wall, trim, frame, glass, lit, shops, count):
    """A terraced house with its windows, of which about half are lit, and a shop below."""
    storeys = numbers.choice((4, 4, 5, 6))
    ground_floor = 3.9
    height = ground_floor + storeys * STOREY
    x = side * (STREET + PAVEMENT)
    name = f"house {side:+.0f} {count}"

    def span(z0, z1, y0, y1, out, inward):
        """A box in front of the facade: `out` towards the street, `inward` into the wall."""
        low, high = sorted((x - side * out, x + side * inward))
        return (low, y0, z1), (high, y1, z0)

    parts = [rounded_box(*span(front, front - width, 0.0, height, 0.0, 9.0), 0.03, 2)]
    scene.add_object(name, merged(parts), wall)
    cornices = [rounded_box(*span(front + 0.03, front - width - 0.03, y, y + h, out, 0.1), 0.03, 2)
                for y, h, out in ((ground_floor - 0.35, 0.35, 0.22), (height - 0.45, 0.5, 0.45), (height, 0.9, 0.05))]
    panes = {}
    frames = []
    bays = int(width / 1.4)
    pitch = width / bays
    for storey in range(storeys):
        y = ground_floor + STOREY * storey + 0.75
        for bay in range(bays):
            z = front - pitch * (bay + 0.5)
            h = 1.75 if storey < storeys - 1 else 1.45
            material = lit[numbers.randrange(len(lit))] if numbers.random() < 0.56 else glass
            panes.setdefault(material, []).append(_pane(x - side * 0.012, z, 0.92, y, h, side))
            cornices.append(rounded_box(*span(z + 0.60, z - 0.60, y - 0.14, y - 0.02, 0.16, 0.05), 0.015, 1))
            cornices.append(rounded_box(*span(z + 0.58, z - 0.58, y + h + 0.02, y + h + 0.2, 0.08, 0.05), 0.015, 1))
            for a, b, c, d in ((z + 0.49, z + 0.43, y - 0.03, y + h + 0.03), (z - 0.43, z - 0.49, y - 0.03, y + h + 0.03),
                               (z + 0.025, z - 0.025, y, y + h), (z + 0.46, z - 0.46, y + 0.60 * h, y + 0.60 * h + 0.05),
                               (z + 0.49, z - 0.49, y - 0.04, y + 0.03), (z + 0.49, z - 0.49, y + h - 0.03, y + h + 0.04)):
                frames.append(box(*span(a, b, c, d, 0.06, 0.02)))
    # The shop: three wide panes, and its sign.
    shop = shops[numbers.randrange(len(shops))]
    for k in range(3):
        a = front - 0.35 - k * (width - 0.7) / 3
        b = a - (width - 0.7) / 3 + 0.18
        panes.setdefault(shop, []).append(_pane(x - side * 0.012, 0.5 * (a + b), a - b, 0.55, 2.45, side, 0.4))
        for c, d, e, f in ((a + 0.05, a - 0.05, 0.45, 3.1), (b + 0.05, b - 0.05, 0.45, 3.1), (a, b, 0.45, 0.58), (a, b, 2.95, 3.1),
                           (a, b, 2.38, 2.44)):
            frames.append(box(*span(c, d, e, f, 0.07, 0.02)))
    scene.add_object(f"{name} trim", merged(cornices), trim)
    scene.add_object(f"{name} frames", merged(frames), frame)
    for k, (material, quads) in enumerate(panes.items()):
        scene.add_object(f"{name} panes {k + 1}", merged(quads), material)


def _shop(size, seed):
    """What a shop shows: three shelves of jars and boxes in the light of a lamp above, and a curtain behind the lower half."""
    def texel(u, v):
        column, shelf = 7.0 * u, 3.0 * v
        place, across, up = math.floor(column), column % 1.0, 1.0 - shelf % 1.0
        lamp = 0.35 + 0.65 * math.exp(-((u - 0.5) ** 2 + 0.6 * v * v) / 0.16)
        kind, goods = hashed(place, math.floor(shelf), seed), hashed(place, math.floor(shelf), seed + 9)
        color = (0.44, 0.32, 0.20)
        if up < 0.07:
            color = (0.11, 0.065, 0.04)
        elif kind > 0.22:
            tall, half = 0.30 + 0.45 * goods, 0.20 + 0.20 * kind
            side = abs(across - 0.5) / half
            # Jars have shoulders.
            edge = 1.0 if kind < 0.6 or up < 0.8 * tall else 1.0 - 2.0 * (up / tall - 0.8)
            if up - 0.07 < tall and side < edge:
                tone = [0.07 + 0.34 * hashed(place, math.floor(shelf), seed + k) ** 2 for k in (5, 6, 7)]
                color = [c * (1.15 - 0.75 * side * side) for c in textures.mix(tone, (0.22, 0.13, 0.06), 0.7)]
        return [lamp * c for c in color]

    return linear_png(size, size, texel)


def _pane(x, z, width, low, height, side, uv_per_meter=0.0):
    """A pane that faces the street."""
    if side > 0.0:
        return rectangle((x, low, z - 0.5 * width), (0.0, 0.0, width), (0.0, height, 0.0), uv_per_meter)
    return rectangle((x, low, z + 0.5 * width), (0.0, 0.0, -width), (0.0, height, 0.0), uv_per_meter)


def _lanterns(scene, numbers):
    """Lamp posts on both sides, and strings of small lamps across the street."""
    iron = scene.gltf.add_material("iron", base_color=(0.03, 0.035, 0.035), roughness=0.4)
    bulb = scene.gltf.add_material("bulb", base_color=(0, 0, 0), emission=(60.0, 40.0, 20.0))
    post = merged([tube([(0, 0, 0), (0, 0.9, 0), (0, 1.0, 0), (0, 4.0, 0)], [0.10, 0.085, 0.05, 0.04], 16),
                   tube([(0, 3.6, -0.25), (0, 3.6, 0.25)], 0.018, 8)])
    places = [{"translation": (side * (STREET + 0.45), KERB, -9.0 - 17.0 * k - (8.5 if side > 0 else 0.0))}
              for side in (-1.0, 1.0) for k in range(7)]
    scene.copies("post", post, iron, places)
    scene.copies("lantern", sphere(0.17, 6), bulb, [
        {"translation": (p["translation"][0], KERB + 4.16, p["translation"][2])} for p in places])
    small = [scene.gltf.add_material(f"small bulb {k + 1}", base_color=(0, 0, 0), emission=color)
             for k, color in enumerate(((130.0, 85.0, 40.0), (130.0, 100.0, 60.0), (110.0, 62.0, 24.0)))]
    wire, bulbs = [], [[], [], []]
    for k in range(28):
        z0, z1 = -7.0 - 4.2 * k, -7.0 - 4.2 * k - numbers.uniform(-3.0, 3.0)
        reach, sag, high = STREET + PAVEMENT - 0.05, numbers.uniform(0.7, 1.3), numbers.uniform(6.2, 7.0)
        path = [(reach * u, high + sag * (u * u - 1.0), z0 + (z1 - z0) * 0.5 * (u + 1.0)) for u in
                (-1.0 + 2.0 * i / 60 for i in range(61))]
        wire.append(tube(path, 0.008, 5))
        for point in path[1:-1]:
            bulbs[numbers.randrange(3)].append(sphere(0.03, 2, (point[0], point[1] - 0.05, point[2])))
    scene.add_object("wires", merged(wire), iron)
    for k, meshes in enumerate(bulbs):
        scene.add_object(f"small bulbs {k + 1}", merged(meshes), small[k])
