"""Spheres that shine, and some that only look so."""

from . import textures
from .stage import COLUMNS, LOWER, UPPER, Stage


def emission():
    """The strength of a colour; of a texture; and two unlit spheres, of a colour and of a texture."""
    stage = Stage()
    color = stage.texture("color", textures.color_bands())
    for column, strength in enumerate((0.25, 0.5, 1.0, 2.0, 4.0)):
        stage.add_ball(UPPER, column, base_color=(0.1, 0.1, 0.1), **_glow((0.9, 0.4, 0.2), strength))
    for column, strength in enumerate((0.5, 1.0, 3.0)):
        stage.add_ball(LOWER, column, base_color=(0.1, 0.1, 0.1), emissive_texture=color,
                       **_glow((1.0, 1.0, 1.0), strength))
    unlit = {"further_extensions": {"KHR_materials_unlit": {}}}
    stage.add_ball(LOWER, COLUMNS - 2, base_color=(0.2, 0.6, 0.9), **unlit)
    stage.add_ball(LOWER, COLUMNS - 1, base_color_texture=color, **unlit)
    return stage.finish()


def _glow(color, strength):
    return {"emission": [strength * c for c in color]}
