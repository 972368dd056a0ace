// Which random numbers a path takes for what.
#pragma once

#include "integrator/camera_wave.h"

#include <cstdint>

namespace etendue {

/// Pairs of dimensions of one bounce.
enum BounceDimension : std::uint32_t {
    kLightChoice,
    kLightTriangle,
    kLightDirection,
    kBsdfDirection,
    kChoices,
    kAlpha,
    kBounceDimensions
};

/// Those that only scenes with bodies need, apart from the others, so that they do not change what these are.
enum BodyDimension : std::uint32_t { kMedium, kWavelength, kBodyDimensions };

[[nodiscard]] constexpr std::uint32_t bounce_dimension(int depth, BounceDimension which) {
    return kFirstFreeDimension + static_cast<std::uint32_t>(depth) * kBounceDimensions + which;
}

[[nodiscard]] constexpr std::uint32_t body_dimension(int depth, BodyDimension which) {
    constexpr std::uint32_t kFirst = 1u << 30;
    return kFirst + static_cast<std::uint32_t>(depth) * kBodyDimensions + which;
}

}  // namespace etendue
