"""The end of a game of chess with figures of onyx and jade: light that goes in and comes out elsewhere. Metres."""

import math

from ..mesh import ground, panel, revolved, smooth_outline
from ..vector import look_at
from . import textures
from .shapes import rounded_box, surface
from .stage import Stage, turned

SQUARE, BOARD_TOP = 0.056, 0.022
# Outlines (radius, height) in centimetres, from the axis below to the axis above.
PAWN = ((0, 0), (1.42, 0), (1.56, .08), (1.58, .34), (1.44, .48), (1.42, .60), (1.22, .86), (.80, 1.22), (.58, 1.80), (.50, 2.50),
        (.54, 2.78), (.94, 2.92), (.98, 3.02), (.62, 3.16), (.70, 3.30), (.92, 3.62), (.98, 3.95), (.88, 4.32), (.55, 4.68), (0, 4.84))
BISHOP = ((0, 0), (1.60, 0), (1.74, .10), (1.76, .42), (1.60, .58), (1.58, .72), (1.30, 1.02), (.86, 1.55), (.62, 2.40), (.54, 3.60),
          (.58, 4.00), (1.08, 4.14), (1.12, 4.26), (.70, 4.40), (.66, 4.52), (.94, 4.64), (.94, 4.74), (.62, 4.88), (.78, 5.20),
          (.96, 5.70), (.88, 6.25), (.52, 6.80), (.24, 7.06), (.30, 7.22), (.24, 7.42), (0, 7.50))
QUEEN = ((0, 0), (1.78, 0), (1.94, .10), (1.96, .48), (1.78, .66), (1.76, .82), (1.42, 1.18), (.94, 1.85), (.68, 3.00), (.60, 4.50),
         (.66, 5.00), (1.20, 5.16), (1.25, 5.30), (.78, 5.46), (.74, 5.60), (1.02, 5.74), (1.02, 5.86), (.70, 6.02), (.84, 6.70),
         (1.12, 7.50), (1.28, 7.86), (1.20, 7.96), (1.02, 7.84), (.72, 8.04), (.30, 8.22), (.24, 8.32), (.34, 8.48), (.26, 8.68), (0, 8.76))
KING = ((0, 0), (1.84, 0), (2.00, .10), (2.02, .50), (1.84, .68), (1.82, .86), (1.46, 1.24), (.98, 1.95), (.72, 3.20), (.64, 4.90),
        (.70, 5.40), (1.26, 5.58), (1.31, 5.72), (.82, 5.88), (.78, 6.04), (1.08, 6.18), (1.08, 6.30), (.74, 6.48), (.90, 7.20),
        (1.18, 8.20), (1.14, 8.32), (.80, 8.52), (.36, 8.70), (.26, 8.78), (.30, 8.90), (0, 8.98))
ROOK = ((0, 0), (1.64, 0), (1.78, .10), (1.80, .44), (1.64, .60), (1.62, .76), (1.32, 1.08), (1.00, 1.60), (.86, 2.50), (.80, 3.40),
        (.86, 3.70), (1.20, 3.86), (1.24, 3.98), (1.12, 4.12), (1.16, 4.40), (1.20, 5.00), (1.14, 5.06), (.92, 5.04), (.86, 4.90),
        (.84, 4.60), (.70, 4.52), (0, 4.50))


def build():
    scene = Stage()
    gltf = scene.gltf
    _board(scene)
    stone = {"onyx": gltf.add_material("onyx", base_color=(0.9, 0.85, 0.75)),
             "jade": gltf.add_material("jade", base_color=(0.2, 0.5, 0.3))}
    for name, albedo, radius, ior in (("onyx", [0.93, 0.84, 0.70], [0.0085, 0.0052, 0.0030], 1.5),
                                      ("jade", [0.33, 0.49, 0.37], [0.0032, 0.0050, 0.0036], 1.61)):
        scene.render_json[f"/materials/{name}/subsurface"] = {
            "albedo": albedo, "radius": radius, "ior": ior, "roughness": 0.12}
    figures = {name: revolved(*smooth_outline([(0.01 * r, 0.01 * h) for r, h in outline], 5), 96)
               for name, outline in (("pawn", PAWN), ("bishop", BISHOP), ("queen", QUEEN), ("king", KING))}
    figures["rook"] = _rook()
    cross = [rounded_box((-0.0016, 0.0885, -0.0015), (0.0016, 0.1045, 0.0015), 0.0008, 3),
             rounded_box((-0.0050, 0.0960, -0.0014), (0.0050, 0.0991, 0.0014), 0.0008, 3)]
    for k, (name, color, file, rank, dx, dz) in enumerate((
            ("king", "onyx", 2, 5, .003, .001), ("queen", "onyx", 3, 3, -.002, .002), ("rook", "onyx", 0, 1, 0, .002),
            ("pawn", "onyx", 1, 5, .001, -.003), ("pawn", "onyx", 3, 6, -.003, 0), ("bishop", "onyx", 1, 2, 0, 0),
            ("king", "jade", 5, 2, .002, -.002), ("queen", "jade", 6, 4, -.002, .003), ("rook", "jade", 4, 1, .002, 0),
            ("pawn", "jade", 5, 5, 0, .002), ("pawn", "jade", 6, 2, .003, .001), ("bishop", "jade", 4, 4, .003, -.003),
            ("pawn", "jade", 2, 1, .001, .003), ("pawn", "onyx", 7, 5, 0, 0))):
        x, z = (file - 3.5) * SQUARE + dx, (rank - 3.5) * SQUARE + dz
        place = {"translation": (x, BOARD_TOP + 0.0002, z), "rotation": turned((0.0, 1.0, 0.0), 40.0 * k)}
        scene.add_object(f"{color} {name} {k + 1}", figures[name], stone[color], **place)
        if name == "king":
            for part, mesh in enumerate(cross):
                scene.add_object(f"cross {color} {part + 1}", mesh, stone[color],
                                 **{**place, "rotation": turned((0.0, 1.0, 0.0), 10.0)})
    _lamps(scene)
    scene.camera((0.055, 0.185, 0.50), (0.006, 0.058, 0.0), 24.0)
    scene.render_json.update({"/integrator/type": "path", "/integrator/max_depth": 96, "/lens_radius": 0.0042,
                              "/focus_distance": 0.475, "/color/exposure": 0.5, "/environment/color": [0.10, 0.105, 0.115]})
    return scene


def _rook():
    """The outline around the axis, with six notches in its rim."""
    points, _ = smooth_outline([(0.01 * r, 0.01 * h) for r, h in ROOK], 6)
    last = len(points) - 1

    def place(s, t):
        k = min(int(t * last), last - 1)
        u = t * last - k
        radius, height = (a + (b - a) * u for a, b in zip(points[k], points[k + 1]))
        notch = max(0.0, min(1.0, 9.0 * (math.cos(12.0 * math.pi * s) - 0.72)))
        notch *= max(0.0, min(1.0, (radius - 0.0078) / 0.0008))
        if height > 0.0466:
            height -= (height - 0.0466) * notch
        angle = 2.0 * math.pi * s
        return (radius * math.sin(angle), height, radius * math.cos(angle))

    return surface(place, 288, last, wrap_columns=True)


def _board(scene):
    gltf = scene.gltf
    walnut = gltf.add_texture("walnut", textures.wood(512, 512, (0.030, 0.014, 0.007), (0.115, 0.055, 0.027), 9, 5))
    maple = gltf.add_texture("maple", textures.wood(512, 512, (0.36, 0.24, 0.13), (0.62, 0.47, 0.30), 8, 9))
    smears = gltf.add_texture("smears", textures.roughness(256, 0.12, 0.30))
    materials = [scene.textured(name, texture, roughness_texture=smears) for name, texture in (("walnut", walnut),
                                                                                              ("maple", maple))]
    for file in range(8):
        for rank in range(8):
            x, z = (file - 4) * SQUARE, (rank - 4) * SQUARE
            offset = (0.37 * file + 0.11 * rank, 0.23 * rank + 0.41 * file)
            scene.add_object(f"square {file}{rank}", rounded_box(
                (x + 0.0001, 0.008, z + 0.0001), (x + SQUARE - 0.0001, BOARD_TOP, z + SQUARE - 0.0001), 0.0006, 2, 6.0, offset),
                materials[(file + rank + 1) % 2])
    low, high = 4 * SQUARE + 0.0004, 4 * SQUARE + 0.026
    for k, (a, b) in enumerate((((-high, -high), (high, -low)), ((-high, low), (high, high)), ((-high, -low), (-low, low)),
                                ((low, -low), (high, low)))):
        scene.add_object(f"frame {k + 1}", rounded_box((a[0], 0.0, a[1]), (b[0], BOARD_TOP + 0.003, b[1]), 0.003, 4, 3.0,
                                                       (0.3 * k, 0.7)), materials[0])
    scene.add_object("table", ground(1.6, 0.0, 1.5), scene.textured("table", walnut, base_color=(0.5, 0.45, 0.42), roughness=0.45))


def _lamps(scene):
    for name, center, size, radiance in (
            ("window", (-0.75, 0.62, -0.72), (0.65, 0.75), (15.0, 14.2, 13.0)),
            ("lantern", (0.80, 0.34, -0.42), (0.16, 0.22), (42.0, 25.0, 11.0)),
            ("fill", (0.5, 0.9, 1.3), (0.8, 0.5), (0.9, 1.0, 1.15))):
        scene.add_lamp(name, panel(*size), radiance, translation=center, rotation=look_at(center, (0.0, 0.04, 0.0)))
    backdrop = scene.add_diffuse("backdrop", (0.30, 0.22, 0.17))
    scene.add_object("backdrop", panel(6.0, 3.0), backdrop, translation=(0.0, 0.5, -1.7), rotation=turned((0.0, 1.0, 0.0), 180.0))
