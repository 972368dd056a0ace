"""A gold ring with a brilliant among cut stones on slate: dispersion, and the light that the stones throw. Centimetres."""

import math
import random

from ..mesh import convex, panel, revolved, sphere
from ..scenes.diamond import DISPERSION, INDEX, MAIN, brilliant
from ..vector import add, cross, dot, look_at, normalize, quaternion_of_axes, scale
from . import textures
from .shapes import height_field, moved, refined, tube
from .stage import Stage

STONE, BAND, BAND_HALF_WIDTH, BAND_HALF_DEPTH = 0.36, 0.92, 0.13, 0.075
# Index, Abbe number and the colour that is left after half a centimetre.
GEMS = {"sapphire": (1.77, 72.0, [0.03, 0.12, 0.75]), "ruby": (1.77, 72.0, [0.75, 0.02, 0.06]),
        "emerald": (1.58, 76.0, [0.04, 0.62, 0.22]), "citrine": (1.55, 70.0, [0.95, 0.60, 0.08])}


def build():
    scene = Stage()
    gltf = scene.gltf
    slate_color = gltf.add_texture("slate", textures.mottled(512, (0.050, 0.053, 0.059), (0.115, 0.117, 0.121), 5, 6))
    slate_relief = gltf.add_texture("slate relief", textures.relief(
        512, lambda u, v: textures.fractal(u, v, 6, 10, 5, 40), 5.0))
    slate = scene.textured("slate", slate_color, slate_relief, roughness=0.62, normal_scale=0.6)
    scene.add_object("slate", height_field((-40.0, -40.0), (40.0, 12.0), 2, 2, lambda x, z: 0.0, 0.16), slate)
    diamond = scene.add_glass("diamond", INDEX, thickness=STONE, dispersion=DISPERSION)
    gems = {name: scene.add_glass(name, index, thickness=STONE, dispersion=20.0 / abbe, attenuationColor=color,
                                  attenuationDistance=0.5) for name, (index, abbe, color) in GEMS.items()}
    _ring(scene, diamond)
    _stones(scene, diamond, gems)
    _lamps(scene)
    scene.camera((0.75, 2.7, 5.6), (0.05, 0.28, 0.0), 20.5)
    scene.render_json.update({
        "/integrator/type": "vcm", "/integrator/max_depth": 24, "/lens_radius": 0.055, "/focus_distance": 5.85,
        "/materials/gold/conductor/metal": "Au", "/materials/gold/conductor/roughness": 0.09,
        "/environment/color": [0.10, 0.11, 0.13]})
    return scene


def _ring(scene, diamond):
    """A solitaire that lies on its side: its crown and the far side of its band carry it."""
    gold = scene.gltf.add_material("gold", base_color=(1.0, 0.78, 0.34), metallic=1.0, roughness=0.1)
    corner = 0.055
    outline = []
    for k in range(33):
        # A rounded rectangle around the middle of the band, anticlockwise as seen with the radius to the right.
        angle = 2.0 * math.pi * k / 32
        c, s = math.cos(angle), math.sin(angle)
        outline.append(((BAND_HALF_DEPTH - corner) * math.copysign(1.0, c) * min(1.0, abs(3.0 * c)) + corner * c,
                        (BAND_HALF_WIDTH - corner) * math.copysign(1.0, s) * min(1.0, abs(3.0 * s)) + corner * s))
    points = [(BAND + x, y) for x, y in outline[:-1]]
    normals = []
    for k in range(32):
        (x0, y0), (x1, y1) = outline[k - 1 if k else 31], outline[k + 1]
        length = math.hypot(x1 - x0, y1 - y0)
        normals.append(((y1 - y0) / length, (x0 - x1) / length))
    head = BAND + BAND_HALF_DEPTH + 0.30  # of the girdle from the ring's axis
    lowest, opposite = STONE + 0.065, BAND_HALF_WIDTH
    tilt = math.asin((lowest - opposite) / (head + BAND))
    turn = math.radians(-12.0)
    # The ring's axes: Z towards the stone.
    z = (math.cos(tilt) * math.sin(turn), math.sin(tilt), math.cos(tilt) * math.cos(turn))
    x = normalize(cross((0.0, 1.0, 0.0), z))
    y = cross(z, x)
    height = opposite * math.cos(tilt) + BAND * math.sin(tilt) + 0.002
    place = {"translation": (-0.38, height, -0.75), "rotation": quaternion_of_axes(x, y, z)}

    def outwards(point):
        """From the stone's own axes to the ring's: its table faces away from the ring."""
        return (point[0], -point[2], head + point[1])

    def stone_direction(point):
        return (point[0], -point[2], point[1])

    parts = [revolved(points, normals, 192, loop=True)]
    for k in range(6):
        angle = 2.0 * math.pi * (k + 0.5) / 6
        c, s = math.cos(angle), math.sin(angle)
        profile = ((0.10, -0.33), (0.20, -0.24), (0.33, -0.09), (0.385, 0.01), (0.377, 0.055), (0.335, 0.095), (0.305, 0.112))
        parts.append(tube([outwards((r * c, h, r * s)) for r, h in refined(profile)],
                          [0.030 + 0.004 * math.cos(k) for _ in refined(profile)], 16))
    for radius, h, thickness in ((0.235, -0.185, 0.022),):
        parts.append(tube([outwards((radius * math.cos(a), h, radius * math.sin(a)))
                           for a in (2.0 * math.pi * i / 64 for i in range(64))], thickness, 12, closed=True))
    for k, part in enumerate(parts):
        scene.add_object(f"ring {k + 1}", part, gold, **place)
    stone = moved(convex(brilliant(STONE)), lambda p: outwards(p))
    scene.add_object("stone", stone, diamond, **place)


def step_cut(width, depth):
    """Planes of an emerald cut about the Y axis: an octagon with three steps above and below its girdle."""
    planes = [((0.0, 1.0, 0.0), 0.30 * depth)]
    corner = 0.72
    for k in range(8):
        azimuth = 0.25 * math.pi * k
        c, s = math.cos(azimuth), math.sin(azimuth)
        reach = (width if k % 4 == 0 else depth) if k % 2 == 0 else corner * (width + depth) / math.sqrt(2.0)
        planes.append(((c, 0.0, s), reach))
        for degrees, share, start in ((50.0, 0.0, 0.03), (38.0, 0.12, 0.16), (27.0, 0.26, 0.26)):
            up, out = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            planes.append(((out * c, up, out * s), out * (reach - share * depth) + up * start * depth))
        for degrees, share, start in ((58.0, 0.0, 0.03), (47.0, 0.26, 0.40), (36.0, 0.56, 0.68)):
            up, out = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            planes.append(((out * c, -up, out * s), out * (reach - share * depth) + up * start * depth))
    return planes


def _resting(planes, normal, yaw):
    """The rotation that lays the facet with `normal` on the ground, and the height of the stone's centre."""
    offset = next(d for n, d in planes if dot(n, normal) > 1.0 - 1e-9)
    helper = (1.0, 0.0, 0.0) if abs(normal[0]) < 0.8 else (0.0, 0.0, 1.0)
    u = normalize(cross(helper, normal))
    w = cross(u, normal)
    down, ahead = (0.0, -1.0, 0.0), (math.cos(yaw), 0.0, math.sin(yaw))
    side = cross(ahead, down)
    axes = [add(add(scale(ahead, u[i]), scale(down, normal[i])), scale(side, w[i])) for i in range(3)]
    return quaternion_of_axes(*axes), offset


def _stones(scene, diamond, gems):
    def main_facet(k):
        azimuth = 0.25 * math.pi * k
        return (math.sin(MAIN) * math.cos(azimuth), -math.cos(MAIN), math.sin(MAIN) * math.sin(azimuth))

    cut = brilliant(1.0)
    rest = main_facet(0)
    for k, (material, radius, x, z, yaw) in enumerate((
            (diamond, 0.46, 0.95, 0.20, 2.25), (diamond, 0.17, 0.10, 1.02, 0.4), (diamond, 0.13, 0.62, 1.22, 3.6),
            (diamond, 0.20, 1.62, -0.62, 1.2), (gems["sapphire"], 0.30, 0.36, -0.62, 0.9), (gems["ruby"], 0.22, -1.02, 0.78, 1.9),
            (gems["ruby"], 0.15, 1.52, 0.72, 5.0), (gems["citrine"], 0.21, -1.62, -0.30, 2.6), (diamond, 0.11, -0.45, 1.20, 2.2),
            (gems["sapphire"], 0.14, -1.62, 0.55, 4.1), (diamond, 0.15, -1.25, -1.30, 0.1))):
        rotation, offset = _resting(cut, rest, yaw)
        scene.add_object(f"brilliant {k + 1}", convex(brilliant(radius)), material,
                         translation=(x, radius * offset + 0.001, z), rotation=rotation)
    emerald = step_cut(0.36, 0.27)
    scene.add_object("emerald", convex(emerald), gems["emerald"], translation=(1.30, 0.30 * 0.27 + 0.001, -1.45),
                     rotation=_resting(emerald, (0.0, 1.0, 0.0), 0.5)[0])


def _lamps(scene):
    for k, (center, radius, radiance) in enumerate((
            ((-3.6, 5.2, -2.2), 0.09, (14000.0, 13000.0, 11500.0)), ((4.4, 4.6, -1.2), 0.07, (9000.0, 9600.0, 10800.0)))):
        scene.add_lamp(f"lamp {k + 1}", sphere(radius, 8), radiance, translation=center)
    for name, center, size, radiance in (("strip", (4.5, 5.5, 4.5), (1.2, 6.0), (7.0, 7.3, 8.0)),
                                         ("soft box", (-5.0, 6.5, 2.0), (5.0, 4.0), (4.0, 3.7, 3.2))):
        scene.add_lamp(name, panel(*size), radiance, translation=center, rotation=look_at(center, (0.0, 0.3, 0.0)))
    numbers = random.Random(3)
    for k in range(26):
        x = numbers.uniform(-11.0, 11.0)
        warm = numbers.random()
        scene.add_lamp(f"far lamp {k + 1}", sphere(0.05, 4), scale((1.0, 0.55 + 0.25 * warm, 0.20 + 0.4 * warm), 90.0),
                       translation=(x, numbers.uniform(0.6, 5.5), -24.0 + numbers.uniform(-5.0, 5.0)))
