"""From the program's layers to Blender's passes."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

import numpy

from .exr import Exr
from .passes import ALBEDO, AS_IS, INDEX, OVER_ALBEDO, TO_Z_UP, UV, WHITE, Pass

LEAST_ALBEDO = numpy.float32(1e-5)
NOTHING = numpy.float32(1e10)  # the program's depth where there is nothing


def planes(exr: Exr, names: list[str]) -> numpy.ndarray | None:
    """These channels as rows from the bottom up, which Blender has; None if the file lacks one."""
    if any(name not in exr.channels for name in names):
        return None
    return numpy.stack([exr.channels[name][::-1].astype(numpy.float32) for name in names], axis=-1)


def combined(exr: Exr, transparent: bool) -> numpy.ndarray:
    """The image. Where nothing is behind the scene, it is opaque unless the film is transparent."""
    result = planes(exr, list("RGBA"))
    if result is None:
        result = numpy.concatenate([planes(exr, list("RGB")), numpy.ones((exr.height, exr.width, 1), numpy.float32)], axis=-1)
    if not transparent:
        result[..., 3] = 1.0
    return result


def indices(names: list[str], given: Mapping[str, int]) -> numpy.ndarray:
    """Blender's pass index for each number of the program, 0 for none. What shares a name has the names above it before
    its own, and slashes between them; what shares these too, a number behind them."""
    def index(name: str) -> int:
        for here in (name, re.sub(r"#\d+$", "", name)):
            while here not in given and "/" in here:
                here = here.partition("/")[2]
            if here in given:
                return given[here]
        return 0

    return numpy.array([0, *map(index, names)], numpy.float32)


def pixels_of(exr: Exr, item: Pass, given: Mapping[str, Mapping[str, int]]) -> numpy.ndarray | None:
    """The pixels of a pass, None if the file lacks its layer. `given` has the pass indices that are not 0, by layer and
    name."""
    if item.change == WHITE:
        return numpy.ones((exr.height, exr.width, len(item.channels)), numpy.float32)
    result = planes(exr, item.names())
    if result is None or item.change == AS_IS:
        return result
    if item.change == INDEX:
        by_number = indices(json.loads(exr.text(f"etendue:names/{item.source}") or "[]"), given.get(item.source, {}))
        return by_number[numpy.clip(result.astype(numpy.int64), 0, len(by_number) - 1)]
    if item.change == TO_Z_UP:
        return numpy.stack([result[..., 0], -result[..., 2], result[..., 1]], axis=-1)
    if item.change == UV:
        depth = planes(exr, ["depth.Z"])
        if depth is None:
            return None
        covered = depth < NOTHING
        # glTF counts v from the top.
        uva = numpy.concatenate([result[..., :1], 1.0 - result[..., 1:], numpy.ones_like(depth)], axis=-1)
        return numpy.where(covered, uva, numpy.float32(0.0))
    albedo = planes(exr, [f"albedo_diffuse.{letter}" for letter in "RGB"])
    if albedo is None:
        return None
    if item.change == ALBEDO:
        # Light paths bring light to pixels whose own rays meet nothing diffuse: without a colour it would be lost.
        layers = [planes(exr, [f"{layer}.{letter}" for letter in "RGB"]) for layer in ("diffuse_direct", "diffuse_indirect")]
        for light in layers:
            if light is not None:
                albedo[(albedo <= LEAST_ALBEDO) & (light > 0.0)] = 1.0
        return albedo
    assert item.change == OVER_ALBEDO
    return numpy.divide(result, albedo, out=result.copy(), where=albedo > LEAST_ALBEDO)
