"""Rooms and what stands in them."""

from .mesh import box, merged, wall
from .vector import scale


def add_room(scene, low, high, materials, openings=None, uv_per_meter=0.0, prefix=""):
    """The inside of a box. `materials` by the names floor, ceiling, left, right, back (-Z) and front: others are left
    out. `openings` by the same names, as of mesh.wall: from the lower left corner, seen from inside.
    `prefix` tells the objects of several rooms apart."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    x, y, z = (x1 - x0, 0.0, 0.0), (0.0, y1 - y0, 0.0), (0.0, 0.0, z1 - z0)
    sides = {
        "floor": ((x0, y0, z1), x, scale(z, -1.0)), "ceiling": ((x0, y1, z0), x, z),
        "left": ((x0, y0, z1), scale(z, -1.0), y), "right": ((x1, y0, z0), z, y),
        "back": ((x0, y0, z0), x, y), "front": ((x1, y0, z1), scale(x, -1.0), y)}
    for name, material in materials.items():
        mesh = wall(*sides[name], (openings or {}).get(name, ()), uv_per_meter)
        scene.add_object(prefix + name, mesh, material)


def table(width, depth, height, thickness, leg):
    """A table about the Y axis that stands on y = 0."""
    w, d, inset = 0.5 * width, 0.5 * depth, 0.5 * thickness
    top = box((-w, height - thickness, -d), (w, height, d))
    legs = []
    for x in (inset - w, w - inset - leg):
        for z in (inset - d, d - inset - leg):
            # Into the top, so that no gap is between them.
            legs.append(box((x, 0.0, z), (x + leg, height - 0.5 * thickness, z + leg)))
    return merged([top, *legs])
