"""From spectra to linear Rec.709.

Colour matching functions: the multi-lobe fit to the CIE 1931 2° observer of Wyman, Sloan and Shirley, "Simple Analytic
Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013. Integrals are sums of 1 nm steps over the
range that a spectrum was measured in; spectra are interpolated linearly between their samples.
"""

import bisect
import math

# CIE standard illuminant D65, relative, 400 nm to 700 nm in steps of 10 nm (CIE 15:2004, table T.1).
D65 = dict(zip(range(400, 701, 10), (
    82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354,
    107.802, 104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856, 90.0062,
    89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091)))

# Rows of the matrix from CIE XYZ to linear Rec.709 with its D65 white (ITU-R BT.709-6, IEC 61966-2-1).
XYZ_TO_REC709 = (
    (3.2404542, -1.5371385, -0.4985314),
    (-0.9692660, 1.8760108, 0.0415560),
    (0.0556434, -0.2040259, 1.0572252))

LUMINANCE_REC709 = (0.2126729, 0.7151522, 0.0721750)

# Luminous efficacy of 683 lm/W at 540 THz defines the candela.
MAX_LUMINOUS_EFFICACY = 683.002


def _lobe(wavelength, center, rate_below, rate_above):
    t = (wavelength - center) * (rate_below if wavelength < center else rate_above)
    return math.exp(-0.5 * t * t)


def cie_xyz(wavelength):
    """The colour matching functions at `wavelength` in nm."""
    return (
        1.056 * _lobe(wavelength, 599.8, 0.0264, 0.0323)
        + 0.362 * _lobe(wavelength, 442.0, 0.0624, 0.0374)
        - 0.065 * _lobe(wavelength, 501.1, 0.0490, 0.0382),
        0.821 * _lobe(wavelength, 568.8, 0.0213, 0.0247)
        + 0.286 * _lobe(wavelength, 530.9, 0.0613, 0.0322),
        1.217 * _lobe(wavelength, 437.0, 0.0845, 0.0278)
        + 0.681 * _lobe(wavelength, 459.0, 0.0385, 0.0725))


def interpolated(samples):
    """The function that interpolates the dictionary `samples` of values by wavelength, linearly."""
    wavelengths = sorted(samples)

    def value(wavelength):
        i = min(max(bisect.bisect_right(wavelengths, wavelength), 1), len(wavelengths) - 1)
        a, b = wavelengths[i - 1], wavelengths[i]
        t = min(max((wavelength - a) / (b - a), 0.0), 1.0)
        return samples[a] + t * (samples[b] - samples[a])

    return value


def integrate_xyz(spectrum, first=400, last=700):
    """Integral of the function `spectrum` of the wavelength against the colour matching functions, in nm."""
    total = [0.0, 0.0, 0.0]
    for wavelength in range(first, last + 1):
        value = spectrum(wavelength)
        for i, weight in enumerate(cie_xyz(wavelength)):
            total[i] += value * weight
    return total


def to_rec709(xyz):
    """Linear Rec.709 of CIE XYZ; negative outside of the gamut."""
    return [sum(m * c for m, c in zip(row, xyz)) for row in XYZ_TO_REC709]


def xyy_to_rec709(x, y, luminance):
    return to_rec709((luminance * x / y, luminance, luminance * (1.0 - x - y) / y))


def luminance(rgb):
    return sum(w * c for w, c in zip(LUMINANCE_REC709, rgb))


def reflectance_to_rec709(samples):
    """Albedo in linear Rec.709 of a measured reflectance under D65.

    Divided per channel by the colour of the perfect reflector, so that reflectance 1 is albedo 1 in spite of the fit of
    the matching functions and the range that ends at 400 nm and 700 nm.
    """
    d65, reflectance = interpolated(D65), interpolated(samples)
    white = to_rec709(integrate_xyz(d65))
    color = to_rec709(integrate_xyz(lambda wavelength: d65(wavelength) * reflectance(wavelength)))
    return [c / w for c, w in zip(color, white)]


def emission_to_rec709(samples):
    """Radiance in linear Rec.709 of a measured radiance spectrum; a constant spectrum of 1 is (1, 1, 1).

    That is, illuminant E is adapted to Rec.709's white, per channel, and a light with more red than blue looks warm.
    """
    flat = to_rec709(integrate_xyz(lambda wavelength: 1.0))
    color = to_rec709(integrate_xyz(interpolated(samples)))
    return [c / f for c, f in zip(color, flat)]


def planck(wavelength, temperature):
    """Spectral radiance of a black body in W/(m² sr nm), for a wavelength in nm and a temperature in K."""
    meters = wavelength * 1e-9
    h, c, k = 6.62607015e-34, 2.99792458e8, 1.380649e-23
    return 2.0 * h * c * c / meters ** 5 / math.expm1(h * c / (meters * k * temperature)) * 1e-9
