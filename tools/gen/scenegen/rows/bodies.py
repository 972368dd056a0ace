"""Rows of solid spheres that light enters."""

from ..mesh import extrusion
from . import textures
from .stage import COLUMNS, LOWER, UPPER, Stage, parameter

SOLID = {"thicknessFactor": 0.9}


def volume():
    """The attenuation distance in amber; the index in green glass, with transmission from a texture on every other."""
    stage = Stage(checkered=True)
    factor = stage.texture("R", textures.channel("R"))
    for column, (distance, index) in enumerate(zip((0.1, 0.25, 0.6, 1.5, 4.0), (1.0, 1.2, 1.5, 1.8, 2.4))):
        stage.add_ball(UPPER, column, roughness=0.0, transmission=1.0, further_extensions={
            "KHR_materials_volume": {**SOLID, "attenuationColor": [0.9, 0.5, 0.1], "attenuationDistance": distance}})
        transmission = {"transmissionFactor": 1.0}
        if column % 2:
            transmission["transmissionTexture"] = {"index": factor}
        stage.add_ball(LOWER, column, roughness=parameter(column, 0.0, 0.4), further_extensions={
            "KHR_materials_transmission": transmission, "KHR_materials_ior": {"ior": index},
            "KHR_materials_volume": {**SOLID, "attenuationColor": [0.4, 0.9, 0.5], "attenuationDistance": 0.5}})
    return stage.finish()


def volume_scatter():
    """The multiscatter colour, black first; the anisotropy, with transmission from a texture on every other."""
    stage = Stage()
    factor = stage.texture("R", textures.channel("R"))
    for column in range(COLUMNS):
        t = parameter(column)
        stage.add_ball(UPPER, column, roughness=0.2, transmission=1.0, further_extensions={
            "KHR_materials_volume": {**SOLID, "attenuationColor": [0.9, 0.8, 0.7], "attenuationDistance": 0.1},
            "KHR_materials_volume_scatter": {"multiscatterColor": [t, 0.8 * t, 0.5 * t]}})
        transmission = {"transmissionFactor": 1.0}
        if column % 2:
            transmission["transmissionTexture"] = {"index": factor}
        stage.add_ball(LOWER, column, roughness=0.2, further_extensions={
            "KHR_materials_transmission": transmission,
            "KHR_materials_volume": {**SOLID, "attenuationColor": [0.6, 0.8, 0.9], "attenuationDistance": 0.3},
            "KHR_materials_volume_scatter": {"multiscatterColor": [0.5, 0.8, 0.9],
                                             "scatterAnisotropy": parameter(column, -0.8, 0.8)}})
    return stage.finish()


def dispersion():
    """Spheres and prisms before a checkered wall, whose edges get coloured fringes."""
    stage = Stage(checkered=True)
    prism = _prism(width=0.8, depth=0.35, height=0.9)
    for column, strength in enumerate((0.0, 0.5, 1.0, 2.5, 6.0)):
        glass = {"roughness": 0.0, "transmission": 1.0, "further_extensions": {
            "KHR_materials_volume": SOLID, "KHR_materials_ior": {"ior": 1.6},
            "KHR_materials_dispersion": {"dispersion": strength}}}
        stage.add_ball(UPPER, column, **glass)
        stage.add_body(f"prism-{column}", prism, stage.place(LOWER, column, 0.01), **glass)
    return stage.finish()


def models():
    """render.json's own: subsurface of growing mean free paths; clay of two roughnesses and three dielectrics."""
    stage = Stage(checkered=True)
    for column, radius in enumerate((0.01, 0.03, 0.1, 0.3, 1.0)):
        stage.add_ball(UPPER, column, override={"subsurface": {
            "albedo": [0.8, 0.5, 0.4], "radius": [radius, 0.5 * radius, 0.25 * radius]}})
    amber = {"ior": 1.55, "attenuation_color": [0.9, 0.5, 0.1], "attenuation_distance": 0.5}
    for column, model in enumerate((
            {"diffuse": {"albedo": [0.6, 0.3, 0.2], "roughness": 0.4}},
            {"diffuse": {"albedo": [0.6, 0.3, 0.2], "roughness": 1.0}},
            {"dielectric": amber},
            {"dielectric": {**amber, "roughness": 0.4}},
            {"dielectric": {**amber, "multiscatter_color": [0.9, 0.6, 0.3], "scatter_anisotropy": 0.5}})):
        stage.add_ball(LOWER, column, override=model)
    return stage.finish()


def _prism(width, depth, height):
    """An upright wedge: a triangle seen from above, flat towards the viewer and pointed to the left."""
    left, right, back = (-0.5 * width, 0.5 * depth), (0.5 * width, 0.5 * depth), (0.5 * width, -0.5 * depth)
    return extrusion((left, right, back), 0.0, height)
