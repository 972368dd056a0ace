"""A clear sky and its sun, in absolute photometric units.

Sky: Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999, appendix A.2: Perez's
formula with coefficients that are linear in the turbidity. Sun: a black body of 5778 K seen through the Rayleigh
scattering and the aerosols of the same paper's appendix A.1; ozone, gases and water vapour, a few per cent in the
visible, are left out.
"""

import math

from . import spectra
from .images import exr, latitude_longitude
from .vector import direction, dot

SUN_TEMPERATURE = 5778.0
SUN_SOLID_ANGLE = 6.80e-5


class Sky:
    """Daylight for a sun at `elevation` and `azimuth` (radians, see vector.direction) at a turbidity of 2 to 6.

    Radiances are in units of `unit` kcd/m², which is what exposes the scene. `ground_albedo`, linear Rec.709, is that
    of the plain below the horizon.
    """

    def __init__(self, elevation, azimuth, turbidity, unit, ground_albedo):
        self.sun_direction = direction(elevation, azimuth)
        self._turbidity = turbidity
        self._unit = unit
        self._sun_zenith = 0.5 * math.pi - elevation
        self._perez = [[slope * turbidity + offset for slope, offset in row] for row in _PEREZ]
        overhead = [_perez(c, 0.0, self._sun_zenith) for c in self._perez]
        self._factors = [zenith / f for zenith, f in zip(self._zenith(), overhead)]
        self.sun_irradiance = self._sun_irradiance()
        down = [e * math.sin(elevation) + s for e, s in zip(self.sun_irradiance, self._sky_irradiance())]
        self._ground = tuple(albedo * e / math.pi for albedo, e in zip(ground_albedo, down))

    def sun_color_and_intensity(self):
        """For a directional light: colour with its largest component 1, and W/m² on a surface facing the sun."""
        intensity = max(self.sun_irradiance)
        return [c / intensity for c in self.sun_irradiance], intensity

    def radiance(self, toward):
        """Linear Rec.709 radiance from the unit vector `toward`; below the horizon, of a diffuse plain."""
        if toward[1] <= 0.0:
            return self._ground
        gamma = math.acos(min(max(dot(toward, self.sun_direction), -1.0), 1.0))
        # The zenith angle is kept off the horizon, where the formula divides by its cosine.
        zenith = min(math.acos(min(toward[1], 1.0)), 0.5 * math.pi - 1e-3)
        y, cx, cy = (f * _perez(c, zenith, gamma) for f, c in zip(self._factors, self._perez))
        return tuple(max(c, 0.0) for c in spectra.xyy_to_rec709(cx, cy, y / self._unit))

    def environment(self, width):
        """An OpenEXR file of the sky without the sun's disk, `width` by half of it."""
        return exr(width, width // 2, latitude_longitude(width, width // 2, self.radiance))

    def _zenith(self):
        """Luminance in kcd/m² and chromaticities x, y of the zenith."""
        t, s = self._turbidity, self._sun_zenith
        chi = (4.0 / 9.0 - t / 120.0) * (math.pi - 2.0 * s)
        powers = (s ** 3, s ** 2, s, 1.0)
        luminance = (4.0453 * t - 4.9710) * math.tan(chi) - 0.2155 * t + 2.4192
        return [luminance] + [sum(w * sum(a * p for a, p in zip(row, powers)) for w, row in zip((t * t, t, 1.0), table))
                              for table in _ZENITH_CHROMATICITY]

    def _sun_irradiance(self):
        """Linear Rec.709 irradiance on a surface that faces the sun."""
        degrees = math.degrees(self._sun_zenith)
        air_mass = 1.0 / (math.cos(self._sun_zenith) + 0.15 * (93.885 - degrees) ** -1.253)
        beta = 0.04608 * self._turbidity - 0.04586

        def irradiance(wavelength):
            micrometers = 1e-3 * wavelength
            depth = 0.008735 * micrometers ** -4.08 + beta * micrometers ** -1.3
            return spectra.planck(wavelength, SUN_TEMPERATURE) * SUN_SOLID_ANGLE * math.exp(-depth * air_mass)

        xyz = spectra.integrate_xyz(irradiance, 380, 780)
        kilolux = 1e-3 * spectra.MAX_LUMINOUS_EFFICACY
        return tuple(c * kilolux / self._unit for c in spectra.to_rec709(xyz))

    def _sky_irradiance(self, steps=32):
        """Irradiance of a horizontal surface by the sky: midpoints in sin² of the zenith angle and in the azimuth."""
        total = [0.0, 0.0, 0.0]
        for i in range(steps):
            elevation = math.acos(math.sqrt((i + 0.5) / steps))
            for j in range(2 * steps):
                color = self.radiance(direction(elevation, math.pi * (j + 0.5) / steps))
                total = [t + c for t, c in zip(total, color)]
        return [math.pi * t / (2 * steps * steps) for t in total]


def _perez(coefficients, zenith, gamma):
    """Perez's F(θ, γ)."""
    a, b, c, d, e = coefficients
    return (1.0 + a * math.exp(b / math.cos(zenith))) * (1.0 + c * math.exp(d * gamma) + e * math.cos(gamma) ** 2)


# Slope in the turbidity and offset of Perez's A … E, for Y, x and y.
_PEREZ = (
    ((0.17872, -1.46303), (-0.35540, 0.42749), (-0.02266, 5.32505), (0.12064, -2.57705), (-0.06696, 0.37027)),
    ((-0.01925, -0.25922), (-0.06651, 0.00081), (-0.00041, 0.21247), (-0.06409, -0.89887), (-0.00325, 0.04517)),
    ((-0.01669, -0.26078), (-0.09495, 0.00921), (-0.00792, 0.21023), (-0.04405, -1.65369), (-0.01092, 0.05291)))

# Zenith x and y: rows for T², T, 1 and columns for θs³, θs², θs, 1.
_ZENITH_CHROMATICITY = (
    ((0.00165, -0.00374, 0.00208, 0.0),
     (-0.02902, 0.06377, -0.03202, 0.00394),
     (0.11693, -0.21196, 0.06052, 0.25885)),
    ((0.00275, -0.00610, 0.00316, 0.0),
     (-0.04212, 0.08970, -0.04153, 0.00515),
     (0.15346, -0.26756, 0.06669, 0.26688)))
