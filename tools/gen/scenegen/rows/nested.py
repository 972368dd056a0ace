"""Bodies inside and through each other."""

from ..mesh import lathe, mapped_sphere
from .stage import COLUMNS, LOWER, RADIUS, UPPER, Stage

SEGMENTS = 96
GLASS = {"dielectric": {"ior": 1.5, "attenuation_color": [0.7, 0.95, 0.85], "attenuation_distance": 0.3}}
WATER = {"dielectric": {"ior": 1.33, "attenuation_color": [0.6, 0.8, 0.95], "attenuation_distance": 0.6}}
WINE = {"dielectric": {"ior": 1.34, "attenuation_color": [0.6, 0.05, 0.1], "attenuation_distance": 0.3}}
ICE = {"dielectric": {"ior": 1.31, "attenuation_color": [0.9, 0.95, 1.0], "attenuation_distance": 0.5,
                      "multiscatter_color": [0.5, 0.6, 0.7]}}


def nested():
    """Spheres in spheres, and through each other; cups of water that overlap the glass, with and without ice."""
    stage = Stage(checkered=True)
    _add_spheres(stage)
    _add_cups(stage)
    return stage.finish()


def _add_spheres(stage):
    core, half = mapped_sphere(0.6 * RADIUS, 64, 32), mapped_sphere(0.7 * RADIUS, 64, 32)

    def add(column, name, mesh, offset, override, priority=0, **material):
        x, y, z = stage.place(UPPER, column, RADIUS + 0.01)
        stage.add_body(f"{name}-{column}", mesh, (x + offset, y, z), {**override, "priority": priority}, **material)

    # Inside, and of equal priority: the smaller one fills the space. Air is a body too, of index 1.
    stage.add_ball(UPPER, 0, override=GLASS)
    add(0, "air", core, 0.0, {}, transmission=1.0, roughness=0.0, further_extensions={
        "KHR_materials_ior": {"ior": 1.0}, "KHR_materials_volume": {"thicknessFactor": 1.0}})
    stage.add_ball(UPPER, 1, override=WATER)
    add(1, "glass", core, 0.0, GLASS)
    # Through each other: what the priority says.
    for column, (left, right) in ((2, (1, 0)), (3, (0, 1))):
        add(column, "glass", half, -0.13, GLASS, left)
        add(column, "wine", half, 0.13, WINE, right)
    # The core is there only where the sphere does not have precedence: nowhere.
    stage.add_ball(UPPER, COLUMNS - 1, override={**WATER, "priority": 1})
    add(COLUMNS - 1, "wine", core, 0.0, WINE)


def _add_cups(stage):
    cup = lathe([(0.0, 0.0), (0.40, 0.0), (0.40, 0.85), (0.34, 0.85), (0.34, 0.08), (0.0, 0.08)], SEGMENTS)
    # Reaches into the wall and the bottom of the cup, so that no gap is between them.
    drink = lathe([(0.0, 0.05), (0.37, 0.05), (0.37, 0.62), (0.0, 0.62)], SEGMENTS)
    ice = mapped_sphere(0.18, 48, 24)
    contents = (None, (WATER, 0), (WATER, 0), (WINE, 0), (WINE, 2))
    for column, content in enumerate(contents):
        def add(name, mesh, override, priority, height=0.01, column=column):
            stage.add_body(f"{name}-{column}", mesh, stage.place(LOWER, column, height),
                           {**override, "priority": priority})

        add("cup", cup, GLASS, 1)
        if content is not None:
            add("drink", drink, *content)
        # Swims: partly in the drink, partly in air.
        if column >= 2:
            add("ice", ice, ICE, 0, height=0.58)
