// Light tracing: paths from the lights, all of whose vertices are shown to the camera (Dutré, Lafortune and Willems,
// "Monte Carlo Light Tracing with Direct Computation of Pixel Intensities", Compugraphics 1993), for one sample.
// `integrator/light/` computes the same for many samples at once, from the same random numbers.
#pragma once

#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/subpath.h"

#include <optional>
#include <vector>

namespace etendue {

/// Holds light that a path brings to a place on the film.
struct FilmLight {
    Vec2f film{0.0f, 0.0f};  ///< as CameraConnection::film: [0, 1]² is the image, and places beside it are beyond
    Rgb value;               ///< share in the integral over the film of area 1
};

/// Says how the camera sees a point.
struct LensView {
    CameraConnection camera;
    Vec3f direction{0.0f};  ///< unit, from the point to the lens
    float distance = 0.0f;  ///< metres
};

/// Returns how the camera sees `position` through the lens point made from `lens` in [0, 1)²; nothing if no film,
/// however large, would show it.
[[nodiscard]] std::optional<LensView> view_from_lens(const World& world, const Vec3f& position, Vec2f lens, float time);

/// Returns what the light path of `sample` brings to the film. Black contributions are left out.
[[nodiscard]] std::vector<FilmLight> light_on_film(const World& world, const EyeSample& sample,
                                                   const IntegratorSettings& settings);

}  // namespace etendue
