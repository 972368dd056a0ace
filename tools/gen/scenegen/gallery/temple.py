"""A hall of columns in haze: low sun through high windows throws shafts across the nave. Metres."""

import math
import random

from ..mesh import box, merged, revolved, smooth_outline
from ..sky import Sky
from ..vector import look_at
from . import textures
from .shapes import rounded_box, surface
from .stage import Stage, turned

BAY, BAYS = 3.2, 8
AISLE, NAVE, HEIGHT, THICK = 5.6, 3.0, 7.6, 0.6
FRONT, BACK = 4.4, -BAY * BAYS + 0.6
# Windows of the long walls, one in each bay, and the door at the end.
WINDOW, SILL, LINTEL = 1.15, 2.4, 6.4
DOOR, DOOR_HEIGHT = 1.9, 5.2
SHAFT, BOTTOM, FLUTES = 5.3, 0.34, 20
SUN = math.radians(40.0), math.radians(66.0)
UNIT, TURBIDITY = 1.25, 3.4
# White light keeps 1/e over the mean free path.
MEAN_FREE_PATH, HAZE_COLOR, FORWARD = 20.0, (0.96, 0.96, 0.95), 0.6


def build():
    scene = Stage()
    stones = _stones(scene)
    _floor(scene)
    _walls(scene, stones)
    _columns(scene, stones)
    _vessel(scene, stones)
    _haze(scene)
    _daylight(scene)
    scene.camera((-1.05, 1.55, 3.7), (0.75, 2.95, -12.0), 46.0)
    scene.render_json.update({"/integrator/type": "path", "/integrator/max_depth": 16, "/color/exposure": 0.15})
    return scene


def _window_middles():
    return [-BAY * k - 0.5 * BAY + 1.0 for k in range(BAYS)]


def _column_places():
    return [-BAY * k + 1.0 for k in range(BAYS)]


def _daylight(scene):
    """The sun, and of the sky what windows and door show: a bright surface behind each."""
    sky = Sky(*SUN, TURBIDITY, UNIT, (0.20, 0.22, 0.14))
    color, intensity = sky.sun_color_and_intensity()
    scene.gltf.add_directional_light("sun", color, intensity, look_at(sky.sun_direction, (0.0, 0.0, 0.0)))
    scene.render_json["/lights/sun/angle"] = 0.0093
    far, middle = AISLE + THICK + 0.02, 0.5 * (SILL + LINTEL)
    for side, radiance in ((1.0, 4.0), (-1.0, 1.6)):
        for k, z in enumerate(_window_middles()):
            scene.render_json[f"/lights/{'right' if side > 0.0 else 'left'} {k + 1}"] = {
                "type": "rectangle", "position": [side * far, middle, z], "look_at": [0.0, middle, z],
                "width": WINDOW, "height": LINTEL - SILL, "radiance": radiance, "color": [0.82, 0.92, 1.0],
                "stops_light": False}
    scene.render_json["/lights/door"] = {
        "type": "rectangle", "position": [0.0, 0.5 * DOOR_HEIGHT, BACK - THICK - 0.02],
        "look_at": [0.0, 0.5 * DOOR_HEIGHT, 0.0], "width": DOOR, "height": DOOR_HEIGHT, "radiance": 4.5,
        "color": [0.90, 0.96, 1.0]}


def _haze(scene):
    """Air with dust from wall to wall; its faces lie within walls, floor and ceiling."""
    haze = scene.gltf.add_material("haze", roughness=0.0, transmission=1.0, further_extensions={
        "KHR_materials_ior": {"ior": 1.0},
        "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": MEAN_FREE_PATH,
                                 "attenuationColor": 3 * [math.exp(-1.0)]},
        "KHR_materials_volume_scatter": {"multiscatterColor": list(HAZE_COLOR), "scatterAnisotropy": FORWARD}})
    x, z = AISLE + 0.5 * THICK, 0.5 * THICK
    scene.add_object("haze", box((-x, -0.2, BACK - z), (x, HEIGHT + 0.2, FRONT + z)), haze, closed=True)


def _stones(scene):
    """Sandstone in three tones."""
    gltf = scene.gltf
    grain = gltf.add_texture("sandstone", textures.mottled(512, (0.50, 0.42, 0.31), (0.70, 0.61, 0.47), 7, 6, 5))
    relief = gltf.add_texture("pores", textures.relief(512, lambda u, v: textures.fractal(u, v, 12, 12, 5, 17), 2.2))
    return [scene.textured(f"sandstone {k + 1}", grain, relief, base_color=color, roughness=0.85, normal_scale=0.6)
            for k, color in enumerate(((1.0, 1.0, 1.0), (0.88, 0.87, 0.86), (0.78, 0.74, 0.70)))]


def _floor(scene):
    """Marble slabs in two colours, worn smooth, with the bed below."""
    gltf = scene.gltf
    numbers = random.Random(8)
    wear = gltf.add_texture("wear", textures.roughness(512, 0.14, 0.48, 6))
    veins = gltf.add_texture("veins", textures.mottled(512, (0.52, 0.48, 0.42), (0.80, 0.77, 0.71), 5, 6, 12))
    dark_veins = gltf.add_texture("dark veins", textures.mottled(512, (0.075, 0.06, 0.05), (0.20, 0.165, 0.13), 5, 6, 31))
    marbles = [scene.textured(f"marble {k + 1}", texture, roughness_texture=wear, base_color=(tone, tone, tone))
               for k, (texture, tone) in enumerate(((veins, 1.0), (veins, 0.86), (dark_veins, 1.0), (dark_veins, 0.8)))]
    side = 0.8
    slabs = [[] for _ in marbles]
    for row in range(math.floor(BACK / side) - 1, math.ceil(FRONT / side)):
        for column in range(-7, 7):
            low, sunk = (column * side, row * side), numbers.uniform(0.0, 0.003)
            mesh = rounded_box((low[0] + 0.002, -0.08 - sunk, low[1] + 0.002),
                               (low[0] + side - 0.002, -sunk, low[1] + side - 0.002), 0.005, 2, 0.4,
                               (numbers.random(), numbers.random()))
            is_border = column in (-4, 3)
            slabs[2 * ((row + column) % 2 == 0 or is_border) + numbers.randrange(2)].append(mesh)
    for k, meshes in enumerate(slabs):
        scene.add_object(f"slabs {k + 1}", merged(meshes), marbles[k])
    bed = gltf.add_material("bed", base_color=(0.14, 0.12, 0.10), roughness=1.0)
    scene.add_object("bed", box((-AISLE - THICK, -0.4, BACK - THICK), (AISLE + THICK, -0.03, FRONT + THICK)), bed)


def _masonry(low, high, numbers, stones, course=0.62):
    """Fills a box with blocks in bond, a list for each stone; the longer of its sides is where blocks follow each other."""
    blocks = [[] for _ in stones]
    along = 0 if high[0] - low[0] > high[2] - low[2] else 2
    rows = max(round((high[1] - low[1]) / course), 1)
    tall = (high[1] - low[1]) / rows
    for row in range(rows):
        at, y = low[along], low[1] + row * tall
        ends = [at]
        while at < high[along] - 1e-6:
            at += numbers.uniform(0.75, 1.25) if ends[1:] or row % 2 else numbers.uniform(0.40, 0.62)
            ends.append(high[along] if high[along] - at < 0.45 else at)
            at = ends[-1]
        for a, b in zip(ends, ends[1:]):
            inset = numbers.uniform(0.0, 0.006)
            start, end = [low[0] + inset, y, low[2] + inset], [high[0] - inset, y + tall, high[2] - inset]
            start[along], end[along] = a, b
            gap = 0.0015
            blocks[numbers.randrange(len(stones))].append(rounded_box(
                [c + gap for c in start], [c - gap for c in end], 0.012, 2, 0.45, (numbers.random(), numbers.random())))
    return blocks


def _walls(scene, stones):
    numbers = random.Random(77)
    pieces = [[] for _ in stones]
    solids = []

    def fill(low, high):
        for k, blocks in enumerate(_masonry(low, high, numbers, stones)):
            pieces[k].extend(blocks)
        # What the joints show: nothing shines through.
        solids.append(box([a + 0.02 for a in low], [b - 0.02 for b in high], 0.45))

    ends = [FRONT + THICK, *(z + h for z in _window_middles() for h in (0.5 * WINDOW, -0.5 * WINDOW)), BACK - THICK]
    for x in (-AISLE - THICK, AISLE):
        fill((x, -0.05, BACK - THICK), (x + THICK, SILL, FRONT + THICK))
        fill((x, LINTEL, BACK - THICK), (x + THICK, HEIGHT + 0.3, FRONT + THICK))
        for a, b in zip(ends[::2], ends[1::2]):
            fill((x, SILL, b), (x + THICK, LINTEL, a))
    for z, half, top in ((BACK - THICK, 0.5 * DOOR, DOOR_HEIGHT), (FRONT, 0.0, 0.0)):
        if half > 0.0:
            fill((-AISLE, -0.05, z), (-half, HEIGHT + 0.3, z + THICK))
            fill((half, -0.05, z), (AISLE, HEIGHT + 0.3, z + THICK))
            fill((-half, top, z), (half, HEIGHT + 0.3, z + THICK))
        else:
            fill((-AISLE, -0.05, z), (AISLE, HEIGHT + 0.3, z + THICK))
    for k, meshes in enumerate(pieces):
        scene.add_object(f"blocks {k + 1}", merged(meshes), stones[k])
    scene.add_object("cores", merged(solids), stones[2])
    # Sills that stand out a little, and a moulding along the walls.
    trims = [rounded_box((side * (AISLE - 0.07) - 0.1, SILL - 0.16, z - 0.5 * WINDOW - 0.12),
                         (side * (AISLE - 0.07) + 0.1, SILL + 0.004, z + 0.5 * WINDOW + 0.12), 0.02, 3, 0.5)
             for side in (1.0, -1.0) for z in _window_middles()]
    trims += [rounded_box((side * AISLE - 0.12, 0.0, BACK), (side * AISLE + 0.12, 0.42, FRONT), 0.03, 3, 0.5)
              for side in (1.0, -1.0)]
    scene.add_object("trims", merged(trims), stones[1])


def _columns(scene, stones):
    """Fluted columns with bases and capitals, architraves, beams across, and the ceiling."""
    def shaft(s, t):
        radius = BOTTOM * (1.0 - 0.18 * t ** 1.7)
        flute = (FLUTES * s) % 1.0
        radius -= 0.034 * (1.0 - (2.0 * flute - 1.0) ** 2)
        angle = 2.0 * math.pi * s
        return (radius * math.sin(angle), 0.36 + (SHAFT - 0.36) * t, radius * math.cos(angle))

    base = ((0.0, 0.10), (0.44, 0.10), (0.47, 0.13), (0.475, 0.17), (0.45, 0.20), (0.40, 0.215), (0.385, 0.245),
            (0.40, 0.275), (0.42, 0.30), (0.42, 0.33), (0.39, 0.355), (0.30, 0.365), (0.0, 0.37))
    top = SHAFT
    capital = ((0.0, top - 0.01), (0.285, top - 0.01), (0.300, top), (0.300, top + 0.03), (0.290, top + 0.045),
               (0.320, top + 0.09), (0.395, top + 0.17), (0.445, top + 0.23), (0.45, top + 0.26), (0.0, top + 0.262))
    places = [{"translation": (side * NAVE, 0.0, z), "rotation": turned((0.0, 1.0, 0.0), 37.0 * k)}
              for side in (1.0, -1.0) for k, z in enumerate(_column_places())]
    square = [{"translation": place["translation"]} for place in places]
    scene.copies("shaft", surface(shaft, 8 * FLUTES, 20, wrap_columns=True, uv_scale=(2.0, 4.0)), stones[0], places)
    scene.copies("base", revolved(*smooth_outline(base, 5), 96), scene.gltf.add_material(
        "base stone", base_color=(0.58, 0.50, 0.38), roughness=0.8), square)
    scene.copies("capital", revolved(*smooth_outline(capital, 5), 96), scene.gltf.add_material(
        "capital stone", base_color=(0.62, 0.54, 0.42), roughness=0.8), square)
    scene.copies("plinth", merged([rounded_box((-0.5, 0.0, -0.5), (0.5, 0.105, 0.5), 0.014, 3, 0.6),
                                   rounded_box((-0.48, top + 0.258, -0.48), (0.48, top + 0.40, 0.48), 0.014, 3, 0.6)]),
                 stones[1], square)
    low, numbers = top + 0.398, random.Random(4)
    beams = [[] for _ in stones]
    for side in (1.0, -1.0):
        ends = [FRONT, *_column_places(), BACK]
        for a, b in zip(ends, ends[1:]):
            for half, bottom, height, gap in ((0.36, low, 0.62, 0.002), (0.46, low + 0.622, 0.118, 0.0)):
                beams[numbers.randrange(3)].append(rounded_box(
                    (side * NAVE - half, bottom, b + gap), (side * NAVE + half, bottom + height, a - gap), 0.015, 3, 0.45,
                    (numbers.random(), numbers.random())))
    for k, meshes in enumerate(beams):
        scene.add_object(f"architraves {k + 1}", merged(meshes), stones[k])
    gltf = scene.gltf
    grain = gltf.add_texture("cedar", textures.wood(512, 256, (0.060, 0.030, 0.014), (0.19, 0.105, 0.055), 11, 9))
    cedar = scene.textured("cedar", grain, roughness=0.6)
    timbers = []
    for k in range(2 * BAYS + 2):
        z = FRONT - 0.8 - 0.5 * BAY * k
        timbers.append(rounded_box((-AISLE - 0.2, low + 0.741, z - 0.16), (AISLE + 0.2, low + 1.10, z + 0.16), 0.02, 3, 0.7))
    timbers.append(box((-AISLE - 0.2, HEIGHT - 0.06, BACK - 0.2), (AISLE + 0.2, HEIGHT + 0.25, FRONT + 0.2), 0.7))
    scene.add_object("timbers", merged(timbers), cedar)


def _vessel(scene, stones):
    """A bronze vessel on a stepped plinth before the door."""
    z = BACK + 3.2
    steps = [rounded_box((-a, y0, z - a), (a, y1, z + a), 0.02, 3, 0.5)
             for a, y0, y1 in ((1.25, 0.0, 0.22), (0.95, 0.221, 0.44), (0.62, 0.441, 1.15), (0.70, 1.151, 1.26))]
    scene.add_object("steps", merged(steps), stones[0])
    outline = ((0.0, 0.0), (0.30, 0.0), (0.31, 0.03), (0.20, 0.08), (0.10, 0.20), (0.11, 0.26), (0.30, 0.38), (0.56, 0.66),
               (0.66, 0.98), (0.60, 1.24), (0.40, 1.40), (0.36, 1.50), (0.46, 1.58), (0.45, 1.60), (0.34, 1.55), (0.30, 1.42),
               (0.50, 1.22), (0.58, 0.98), (0.48, 0.66), (0.0, 0.42))
    bronze = scene.gltf.add_material("bronze", base_color=(0.66, 0.44, 0.24), metallic=1.0, roughness=0.32)
    mesh = revolved(*smooth_outline(outline, 6), 128)
    scene.add_object("vessel", mesh, bronze, translation=(0.0, 1.26, z))
