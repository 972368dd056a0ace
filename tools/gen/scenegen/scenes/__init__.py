"""One module per scene. To add another: a module with `build()` that returns a GeneratedScene, and its line here."""

from . import (ajar_door, caustic_ball, caustic_glass, caustic_glasses, caustic_mirror, caustic_pool, caustic_prism,
               caustic_ring, cornell_box, cornell_glass, diamond, fog, furnace, glossy_interior, instances, many_lights,
               material_grid, radiometry, sun_and_sky, torus_in_glass, veach_bidir, veach_mis)

SCENES = {
    "cornell-box": cornell_box.build,
    "cornell-glass": cornell_glass.build,
    "furnace": furnace.build,
    "veach-mis": veach_mis.build,
    "material-grid": material_grid.build,
    "sun-and-sky": sun_and_sky.build,
    "instances": instances.build,
    "caustic-glass": caustic_glass.build,
    "caustic-ball": caustic_ball.build,
    "caustic-ring": caustic_ring.build,
    "caustic-pool": caustic_pool.build,
    "caustic-prism": caustic_prism.build,
    "caustic-mirror": caustic_mirror.build,
    "veach-bidir": veach_bidir.build,
    "ajar-door": ajar_door.build,
    "many-lights": many_lights.build,
    "glossy-interior": glossy_interior.build,
    "torus-in-glass": torus_in_glass.build,
    "diamond": diamond.build,
    "caustic-glasses": caustic_glasses.build,
    "radiometry": radiometry.build,
    "fog": fog.build,
}
