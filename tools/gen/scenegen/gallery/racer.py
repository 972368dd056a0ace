"""A toy racing car in a studio: lacquer over metallic paint, turned aluminium, leather, and velvet below. Metres."""

import math

from ..images import png, to_srgb_byte
from ..mesh import panel, revolved
from ..noise import hashed
from ..vector import look_at
from . import textures
from .shapes import refined, rounded_box, surface, tube
from .stage import Stage, turned

LENGTH, HALF_WIDTH, FLOOR, TOP = 0.30, 0.042, 0.020, 0.034
WHEEL, TYRE, TRACK = 0.036, 0.0108, 0.063
AXLES = (0.090, -0.082)
# The opening for the driver in the body's own coordinates: around it and along it, 0 the nose.
SEAT, SEAT_AROUND, SEAT_ALONG = 0.545, 0.105, 0.085


def build():
    scene = Stage()
    _body(scene)
    _wheels(scene)
    _fittings(scene)
    _cloth(scene)
    _lamps(scene)
    scene.camera((0.370, 0.205, 0.375), (0.002, 0.034, 0.004), 20.5)
    scene.render_json.update({"/integrator/type": "path", "/integrator/max_depth": 16, "/lens_radius": 0.0030,
                              "/focus_distance": 0.49, "/environment/color": [0.07, 0.075, 0.085], "/color/exposure": 0.35})
    return scene


def _section(along):
    """Half the width, and the heights of belly, widest line and back of the body at a place from nose (0) to tail (1)."""
    blunt = max(math.sin(math.pi * along ** 0.60), 0.0)
    half = HALF_WIDTH * blunt ** 0.62
    rise = blunt ** 0.55
    # A fairing behind the driver's head, and a scuttle before the wheel.
    hump = 0.020 * math.exp(-((along - 0.77) / 0.095) ** 2) + 0.006 * math.exp(-((along - 0.40) / 0.07) ** 2)
    middle = FLOOR + 0.017 + 0.006 * along
    return half, middle - 0.017 * rise, middle, middle + (TOP - 0.006 * along + hump) * rise * (1.0 - 0.18 * along)


def _place(s, t):
    along = 0.5 - 0.5 * math.cos(math.pi * t)
    half, low, middle, high = _section(along)
    angle = math.pi * (1.0 - 2.0 * s)
    c, v = math.cos(angle), math.sin(angle)
    x = half * math.copysign(abs(c) ** 0.86, c)
    y = middle + ((high - middle) * v ** 0.92 if v > 0.0 else -(middle - low) * (-v) ** 0.62)
    # The fairing is narrow: above the widest line the sides lean in where the back is high.
    lean = 1.0 - 0.30 * max(v, 0.0) ** 2 * math.exp(-((along - 0.78) / 0.16) ** 2)
    return (x * lean, y, LENGTH * (0.5 - along))


def _body(scene):
    gltf = scene.gltf
    size = 1024
    livery = gltf.add_texture("livery", _livery(size))
    flakes = gltf.add_texture("flakes", textures.relief(256, lambda u, v: hashed(int(256 * u), int(256 * v), 5), 0.05))
    paint = scene.textured("paint", livery, flakes, metallic=0.55, roughness=0.36, double_sided=True, normal_scale=0.3,
                           further_extensions={
                               "KHR_materials_clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.015}})
    values = gltf.document["materials"][paint]
    values["alphaMode"] = "MASK"
    scene.add_object("body", surface(_place, 256, 320, wrap_columns=True, uv_scale=(1.0, 1.0)), paint)
    leather = gltf.add_material("leather", base_color=(0.10, 0.035, 0.015), roughness=0.5)
    rim = [_place(0.25 + SEAT_AROUND * math.cos(a), SEAT + SEAT_ALONG * math.sin(a))
           for a in (2.0 * math.pi * k / 96 for k in range(96))]
    scene.add_object("rim", tube(rim, 0.0021, 16, closed=True), leather)
    # Seat and its back, inside.
    z = 0.5 * LENGTH * math.cos(math.pi * SEAT)
    scene.add_object("seat", rounded_box((-0.020, 0.024, z - 0.022), (0.020, 0.036, z + 0.020), 0.005, 4), leather)
    scene.add_object("seat back", rounded_box((-0.019, 0.030, z - 0.028), (0.019, 0.064, z - 0.019), 0.004, 4), leather)
    column = z + 0.016
    wheel = [(0.0125 * math.cos(a), 0.0125 * math.sin(a), 0.0) for a in (2.0 * math.pi * k / 48 for k in range(48))]
    wood = gltf.add_material("wheel wood", base_color=(0.16, 0.06, 0.02), roughness=0.3)
    place = {"translation": (0.0, 0.067, column), "rotation": turned((1.0, 0.0, 0.0), -28.0)}
    scene.add_object("steering wheel", tube(wheel, 0.0013, 12, closed=True), wood, **place)
    steel = gltf.add_material("steel", base_color=(0.72, 0.73, 0.75), metallic=1.0, roughness=0.15)
    for k in range(3):
        a = math.pi * (0.5 + 2.0 * k / 3.0)
        scene.add_object(f"spoke {k + 1}", tube([(0.0, 0.0, 0.0), (0.0125 * math.cos(a), 0.0125 * math.sin(a), 0.0)], 0.0009, 8),
                         steel, **place)


def _livery(size):
    """Red with two stripes along the back, a roundel with its number on both sides, and a hole for the driver, with alpha."""
    red, white, black = (0.40, 0.008, 0.010), (0.72, 0.70, 0.65), (0.012, 0.012, 0.014)
    pixels = bytearray()
    for y in range(size):
        v = (y + 0.5) / size
        along = 0.5 - 0.5 * math.cos(math.pi * v)
        half, low, middle, high = _section(along)
        for x in range(size):
            u = (x + 0.5) / size
            color, alpha = red, 255
            across = half * math.cos(2.0 * math.pi * u)
            if u < 0.5 and 0.0022 < abs(across) < 0.0085 and along > 0.035:
                color = white
            # Millimetres on the side, seen from there.
            side = -1.0 if u < 0.25 else 1.0
            rise = middle + (high - middle) * max(math.sin(2.0 * math.pi * u), 0.0) - (middle + 0.0105)
            ahead = LENGTH * (0.50 - along)
            if u < 0.5 and math.hypot(ahead, rise) < 0.0132 and abs(across) > 0.009:
                color = black if _seven(-side * ahead / 0.0132, rise / 0.0132) else white
            if math.hypot((u - 0.25) / SEAT_AROUND, (v - SEAT) / SEAT_ALONG) < 1.0:
                alpha = 0
            pixels.extend((*map(to_srgb_byte, color), alpha))
    return png(size, size, bytes(pixels), 4)


def _seven(x, y):
    """Whether a place of the unit disc is on the numeral."""
    if abs(x) < 0.36 and 0.36 < y < 0.56:
        return True
    lean = 0.36 - 0.42 * (0.56 - y) / 1.12
    return -0.58 < y < 0.5 and lean - 0.22 < x < lean


def _wheels(scene):
    gltf = scene.gltf
    tread = gltf.add_texture("tread", textures.relief(
        128, lambda u, v: 0.0 if (8.0 * u + abs(2.0 * v - 1.0)) % 1.0 < 0.16 else 1.0, 0.5))
    rubber = scene.textured("rubber", None, tread, base_color=(0.018, 0.018, 0.019), roughness=0.55, normal_scale=0.6)
    turned_metal = gltf.add_material("turned aluminium", base_color=(0.78, 0.78, 0.80), metallic=1.0, roughness=0.30,
                                     further_extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.85}})
    brass = gltf.add_material("brass", base_color=(0.85, 0.62, 0.28), metallic=1.0, roughness=0.15)
    radius = WHEEL - TYRE

    def tyre(s, t):
        a, b = 2.0 * math.pi * s, 2.0 * math.pi * t
        c, v = math.cos(b), math.sin(b)
        # A little flat where it meets the road.
        r = radius + TYRE * math.copysign(abs(c) ** 0.8, c)
        return (r * math.sin(a), 0.78 * TYRE * math.copysign(abs(v) ** 0.8, v), r * math.cos(a))

    tyre_mesh = surface(tyre, 128, 48, uv_scale=(14.0, 2.0))
    outline = ((0.0001, 0.0078), (0.0035, 0.0078), (0.0048, 0.0072), (0.0055, 0.0056), (0.0085, 0.0040), (0.0130, 0.0048),
               (0.0185, 0.0064), (0.0220, 0.0074), (0.0242, 0.0076), (0.0256, 0.0070), (0.0262, 0.0050))

    def disc(s, t):
        k = min(int(t * (len(outline) - 1)), len(outline) - 2)
        u = t * (len(outline) - 1) - k
        # From the rim inwards, so that the front is outside.
        (r0, h0), (r1, h1) = outline[-1 - k], outline[-2 - k]
        a = 2.0 * math.pi * s
        r, h = r0 + (r1 - r0) * u, h0 + (h1 - h0) * u
        return (r * math.sin(a), h, r * math.cos(a))

    disc_mesh = surface(disc, 128, 60, uv_scale=(1.0, 1.0))
    knob = revolved(*_cap(0.0042, 0.0040), 48)
    for i, z in enumerate(AXLES):
        scene.add_object(f"axle {i + 1}", tube([(-TRACK, WHEEL, z), (TRACK, WHEEL, z)], 0.0028, 20), brass)
        for side in (-1.0, 1.0):
            name = f"{'front' if i == 0 else 'rear'} {'left' if side < 0.0 else 'right'}"
            place = {"translation": (side * TRACK, WHEEL, z), "rotation": turned((0.0, 0.0, 1.0), -90.0 * side)}
            scene.add_object(f"tyre {name}", tyre_mesh, rubber, **place)
            scene.add_object(f"disc {name}", disc_mesh, turned_metal, **place)
            scene.add_object(f"knob {name}", knob, brass,
                             **{**place, "translation": (side * (TRACK + 0.0074), WHEEL, z)})


def _cap(radius, height):
    """Half an ellipse, for `revolved`, which stands on y = 0."""
    angles = [0.5 * math.pi * k / 12 for k in range(13)]
    points = [(radius * math.cos(a), height * math.sin(a)) for a in angles]
    return points, [(math.cos(a), math.sin(a)) for a in angles]


def _fittings(scene):
    gltf = scene.gltf
    chrome = gltf.add_material("chrome", base_color=(0.82, 0.83, 0.85), metallic=1.0, roughness=0.04)
    pane = gltf.add_material("pane", base_color=(0.92, 0.96, 1.0), roughness=0.0, transmission=1.0, double_sided=True)
    # Exhausts: from each side of the bonnet into a pipe to the tail.
    for side in (-1.0, 1.0):
        path = [(side * x, y, z) for x, y, z in (
            (0.030, 0.046, 0.070), (0.0415, 0.040, 0.063), (0.0470, 0.034, 0.050), (0.0480, 0.031, 0.034), (0.0478, 0.030, 0.0),
            (0.0450, 0.030, -0.040), (0.0375, 0.032, -0.100), (0.0345, 0.033, -0.128))]
        scene.add_object(f"exhaust {side:+.0f}", tube(refined(path, 10), 0.0031, 20), chrome)
    # The grille: an oval of chrome before the nose, with bars.
    along = 0.030
    half, low, _, high = _section(along)
    z, middle = LENGTH * (0.5 - along) + 0.001, 0.5 * (low + high)
    tall = 0.5 * (high - low)
    oval = [(0.80 * half * math.cos(a), middle + 0.78 * tall * math.sin(a), z + 0.0035)
            for a in (2.0 * math.pi * k / 64 for k in range(64))]
    scene.add_object("grille", tube(oval, 0.0016, 16, closed=True), chrome)
    for k in range(-3, 4):
        x = 0.19 * k * half
        reach = 0.78 * tall * math.sqrt(max(1.0 - (x / (0.80 * half)) ** 2, 0.0))
        ends = [(x, middle - reach, z + 0.0035), (x, middle + reach, z + 0.0035)]
        scene.add_object(f"bar {k + 4}", tube(ends, 0.0006, 10), chrome)
    # The windscreen stands before the opening, bent around it.
    def screen(s, t):
        a = math.pi * (0.18 + 0.64 * s)
        x, y, z = _place(0.25 + 1.12 * SEAT_AROUND * math.cos(math.pi - a), SEAT - 1.16 * SEAT_ALONG * math.sin(a))
        return (x * (1.0 - 0.12 * t), y + 0.0155 * t * math.sin(math.pi * (0.12 + 0.76 * s)), z - 0.008 * t)

    scene.add_object("windscreen", surface(screen, 48, 8), pane)
    edge = [screen(s / 48.0, 1.0) for s in range(49)]
    scene.add_object("edge of the windscreen", tube(edge, 0.0007, 10), chrome)
    cap = revolved(*_cap(0.0052, 0.0026), 48)
    x, y, z = _place(0.25, 0.80)
    scene.add_object("filler cap", cap, chrome, translation=(x, y - 0.0004, z), rotation=turned((1.0, 0.0, 0.0), -20.0))


def _cloth(scene):
    """Velvet that lies flat below the car and in folds around it, and rises behind."""
    gltf = scene.gltf
    velvet = gltf.add_material("velvet", base_color=(0.010, 0.045, 0.050), roughness=1.0, double_sided=True, further_extensions={
        "KHR_materials_sheen": {"sheenColorFactor": [0.24, 0.50, 0.52], "sheenRoughnessFactor": 0.38}})

    def place(s, t):
        x, z = 2.6 * (s - 0.5), 0.55 - 1.85 * t
        away = max(math.hypot(x / 0.17, (z - 0.01) / 0.24) - 1.0, 0.0)
        grow = min(away / 1.6, 1.0) ** 1.4
        bend = 0.9 * math.sin(2.3 * z + 1.0) + 0.5 * math.sin(3.1 * x - 1.3 * z)
        folds = 0.5 + 0.5 * math.sin(17.0 * x + 6.0 * z + 2.2 * bend)
        fine = 0.5 + 0.5 * math.sin(31.0 * x - 19.0 * z + 1.7 * bend + 1.0)
        y = grow * (0.036 * folds ** 2 + 0.009 * fine ** 2)
        back = max(-0.42 - z, 0.0)
        return (x, y + 1.6 * back * back, z)

    scene.add_object("velvet", surface(place, 420, 360), velvet)


def _lamps(scene):
    target = (0.0, 0.04, 0.0)
    for name, center, size, radiance in (
            ("overhead", (-0.05, 0.85, -0.18), (0.75, 0.42), (13.0, 12.6, 12.0)),
            ("strip", (0.85, 0.30, 0.10), (0.16, 0.95), (13.0, 13.6, 15.0)),
            ("kicker", (-0.80, 0.35, -0.55), (0.40, 0.50), (17.0, 14.4, 11.8)),
            ("front", (0.10, 0.75, 1.30), (0.60, 0.40), (3.2, 3.2, 3.4))):
        scene.add_lamp(name, panel(*size), radiance, translation=center, rotation=look_at(center, target))
