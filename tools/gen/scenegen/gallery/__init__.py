"""The scenes of docs/gallery.md by name, each with a build() of its own."""

from . import chess, cradle, glasses, interior, jewels, pool, racer, street, temple

SCENES = {
    "glasses": glasses.build,
    "jewels": jewels.build,
    "interior": interior.build,
    "pool": pool.build,
    "street": street.build,
    "chess": chess.build,
    "racer": racer.build,
    "cradle": cradle.build,
    "temple": temple.build,
}
