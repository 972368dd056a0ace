"""Rows of spheres that hold what glTF files can bring in place, for tests/regression. Each is a function that returns a
GeneratedScene with its render.json. To add another: the function in the module of its kind, and its line here."""

from . import animated, bodies, compressed, emission, geometry, lamps, nested, sheets, surfaces

ROWS = {
    "row-animated": animated.animated,
    "row-anisotropy": surfaces.anisotropy,
    "row-clearcoat": surfaces.clearcoat,
    "row-compressed": compressed.compressed,
    "row-diffuse-transmission": sheets.diffuse_transmission,
    "row-dispersion": bodies.dispersion,
    "row-emission": emission.emission,
    "row-geometry": geometry.geometry,
    "row-ior": surfaces.ior,
    "row-iridescence": surfaces.iridescence,
    "row-lamps": lamps.lamps,
    "row-models": bodies.models,
    "row-nested": nested.nested,
    "row-sheen": surfaces.sheen,
    "row-specular": surfaces.specular,
    "row-transmission": sheets.transmission,
    "row-volume": bodies.volume,
    "row-volume-scatter": bodies.volume_scatter,
}
