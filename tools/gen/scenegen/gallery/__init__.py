"""The scenes of docs/gallery.md by name, each with a build() of its own."""

from . import chess, glasses, jewels, pool, street

SCENES = {
    "glasses": glasses.build,
    "jewels": jewels.build,
    "chess": chess.build,
    "pool": pool.build,
    "street": street.build,
}
