"""Rows of opaque spheres: what the extensions do to reflection."""

import math

from . import textures
from .stage import COLUMNS, LOWER, UPPER, Stage, parameter

DARK_RED, BLACK, GOLD = (0.06, 0.01, 0.005), (0.02, 0.02, 0.02), (1.00, 0.77, 0.34)


def clearcoat():
    """Over rough, dark red: the factor; the roughness, with all three textures on every other sphere."""
    stage = Stage()
    factor, roughness = (stage.texture(name, textures.channel(name)) for name in ("R", "G"))
    normal = stage.texture("normal", textures.waves())
    for column in range(COLUMNS):
        stage.add_ball(UPPER, column, base_color=DARK_RED, roughness=0.7, further_extensions={
            "KHR_materials_clearcoat": {"clearcoatFactor": parameter(column), "clearcoatRoughnessFactor": 0.15}})
        coat = {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": parameter(column),
                "clearcoatTexture": {"index": factor}, "clearcoatRoughnessTexture": {"index": roughness}}
        if column % 2:
            coat["clearcoatNormalTexture"] = {"index": normal, "scale": 0.5}
        stage.add_ball(LOWER, column, base_color=DARK_RED, roughness=0.7,
                       further_extensions={"KHR_materials_clearcoat": coat})
    return stage.finish()


def sheen():
    """Over dark cloth: the roughness with a colour; both from textures."""
    stage = Stage()
    color, roughness = stage.texture("color", textures.color_bands()), stage.texture("A", textures.channel("A"))
    for column in range(COLUMNS):
        sheen_of_column = {"sheenColorFactor": [0.9, 0.5, 0.3], "sheenRoughnessFactor": parameter(column, 0.1)}
        stage.add_ball(UPPER, column, base_color=(0.05, 0.02, 0.08),
                       further_extensions={"KHR_materials_sheen": sheen_of_column})
        stage.add_ball(LOWER, column, base_color=(0.05, 0.02, 0.08), further_extensions={"KHR_materials_sheen": {
            "sheenColorFactor": [1.0, 1.0, 1.0], "sheenColorTexture": {"index": color},
            "sheenRoughnessFactor": parameter(column, 0.2), "sheenRoughnessTexture": {"index": roughness}}})
    return stage.finish()


def specular():
    """On dark plastic, whose reflection the index makes strong: the factor; the tint, both from textures."""
    stage = Stage()
    factor, color = stage.texture("A", textures.channel("A")), stage.texture("color", textures.color_bands())
    for column in range(COLUMNS):
        t = parameter(column)
        for row, values in ((UPPER, {"specularFactor": t}),
                            (LOWER, {"specularTexture": {"index": factor}, "specularColorTexture": {"index": color},
                                     "specularColorFactor": [0.5 + t, 1.0, 1.5 - t]})):
            stage.add_ball(row, column, base_color=BLACK, roughness=0.35, further_extensions={
                "KHR_materials_ior": {"ior": 2.0}, "KHR_materials_specular": values})
    return stage.finish()


def ior():
    """On dark plastic: the index, with 0 for full reflection last; rougher, with a base colour."""
    stage = Stage()
    color = stage.texture("color", textures.color_bands())
    for column, index in enumerate((1.0, 1.33, 1.5, 2.4, 0.0)):
        extensions = {"KHR_materials_ior": {"ior": index}}
        stage.add_ball(UPPER, column, base_color=BLACK, roughness=0.2, further_extensions=extensions)
        stage.add_ball(LOWER, column, base_color_texture=color, roughness=0.5, further_extensions=extensions)
    return stage.finish()


def iridescence():
    """On dark glaze: the thickness; on metal: the film's index, with the factor and the thickness from textures."""
    stage = Stage()
    factor, thickness = (stage.texture(name, textures.channel(name)) for name in ("R", "G"))
    for column in range(COLUMNS):
        stage.add_ball(UPPER, column, base_color=BLACK, roughness=0.3, further_extensions={
            "KHR_materials_iridescence": {"iridescenceFactor": 1.0, "iridescenceIor": 1.8,
                                          "iridescenceThicknessMaximum": parameter(column, 120.0, 680.0)}})
        stage.add_ball(LOWER, column, base_color=(0.75, 0.75, 0.75), metallic=1.0, roughness=0.3, further_extensions={
            "KHR_materials_iridescence": {
                "iridescenceFactor": 1.0, "iridescenceTexture": {"index": factor},
                "iridescenceIor": parameter(column, 1.2, 2.2), "iridescenceThicknessMinimum": 150.0,
                "iridescenceThicknessMaximum": 700.0, "iridescenceThicknessTexture": {"index": thickness}}})
    return stage.finish()


def anisotropy():
    """On metal with tangents around the vertical axis: the strength; the rotation, over a texture of both."""
    stage = Stage()
    texture = stage.texture("anisotropy", textures.anisotropy())
    for column in range(COLUMNS):
        stage.add_ball(UPPER, column, base_color=GOLD, metallic=1.0, roughness=0.3, further_extensions={
            "KHR_materials_anisotropy": {"anisotropyStrength": parameter(column)}})
        stage.add_ball(LOWER, column, base_color=GOLD, metallic=1.0, roughness=0.3, further_extensions={
            "KHR_materials_anisotropy": {
                "anisotropyStrength": 0.9, "anisotropyRotation": parameter(column, 0.0, 0.5 * math.pi),
                # The first two without the texture: the rotation alone.
                **({"anisotropyTexture": {"index": texture}} if column >= 2 else {})}})
    return stage.finish()
