"""Rows of hollow spheres with thin walls that light passes."""

from . import textures
from .stage import COLUMNS, LOWER, UPPER, Stage, parameter


def transmission():
    """The factor, on a clear wall; the roughness, with the factor from a texture."""
    stage = Stage(checkered=True)
    factor = stage.texture("R", textures.channel("R"))
    for column in range(COLUMNS):
        stage.add_ball(UPPER, column, base_color=(0.9, 0.6, 0.3), roughness=0.1, double_sided=True,
                       transmission=parameter(column))
        stage.add_ball(LOWER, column, base_color=(0.3, 0.7, 0.9), roughness=parameter(column), double_sided=True,
                       further_extensions={"KHR_materials_transmission": {
                           "transmissionFactor": 1.0, "transmissionTexture": {"index": factor}}})
    return stage.finish()


def diffuse_transmission():
    """The factor with a colour; both from textures."""
    stage = Stage()
    factor, color = stage.texture("A", textures.channel("A")), stage.texture("color", textures.color_bands())
    for column in range(COLUMNS):
        stage.add_ball(UPPER, column, base_color=(0.2, 0.5, 0.1), roughness=0.6, double_sided=True,
                       further_extensions={"KHR_materials_diffuse_transmission": {
                           "diffuseTransmissionFactor": parameter(column),
                           "diffuseTransmissionColorFactor": [0.9, 0.8, 0.2]}})
        stage.add_ball(LOWER, column, base_color=(0.5, 0.5, 0.5), roughness=0.6, double_sided=True,
                       further_extensions={"KHR_materials_diffuse_transmission": {
                           "diffuseTransmissionFactor": parameter(column, 0.2),
                           "diffuseTransmissionTexture": {"index": factor},
                           "diffuseTransmissionColorTexture": {"index": color}}})
    return stage.finish()
