"""A living room in the morning: sun through blinds and curtains, oak boards, linen, a plant. Metres."""

import math
import random

from ..images import linear_png
from ..mesh import box, merged, rectangle, revolved, smooth_outline, sphere
from ..room import add_room
from ..sky import Sky
from ..vector import add, direction, look_at, normalize, scale
from . import textures
from .shapes import refined, rounded_box, surface, tube
from .stage import Stage, turned

WIDTH, HEIGHT, DEPTH = 5.2, 2.75, 5.8
# Where windows are: along the left wall from the back, and their heights.
WINDOWS, SILL, LINTEL, REVEAL = ((0.75, 2.30), (2.95, 4.50)), 0.10, 2.36, 0.24
BOARD = 0.142
SUN = math.radians(33.0), math.radians(-72.0)
UNIT, TURBIDITY = 4.2, 3.0


def build():
    scene = Stage()
    _shell(scene)
    _windows(scene)
    _curtains(scene)
    _seats(scene)
    _table(scene)
    _plant(scene)
    _things(scene)
    _daylight(scene)
    scene.camera((4.55, 1.30, 5.35), (2.02, 0.88, 1.0), 37.0)
    scene.render_json.update({"/integrator/type": "bdpt", "/integrator/max_depth": 12, "/lights/sun/angle": 0.0093,
                              "/color/exposure": 0.7})
    return scene


def _daylight(scene):
    """The sun, and of the sky what the windows show: a bright surface behind each, which is easier to find than the sky."""
    sky = Sky(*SUN, TURBIDITY, UNIT, (0.20, 0.24, 0.12))
    color, intensity = sky.sun_color_and_intensity()
    scene.gltf.add_directional_light("sun", color, intensity, look_at(sky.sun_direction, (0.0, 0.0, 0.0)))
    for k, (z0, z1) in enumerate(WINDOWS):
        scene.render_json[f"/lights/window {k + 1}"] = {
            "type": "rectangle", "position": [-REVEAL - 0.02, 0.5 * (SILL + LINTEL), 0.5 * (z0 + z1)],
            "look_at": [1.0, 0.5 * (SILL + LINTEL), 0.5 * (z0 + z1)], "width": z1 - z0, "height": LINTEL - SILL,
            "radiance": 5.0, "color": [0.80, 0.92, 1.0], "stops_light": False}


def _shell(scene):
    gltf = scene.gltf
    relief = gltf.add_texture("trowel", textures.relief(256, lambda u, v: textures.fractal(u, v, 8, 8, 3, 33), 1.2))
    white = scene.textured("white plaster", None, relief, base_color=(0.80, 0.78, 0.74), roughness=0.9, normal_scale=0.4)
    green = scene.textured("green plaster", None, relief, base_color=(0.30, 0.36, 0.29), roughness=0.85, normal_scale=0.4)
    openings = {"left": [((DEPTH - z1, SILL), (DEPTH - z0, LINTEL)) for z0, z1 in WINDOWS]}
    add_room(scene, (0.0, 0.0, 0.0), (WIDTH, HEIGHT, DEPTH), {
        "ceiling": white, "left": white, "right": white, "back": green, "front": white}, openings, 0.7)
    grain = gltf.add_texture("oak", textures.wood(512, 512, (0.16, 0.085, 0.040), (0.46, 0.29, 0.155), 13, 3))
    wear = gltf.add_texture("wear", textures.roughness(256, 0.22, 0.46, 6))
    tones = [scene.textured(f"oak {k + 1}", grain, roughness_texture=wear, base_color=(tone, tone, 0.97 * tone))
             for k, tone in enumerate((1.0, 0.90, 0.80, 0.70))]
    numbers = random.Random(21)
    boards = {}
    for row in range(math.ceil(DEPTH / BOARD)):
        z, x = row * BOARD, -numbers.uniform(0.2, 1.6)
        while x < WIDTH:
            end = x + numbers.uniform(1.3, 2.1)
            mesh = rounded_box((x + 0.0006, -0.02, z + 0.0006), (end - 0.0006, 0.0, z + BOARD - 0.0006), 0.0016, 2, 0.55,
                               (numbers.random(), numbers.random()))
            boards.setdefault(numbers.randrange(len(tones)), []).append(mesh)
            x = end
    for k, meshes in boards.items():
        scene.add_object(f"boards {k + 1}", merged(meshes), tones[k])
    paint = gltf.add_material("paint", base_color=(0.78, 0.77, 0.74), roughness=0.4)
    skirting = [rounded_box((0.0, 0.001, -0.004), (WIDTH, 0.11, 0.016), 0.005, 3)]
    ends = [0.0, *(z for window in WINDOWS for z in window), DEPTH]
    skirting += [rounded_box((-0.004, 0.001, a), (0.016, 0.11, b), 0.005, 3) for a, b in zip(ends[::2], ends[1::2])]
    scene.add_object("skirting", merged(skirting), paint)


def _windows(scene):
    """Reveals, frames with a crossbar, and a blind of curved slats over the upper half."""
    gltf = scene.gltf
    paint = gltf.add_material("window paint", base_color=(0.80, 0.79, 0.76), roughness=0.35)
    slat = gltf.add_material("slat", base_color=(0.62, 0.45, 0.28), roughness=0.45, double_sided=True)
    parts, slats, cords = [], [], []
    for z0, z1 in WINDOWS:
        out = -REVEAL
        parts += [box((out, SILL - 0.04, z0 - 0.02), (0.03, SILL, z1 + 0.02)),
                  box((out, LINTEL, z0 - 0.02), (-0.0005, LINTEL + 0.04, z1 + 0.02)),
                  box((out, SILL, z0 - 0.04), (-0.0005, LINTEL, z0)), box((out, SILL, z1), (-0.0005, LINTEL, z1 + 0.04))]
        a, b, middle = out + 0.03, out + 0.085, 0.5 * (z0 + z1)
        bars = [((a, SILL, z0), (b, LINTEL, z0 + 0.055)), ((a, SILL, z1 - 0.055), (b, LINTEL, z1)),
                ((a, SILL, middle - 0.045), (b, LINTEL, middle + 0.045)), ((a, SILL, z0), (b, SILL + 0.09, z1)),
                ((a, LINTEL - 0.06, z0), (b, LINTEL, z1)), ((a + 0.01, 1.02, z0), (b - 0.01, 1.05, z1))]
        parts += [rounded_box(low, high, 0.006, 3) for low, high in bars]
        parts.append(rounded_box((-0.105, LINTEL - 0.05, z0 + 0.012), (-0.045, LINTEL - 0.002, z1 - 0.012), 0.006, 3))
        for k in range(27):
            y = LINTEL - 0.075 - 0.044 * k
            slats.append(_slat(y, z0 + 0.014, z1 - 0.014))
        y = LINTEL - 0.075 - 0.044 * 27
        parts.append(rounded_box((-0.10, y - 0.012, z0 + 0.014), (-0.05, y + 0.012, z1 - 0.014), 0.006, 3))
        for z in (z0 + 0.25, z1 - 0.25):
            cords.append(tube([(-0.075, y, z), (-0.075, LINTEL - 0.03, z)], 0.0018, 8))
    scene.add_object("window frames", merged(parts), paint)
    scene.add_object("slats", merged(slats), slat)
    scene.add_object("cords", merged(cords), gltf.add_material("cord", base_color=(0.7, 0.66, 0.58), roughness=0.9))


def _slat(y, z0, z1, half=0.024, tilt=math.radians(-20.0)):
    """A thin curved strip along Z, whose inner edge is `tilt` higher."""
    def place(s, t):
        a = 2.0 * (s - 0.5)
        along, bow = a * half, 0.004 * (1.0 - a * a)
        return (-0.075 + along * math.cos(tilt) - bow * math.sin(tilt), y + along * math.sin(tilt) + bow * math.cos(tilt),
                z1 + (z0 - z1) * t)

    return surface(place, 6, 1)


def _curtains(scene):
    gltf = scene.gltf
    linen = gltf.add_material("curtain", base_color=(0.70, 0.67, 0.60), roughness=1.0, double_sided=True, further_extensions={
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.45,
                                               "diffuseTransmissionColorFactor": [0.80, 0.74, 0.62]}})
    brass = gltf.add_material("brass", base_color=(0.80, 0.60, 0.30), metallic=1.0, roughness=0.22)
    for k, (z0, z1, pleats, phase) in enumerate((
            (0.20, 0.72, 6, 0.3), (2.22, 2.60, 5, 1.9), (2.68, 3.06, 5, 4.0), (4.42, 4.95, 6, 2.2))):
        def place(s, t, z0=z0, z1=z1, pleats=pleats, phase=phase):
            # Pleats are even at the rail and wander further down.
            down = 1.0 - t
            sway = down * (0.25 * math.sin(2.3 * t + phase) + 0.16 * math.sin(9.0 * s + 3.0 * down + phase))
            angle = 2.0 * math.pi * pleats * s + sway * 2.2
            deep = 0.030 + 0.016 * (1.0 - t) * (0.5 + 0.5 * math.sin(5.0 * s + phase))
            x = 0.085 + deep * math.sin(angle) + 0.010 * math.sin(2.0 * angle + phase)
            return (x, 0.012 + 2.575 * t, z1 + (z0 - z1) * s + 0.012 * math.cos(angle) * (1.0 - 0.5 * t))

        scene.add_object(f"curtain {k + 1}", surface(place, 40 * pleats, 24), linen)
    scene.add_object("rail", tube([(0.085, 2.60, 0.08), (0.085, 2.60, 5.2)], 0.012, 20), brass)


def cushion(half, powers=(0.36, 0.62, 0.36), wrinkle=0.0, phase=0.0, uv_per_meter=1.0):
    """A soft box about the origin, with texture coordinates along X and Z."""
    def place(s, t):
        angle, polar = 2.0 * math.pi * s, math.pi * t
        # Exactly on the axis at the poles.
        ring = math.sin(polar) if t < 1.0 else 0.0
        unit = (ring * math.sin(angle), -math.cos(polar), ring * math.cos(angle))
        x, y, z = (h * math.copysign(abs(n) ** p, n) for h, n, p in zip(half, unit, powers))
        # Creases towards the edges, and a seam that is drawn in a little.
        edge = max(abs(x) / half[0], abs(z) / half[2]) ** 4
        y += wrinkle * edge * math.sin(13.0 * x / half[0] + 8.5 * z / half[2] + phase) * (1.0 - abs(unit[1]) ** 8)
        return (x, y, z)

    mesh = surface(place, 96, 64, wrap_columns=True, uv_scale=(1.0, 1.0))
    for i in range(mesh.vertex_count):
        x, y, z = mesh.positions[3 * i:3 * i + 3]
        mesh.uvs[2 * i], mesh.uvs[2 * i + 1] = uv_per_meter * (x + 0.6 * y), uv_per_meter * (z + 0.6 * y)
    return mesh


def _seats(scene):
    """A sofa before the back wall and an armchair by the window."""
    gltf = scene.gltf
    weave = gltf.add_texture("weave", textures.weave(256, 24))
    sheen = {"KHR_materials_sheen": {"sheenColorFactor": [0.10, 0.10, 0.10], "sheenRoughnessFactor": 0.5}}
    linen = scene.textured("linen", None, weave, base_color=(0.50, 0.46, 0.40), roughness=0.95, normal_scale=0.7,
                           further_extensions=sheen)
    rust = scene.textured("rust", None, weave, base_color=(0.42, 0.13, 0.045), roughness=0.95, normal_scale=0.8,
                          further_extensions=sheen)
    blue = scene.textured("blue", None, weave, base_color=(0.07, 0.13, 0.17), roughness=0.95, normal_scale=0.8,
                          further_extensions=sheen)
    legs = gltf.add_material("legs", base_color=(0.16, 0.075, 0.035), roughness=0.4)

    def seat(name, width, cloth, place):
        half, depth = 0.5 * width, 0.44
        count = max(round((width - 0.36) / 0.8), 1)
        pitch = (width - 0.36) / count
        body = [rounded_box((-half + 0.02, 0.16, -depth), (half - 0.02, 0.30, depth - 0.02), 0.02, 4, 9.0),
                rounded_box((-half + 0.02, 0.20, -depth), (half - 0.02, 0.74, -depth + 0.16), 0.05, 6, 9.0),
                rounded_box((-half, 0.155, -depth), (-half + 0.17, 0.60, depth), 0.055, 6, 9.0),
                rounded_box((half - 0.17, 0.155, -depth), (half, 0.60, depth), 0.055, 6, 9.0)]
        scene.add_object(f"{name} body", merged(body), cloth, **place)
        seats = []
        for k in range(count):
            x = -half + 0.18 + pitch * (k + 0.5)
            seats.append(((x, 0.375, 0.055), None, (0.5 * pitch - 0.004, 0.085, depth - 0.075), 1.3 * k))
            seats.append(((x, 0.66, -0.20), -76.0, (0.5 * pitch - 0.012, 0.095, 0.235), 0.7 + 2.1 * k))
        for k, (at, lean, size, phase) in enumerate(seats):
            mesh = cushion(size, (0.30, 0.66, 0.30) if lean is None else (0.40, 0.62, 0.40), 0.004, phase, 9.0)
            _inside(scene, f"{name} cushion {k + 1}", mesh, cloth, place, at, (1.0, 0.0, 0.0), -(lean or 0.0))
        feet = [tube([(x, 0.008, z), (x * 0.985, 0.17, z * 0.97)], [0.014, 0.022], 20)
                for x in (-half + 0.09, half - 0.09) for z in (-depth + 0.08, depth - 0.08)]
        scene.add_object(f"{name} feet", merged(feet), legs, **place)

    sofa = {"translation": (3.02, 0.0, 0.56)}
    seat("sofa", 2.15, linen, sofa)
    for k, (size, phase, cloth, at, axis, degrees) in enumerate((
            (0.225, 0.4, rust, (-0.66, 0.60, 0.045), (1.0, 0.20, 0.16), 68.0),
            (0.215, 2.4, blue, (0.64, 0.59, 0.030), (1.0, -0.30, -0.10), 66.0))):
        mesh = cushion((size, 0.38 * size, size), (0.52, 0.75, 0.52), 0.008, phase, 9.0)
        _inside(scene, f"pillow {k + 1}", mesh, cloth, sofa, at, normalize(axis), degrees)
    chair = {"translation": (0.98, 0.0, 2.62), "rotation": turned((0.0, 1.0, 0.0), 62.0)}
    seat("chair", 0.86, blue, chair)


def _inside(scene, name, mesh, material, place, at, axis, degrees):
    """A part that stands at `at`, turned about `axis`, in a group that is placed by `place`."""
    gltf = scene.gltf
    scene.triangles += mesh.triangle_count
    node = gltf.add("nodes", {"name": name, "mesh": gltf.add_mesh(name, mesh, material), "translation": list(at),
                              "rotation": turned(axis, degrees)})
    group = gltf.add_node(f"place of {name}", **place)
    gltf.document["nodes"][group]["children"] = [node]


def _table(scene):
    """A low table with books and a bowl, on a rug."""
    gltf = scene.gltf
    grain = gltf.add_texture("walnut", textures.wood(512, 256, (0.050, 0.022, 0.010), (0.20, 0.095, 0.045), 8, 14))
    walnut = scene.textured("walnut", grain, roughness=0.33)
    x, z = 2.62, 2.12
    parts = [rounded_box((x - 0.56, 0.375, z - 0.31), (x + 0.56, 0.405, z + 0.31), 0.009, 5, 0.8, (0.2, 0.3))]
    scene.add_object("table top", merged(parts), walnut)
    legs = [tube([(x + 0.52 * a, 0.016, z + 0.27 * b), (x + 0.44 * a, 0.378, z + 0.21 * b)], [0.012, 0.021], 24)
            for a in (-1, 1) for b in (-1, 1)]
    scene.add_object("table legs", merged(legs), gltf.add_material("leg", base_color=(0.10, 0.045, 0.02), roughness=0.35))
    y = 0.4055
    for k, (size, color, turn, height) in enumerate((
            ((0.15, 0.105), (0.05, 0.10, 0.12), 8.0, 0.032), ((0.135, 0.10), (0.55, 0.50, 0.42), -5.0, 0.024),
            ((0.115, 0.08), (0.45, 0.11, 0.05), 17.0, 0.020))):
        a, b = size
        cover = gltf.add_material(f"cover {k + 1}", base_color=color, roughness=0.55)
        place = {"translation": (x - 0.24, y, z + 0.03), "rotation": turned((0.0, 1.0, 0.0), turn)}
        scene.add_object(f"book {k + 1}", merged([
            rounded_box((-a, 0.0, -b), (a, 0.0025, b), 0.001, 2),
            rounded_box((-a, height - 0.0025, -b), (a, height, b), 0.001, 2),
            rounded_box((-a, 0.0, -b), (-a + 0.004, height, b), 0.0015, 2)]), cover, **place)
        pages = gltf.add_material(f"pages {k + 1}", base_color=(0.72, 0.68, 0.58), roughness=0.9)
        block = box((-a + 0.003, 0.002, -b + 0.004), (a - 0.004, height - 0.002, b - 0.004))
        scene.add_object(f"leaves {k + 1}", block, pages, **place)
        y += height + 0.001
    bowl = [(0.0, 0.0), (0.045, 0.0), (0.052, 0.004), (0.060, 0.014), (0.100, 0.040), (0.132, 0.078), (0.136, 0.084),
            (0.131, 0.083), (0.098, 0.046), (0.055, 0.020), (0.0, 0.014)]
    scene.add_object("bowl", revolved(*smooth_outline(bowl, 6), 96), gltf.add_material(
        "glaze", base_color=(0.66, 0.64, 0.58), roughness=0.18), translation=(x + 0.24, 0.4055, z - 0.02))
    orange = gltf.add_material("orange", base_color=(0.80, 0.27, 0.02), roughness=0.38)
    for k, (dx, dy, dz, r) in enumerate((
            (-0.044, 0.066, 0.020, 0.040), (0.043, 0.065, 0.026, 0.039), (0.002, 0.068, -0.050, 0.041),
            (0.004, 0.124, 0.004, 0.038))):
        scene.add_object(f"orange {k + 1}", sphere(r, 20), orange, translation=(x + 0.24 + dx, 0.4055 + dy, z - 0.02 + dz))
    # The rug's pile is a relief; its edges are round.
    pile = gltf.add_texture("pile", textures.relief(256, lambda u, v: textures.fractal(u, v, 48, 48, 2, 9), 1.6))
    pattern = gltf.add_texture("pattern", linear_png(256, 256, _rug))
    rug = scene.textured("rug", pattern, pile, roughness=1.0, further_extensions={"KHR_materials_sheen": {
        "sheenColorFactor": [0.12, 0.11, 0.10], "sheenRoughnessFactor": 0.6}})
    scene.add_object("rug", rounded_box((1.45, 0.0005, 1.12), (4.05, 0.013, 3.05), 0.006, 3, 2.0), rug)


def _rug(u, v):
    """Pale wool with a lattice of thin dark lines that waver."""
    waver = 0.012 * (textures.fractal(u, v, 8, 8, 2, 3) - 0.5)
    near = min(abs((u + v + waver) % 0.5 - 0.25), abs((u - v + waver) % 0.5 - 0.25))
    tone = 0.85 + 0.3 * (textures.fractal(u, v, 24, 24, 2, 8) - 0.5)
    color = (0.16, 0.14, 0.13) if near < 0.017 else (0.62, 0.57, 0.48)
    return [c * tone for c in color]


def _plant(scene):
    gltf = scene.gltf
    pot = ((0.0, 0.0), (0.12, 0.0), (0.135, 0.008), (0.150, 0.10), (0.168, 0.26), (0.172, 0.285), (0.166, 0.290),
           (0.158, 0.280), (0.150, 0.24), (0.0, 0.235))
    x, z = 0.62, 0.55
    clay = gltf.add_material("clay", base_color=(0.50, 0.24, 0.14), roughness=0.75)
    scene.add_object("pot", revolved(*smooth_outline(pot, 6), 96), clay, translation=(x, 0.001, z))
    green = gltf.add_material("leaf", base_color=(0.035, 0.115, 0.022), roughness=0.35, double_sided=True, further_extensions={
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.35,
                                               "diffuseTransmissionColorFactor": [0.20, 0.42, 0.04]}})
    bark = gltf.add_material("bark", base_color=(0.12, 0.085, 0.05), roughness=0.9)
    numbers = random.Random(3)
    leaves, stems = [], []
    for base, lean, tall in (((0.02, 0.01), (0.06, 0.05), 1.42), ((-0.03, 0.02), (-0.10, 0.10), 1.10),
                             ((0.03, -0.03), (0.15, -0.06), 0.92)):
        def trunk(h, base=base, lean=lean, tall=tall):
            return (x + base[0] + lean[0] * h * h + 0.012 * math.sin(7.0 * h * tall), 0.22 + tall * h,
                    z + base[1] + lean[1] * h * h + 0.012 * math.cos(6.0 * h * tall))

        stems.append(tube([trunk(k / 24.0) for k in range(25)], [0.014 - 0.009 * k / 24.0 for k in range(25)], 12))
        count = round(17 * tall)
        for k in range(count):
            h = 0.30 + 0.70 * k / (count - 1)
            root = trunk(h)
            azimuth = 2.39996 * k + numbers.uniform(-0.3, 0.3) + 5.0 * tall
            rise = 0.15 + 0.75 * h ** 3 + numbers.uniform(-0.1, 0.1)
            size = numbers.uniform(0.17, 0.25) * (1.1 - 0.35 * h)
            leaves.append(_leaf(root, azimuth, rise, size, numbers.uniform(0.7, 1.3)))
            stems.append(tube([root, add(root, scale(direction(rise, math.pi - azimuth), 0.05))], 0.0032, 8))
    scene.add_object("leaves of the plant", merged(leaves), green)
    scene.add_object("stems", merged(stems), bark)


def _leaf(root, azimuth, rise, size, droop):
    """A leaf that bends down under its weight, with a fold along its middle and waves at its edge."""
    ahead, aside = (math.sin(azimuth), 0.0, math.cos(azimuth)), (math.cos(azimuth), 0.0, -math.sin(azimuth))

    def place(s, t):
        along = 0.045 + size * t
        tilt = rise - droop * t * t
        width = 0.40 * size * (math.sin(math.pi * min(t, 1.0) ** 0.8)) ** 0.8
        across = 2.0 * (s - 0.5)
        lift = 0.16 * width * across * across + 0.014 * size / 0.2 * math.sin(11.0 * t + azimuth) * across * abs(across)
        bend = 0.6 * tilt + 0.4 * rise
        point = add(scale(ahead, along * math.cos(bend)), (0.0, along * math.sin(bend) + lift, 0.0))
        return add(root, add(point, scale(aside, width * across)))

    return surface(lambda s, t: place(s, 0.004 + 0.99 * t), 8, 14)


def _things(scene):
    """A painting in its frame, and a lamp that is not lit."""
    gltf = scene.gltf
    texture = gltf.add_texture("painting", linear_png(256, 256, _painting))
    painting = gltf.add_material("painting", roughness=0.7, base_color_texture=texture)
    oak = gltf.add_material("frame oak", base_color=(0.30, 0.17, 0.08), roughness=0.45)
    x0, x1, y0, y1 = 2.45, 3.55, 1.25, 2.02
    width, height = x1 - x0, y1 - y0
    scene.add_object("canvas", rectangle((x0, y0, 0.022), (width, 0.0, 0.0), (0.0, height, 0.0), 1.0 / width), painting)
    a, b, c, d = x0 - 0.03, x1 + 0.03, y0 - 0.03, y1 + 0.03
    bars = [((a, c, 0.001), (x0, d, 0.035)), ((x1, c, 0.001), (b, d, 0.035)),
            ((x0, c, 0.001), (x1, y0, 0.035)), ((x0, y1, 0.001), (x1, d, 0.035))]
    scene.add_object("frame", merged([rounded_box(low, high, 0.004, 3) for low, high in bars]), oak)
    brass = gltf.add_material("lamp brass", base_color=(0.80, 0.60, 0.30), metallic=1.0, roughness=0.20)
    x, z = 1.62, 0.42
    foot = ((0.0, 0.0), (0.130, 0.0), (0.138, 0.005), (0.136, 0.016), (0.10, 0.024), (0.02, 0.030), (0.0, 0.031))
    scene.add_object("lamp foot", revolved(*smooth_outline(foot, 5), 96), brass, translation=(x, 0.001, z))
    path = [(x, 0.02, z), (x, 0.9, z), (x, 1.30, z), (x + 0.02, 1.42, z + 0.01), (x + 0.09, 1.50, z + 0.04),
            (x + 0.20, 1.53, z + 0.09)]
    scene.add_object("lamp arm", tube(refined(path), 0.0085, 20), brass)
    shade = gltf.add_material("shade", base_color=(0.72, 0.68, 0.58), roughness=0.9, double_sided=True, further_extensions={
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.4,
                                               "diffuseTransmissionColorFactor": [0.8, 0.7, 0.5]}})
    outline = [(0.165 - 0.075 * k / 8, 1.28 + 0.22 * k / 8) for k in range(9)]
    slope = math.hypot(0.22, 0.075)
    scene.add_object("lamp shade", revolved(outline, [(0.22 / slope, 0.075 / slope)] * 9, 96), shade,
                     translation=(x + 0.20, 0.0, z + 0.09))


def _painting(u, v):
    """Hills in the evening, in flat colours; the frame shows seven tenths of the height."""
    v = (v - 0.3) / 0.7
    grain = 0.9 + 0.25 * (textures.fractal(u, v, 32, 24, 2, 4) - 0.5)
    color = textures.mix((0.72, 0.55, 0.36), (0.36, 0.42, 0.44), 1.0 - v)
    if math.hypot(1.43 * (u - 0.66), v - 0.36) < 0.12:
        color = (0.72, 0.24, 0.08)
    for k, (level, tone) in enumerate(((0.50, (0.30, 0.33, 0.33)), (0.62, (0.18, 0.24, 0.24)), (0.76, (0.07, 0.13, 0.15)))):
        if v > level + 0.07 * math.sin((4.0 + 2.0 * k) * u + 2.0 * k + 0.7) + 0.03 * math.sin(13.0 * u + k):
            color = tone
    return [c * grain for c in color]
