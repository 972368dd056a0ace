"""One module per scene. To add another: a module with `build()` that returns a GeneratedScene, and its line here."""

from . import cornell_box, cornell_glass, furnace, instances, material_grid, sun_and_sky, veach_mis

SCENES = {
    "cornell-box": cornell_box.build,
    "cornell-glass": cornell_glass.build,
    "furnace": furnace.build,
    "veach-mis": veach_mis.build,
    "material-grid": material_grid.build,
    "sun-and-sky": sun_and_sky.build,
    "instances": instances.build,
}
