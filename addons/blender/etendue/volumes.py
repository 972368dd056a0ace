"""Homogeneous media of Cycles' volume shaders, as factors of glTF's materials. Needs nothing of Blender."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .nodes import Seen
from .written import Document


@dataclass
class Medium:
    """Holds coefficients of scattering and of absorption per metre, and the mean cosine of scattering."""

    scattering: list[float]
    absorption: list[float]
    forward: float


def medium(volume: Seen) -> Document | None:
    """Factors for a medium that is constant; None for others."""
    found = coefficients(volume)
    if found is None:
        return None
    extinction = [a + b for a, b in zip(found.scattering, found.absorption)]
    densest = max(extinction)
    if densest <= 0.0:
        return {}
    # White has exp(-1) left in the densest channel after this distance.
    result: Document = {"attenuation_distance": 1.0 / densest, "attenuation_color": [math.exp(-a / densest) for a in extinction]}
    if max(found.scattering) <= 0.0:
        return result
    forward = min(max(found.forward, -0.999), 0.999)
    albedo = [a / b if b > 0.0 else 0.0 for a, b in zip(found.scattering, extinction)]
    return result | {"multiscatter_color": [multiscatter(a, forward) for a in albedo], "scatter_anisotropy": forward}


def coefficients(volume: Seen) -> Medium | None:
    if volume.type == "ADD_SHADER":
        parts = [coefficients(side) for side in (volume.source(0), volume.source(1)) if side is not None]
        if not parts or None in parts:
            return None
        weights = [sum(part.scattering) for part in parts]
        forward = sum(part.forward * weight for part, weight in zip(parts, weights)) / sum(weights) if sum(weights) > 0.0 else 0.0
        return Medium([sum(channels) for channels in zip(*(part.scattering for part in parts))],
                      [sum(channels) for channels in zip(*(part.absorption for part in parts))], forward)
    if volume.type not in ("VOLUME_SCATTER", "VOLUME_ABSORPTION", "PRINCIPLED_VOLUME"):
        return None
    color, density, forward = volume.value("Color"), volume.value("Density"), volume.value("Anisotropy", default=0.0)
    tint = volume.value("Absorption Color", default=[0.0, 0.0, 0.0])
    if None in (color, density, forward, tint):
        return None
    density = max(density, 0.0)
    color = [max(channel, 0.0) for channel in color]
    left = [density * max(1.0 - channel, 0.0) for channel in color]
    if volume.type == "VOLUME_ABSORPTION":
        return Medium([0.0, 0.0, 0.0], left, 0.0)
    scattering = [density * channel for channel in color]
    if volume.type == "VOLUME_SCATTER":
        return Medium(scattering, [0.0, 0.0, 0.0], forward)
    return Medium(scattering, [a * max(1.0 - b, 0.0) for a, b in zip(left, tint)], forward)


def glows(volume: Seen) -> bool:
    """Returns whether the volume or a part of it emits light."""
    if volume.type == "ADD_SHADER":
        return any(glows(side) for side in (volume.source(0), volume.source(1)) if side is not None)
    return any(volume.value(name, default=0.0) != 0.0 for name in ("Emission Strength", "Blackbody Intensity"))


def multiscatter(albedo: float, forward: float) -> float:
    """The colour of many scatterings of a medium of this single-scattering albedo: the inverse of
    `HomogeneousMedium::albedo_from_multiscatter`, which gives 0 for 0 and 1 for 1 and grows in between."""
    def single(color: float) -> float:
        s = 4.09712 + 4.20863 * color - math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color)
        return (1.0 - s * s) / (1.0 - forward * s * s)

    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if single(middle) < albedo else (low, middle)
    return 0.5 * (low + high)
