"""What metals and coated surfaces reflect, as curves over the cosine, for shaders of Cycles that have no such Fresnel
terms.

Cycles 3.4 has a GGX lobe without a Fresnel term, which loses what scatters more than once. It is multiplied by what the
surface of docs/gltf.md (Interpretations, Energy) reflects in all in each direction, over what that lobe does."""

import math
import re
from functools import lru_cache

from scenegen.spectra import D65, XYZ_TO_REC709, cie_xyz

# 1 - cosine at which curves are given. Reflectances bend at grazing angles.
FACING = [i / 16 for i in range(14)] + [0.86, 0.9, 0.94, 0.97, 0.985, 1.0]
SMOOTH_ALPHA = 1e-3  # of src/bsdf/ggx.h: below it a lobe is a mirror
DIRECTIONS = 24  # squared: of each integral over half vectors


def optical_constants(source, symbol):
    """[(nm, n, k)] of the metal `symbol`, from the text of src/bsdf/measured_metals.cpp. KeyError if it is not there."""
    names = dict(re.findall(r'\{"(\w+)", (k\w+)\}', source))
    body = re.search(rf"> {names[symbol]}\{{\{{(.*?)\}}\}};", source, re.S).group(1)
    return [tuple(map(float, row)) for row in re.findall(r"([\d.]+), ([\d.]+), ([\d.]+)", body)]


def _at(constants, nm):
    upper = next((i for i in range(1, len(constants) - 1) if constants[i][0] >= nm), len(constants) - 1)
    (a, n0, k0), (b, n1, k1) = constants[upper - 1], constants[upper]
    t = (nm - a) / (b - a)
    return complex(n0 + t * (n1 - n0), k0 + t * (k1 - k0))


def fresnel_conductor(cosine, eta):
    """Born and Wolf, "Principles of Optics", section 14.2."""
    cos_t = (1.0 - (1.0 - cosine * cosine) / (eta * eta)) ** 0.5
    perpendicular = (cosine - eta * cos_t) / (cosine + eta * cos_t)
    parallel = (eta * cosine - cos_t) / (eta * cosine + cos_t)
    return 0.5 * (abs(perpendicular) ** 2 + abs(parallel) ** 2)


def metal(constants):
    """Linear Rec.709 reflectance of the cosine, under D65, of a metal with these constants: Schlick's curve with a dip, by
    the reflectances at cosines 1 and 1/7, as src/bsdf/fresnel.h has it."""
    weights, white = {}, [0.0] * 3
    for nm in D65:
        xyz = cie_xyz(nm)
        weights[nm] = [D65[nm] * sum(m * v for m, v in zip(row, xyz)) for row in XYZ_TO_REC709]
        white = [w + v for w, v in zip(white, weights[nm])]

    def color(cosine):
        sums = [0.0] * 3
        for nm, weight in weights.items():
            reflected = fresnel_conductor(cosine, _at(constants, nm))
            sums = [s + w * reflected for s, w in zip(sums, weight)]
        return [min(max(s / w, 0.0), 1.0) for s, w in zip(sums, white)]

    f0, f82 = color(1.0), color(1.0 / 7.0)
    curve = schlick(f0)
    dips = [(f - g) / (1.0 / 7.0 * (6.0 / 7.0) ** 6) for f, g in zip(curve(1.0 / 7.0), f82)]

    def reflectance(cosine):
        mu = min(max(cosine, 0.0), 1.0)
        return [min(max(f - dip * mu * (1.0 - mu) ** 6, 0.0), 1.0) for f, dip in zip(curve(mu), dips)]

    return reflectance


def schlick(f0):
    """Schlick's reflectance of the cosine, which is 1 where it grazes."""
    return lambda cosine: [f + (1.0 - f) * (1.0 - min(max(cosine, 0.0), 1.0)) ** 5 for f in f0]


def _half_vectors(cosine, alpha):
    """Cosines between the direction and visible half vectors, with the share that the single lobe keeps of each: Heitz,
    "Sampling the GGX Distribution of Visible Normals" (JCGT 2018), and Smith's height-correlated shadowing."""
    sine = math.sqrt(max(0.0, 1.0 - cosine * cosine))
    vx, vz = alpha * sine, cosine
    length = math.hypot(vx, vz)
    vx, vz = vx / length, vz / length

    def smith(c):
        return 0.5 * (math.sqrt(1.0 + alpha * alpha * (1.0 - c * c) / (c * c)) - 1.0)

    for i in range(DIRECTIONS):
        for j in range(DIRECTIONS):
            r, phi = math.sqrt((i + 0.5) / DIRECTIONS), 2.0 * math.pi * (j + 0.5) / DIRECTIONS
            t1, t2 = r * math.cos(phi), r * math.sin(phi)
            # The frame about v: (0, 1, 0) and what is at right angles to both.
            s = 0.5 * (1.0 + vz)
            t2 = (1.0 - s) * math.sqrt(max(0.0, 1.0 - t1 * t1)) + s * t2
            n = math.sqrt(max(0.0, 1.0 - t1 * t1 - t2 * t2))
            hx, hy, hz = alpha * (-vz * t2 + vx * n), alpha * t1, max(1e-7, vx * t2 + vz * n)
            scale = 1.0 / math.sqrt(hx * hx + hy * hy + hz * hz)
            hx, hz = hx * scale, hz * scale
            cos_h = sine * hx + cosine * hz
            cos_i = 2.0 * cos_h * hz - cosine
            kept = (1.0 + smith(cosine)) / (1.0 + smith(cosine) + smith(cos_i)) if cos_i > 1e-6 else 0.0
            yield max(cos_h, 0.0), kept


@lru_cache(maxsize=None)
def _white_albedo(cosine, alpha):
    return sum(kept for _, kept in _half_vectors(cosine, alpha)) / DIRECTIONS ** 2


@lru_cache(maxsize=None)
def _white_average(alpha):
    return sum(_white_albedo((i + 0.5) / 16, alpha) * 2 * (i + 0.5) / 256 for i in range(16))


def reflected(fresnel, alpha):
    """Rows [1 - cosine, r, g, b]: share of light that a GGX surface reflects in all, with what scatters more than once
    (Kulla and Conty, SIGGRAPH 2017 course), from its `fresnel` function."""
    if alpha < SMOOTH_ALPHA:
        return [[facing, *fresnel(1.0 - facing)] for facing in FACING]
    average = [0.0] * 3
    for i in range(64):
        cosine = (i + 0.5) / 64
        average = [a + f * 2 * cosine / 64 for a, f in zip(average, fresnel(cosine))]
    white = _white_average(alpha)
    multiple = [f * f * white / (1.0 - f * (1.0 - white)) for f in average]
    rows = []
    for facing in FACING:
        cosine = max(1.0 - facing, 1e-3)
        single = [0.0] * 3
        for cos_h, kept in _half_vectors(cosine, alpha):
            single = [s + kept * f for s, f in zip(single, fresnel(cos_h))]
        rows.append([facing, *(min(1.0, s / DIRECTIONS ** 2 + (1.0 - _white_albedo(cosine, alpha)) * m)
                               for s, m in zip(single, multiple))])
    return rows


def over_white_lobe(rows, alpha):
    """The same over what Cycles' lobe without a Fresnel term reflects: by what it is to be multiplied."""
    if alpha < SMOOTH_ALPHA:
        return rows
    return [[facing, *(value / _white_albedo(max(1.0 - facing, 1e-3), alpha) for value in values)]
            for facing, *values in rows]
