#include "medium/homogeneous_medium.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

float transmittance_of(float extinction, float distance) {
    return extinction > 0.0f ? std::exp(-extinction * distance) : 1.0f;
}

}  // namespace

Rgb HomogeneousMedium::transmittance(float distance) const {
    return {transmittance_of(extinction.r, distance), transmittance_of(extinction.g, distance),
            transmittance_of(extinction.b, distance)};
}

MediumSample HomogeneousMedium::sample(const Rgb& throughput, float distance, Vec2f u) const {
    const Rgb scattering = extinction * single_scatter_albedo;
    if (is_black(scattering)) return {.distance = distance, .weight = transmittance(distance)};
    const float total = throughput.r + throughput.g + throughput.b;
    const Rgb chance = total > 0.0f ? throughput / total : Rgb(1.0f / 3.0f);
    const float chosen = u.y < chance.r ? extinction.r : u.y < chance.r + chance.g ? extinction.g : extinction.b;
    const float free_path = chosen > 0.0f ? -std::log1p(-u.x) / chosen : distance;
    if (free_path >= distance) {
        const Rgb passed = transmittance(distance);
        const float density = chance.r * passed.r + chance.g * passed.g + chance.b * passed.b;
        return {.distance = distance, .weight = density > 0.0f ? passed / density : Rgb()};
    }
    const Rgb passed = transmittance(free_path);
    const Rgb density = chance * extinction * passed;
    const float sum = density.r + density.g + density.b;
    return {.distance = free_path, .scatters = true, .weight = sum > 0.0f ? scattering * passed / sum : Rgb()};
}

Rgb HomogeneousMedium::albedo_from_multiscatter(const Rgb& multiscatter_color, float g) {
    const auto channel = [g](float color) {
        const float c = std::clamp(color, 0.0f, 1.0f);
        const float s = 4.09712f + 4.20863f * c - std::sqrt(9.59217f + 41.6808f * c + 17.7126f * c * c);
        return std::clamp((1.0f - s * s) / (1.0f - g * s * s), 0.0f, 1.0f);
    };
    return {channel(multiscatter_color.r), channel(multiscatter_color.g), channel(multiscatter_color.b)};
}

}  // namespace etendue
