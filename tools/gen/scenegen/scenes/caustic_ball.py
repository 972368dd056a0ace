"""The room of caustic-glass, in which render.json puts an exact sphere in place of a coarse one."""

from . import caustic_glass


def build():
    return caustic_glass.build(sphere_frequency=2)
