// Where subpaths merge, and how far apart their vertices may be.
#pragma once

#include "core/ray_cone.h"
#include "core/vec.h"
#include "scene/integrator_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace etendue {

/// Computes the radius within which vertices merge, for samples of one index.
struct MergeRadius {
    Vec3f eye{0.0f};
    RayCone pixel{};     ///< cone of a pixel in the middle of the image
    float scale = 1.0f;  ///< radius over the pixel's width
    float least = 0.0f;  ///< metres, > 0
    float most = 0.0f;   ///< metres

    [[nodiscard]] float operator()(const Vec3f& point) const {
        const float distance = length(point - eye);
        return std::max({std::min(scale * pixel.width_at(distance), most), kPrecision * distance,
                         kPrecision * largest_coordinate(point), least});
    }
    /// Bounds `slope`: within a kernel radii then lie between two thirds and four thirds of its own.
    static constexpr float kMostSlope = 1.0f / 3.0f;

    /// Returns how much radii of points one metre apart differ at most.
    [[nodiscard]] float slope() const { return std::max(scale * std::abs(pixel.spread), kPrecision); }

  private:
    /// Bounds the radius from below, in what rounding of a place grows with: its coordinates, and how far it is seen
    /// from. Sixteen steps of floats lie within it.
    static constexpr float kPrecision = 1e-6f;

    [[nodiscard]] static float largest_coordinate(const Vec3f& point) {
        return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    }
};

/// Says where the subpaths of one sample of every pixel merge.
struct Merging {
    MergeAt at = MergeAt::Nothing;
    MergeRadius radius{};
    double light_paths = 0.0;  ///< light subpaths whose photons an eye vertex may merge with

    [[nodiscard]] bool merges() const { return at != MergeAt::Nothing; }
    /// Returns how many light subpaths are expected within `metres`, per density of arriving there.
    [[nodiscard]] double expected_within(float metres) const {
        return std::numbers::pi * static_cast<double>(metres) * static_cast<double>(metres) * light_paths;
    }
    /// Returns eta: how many light subpaths are expected within the radius around `point`, per density of arriving
    /// at a surface there that stops the share `opacity`.
    [[nodiscard]] double expected(const Vec3f& point, float opacity) const {
        return static_cast<double>(opacity) * expected_within(radius(point));
    }
};

class World;

/// Returns where subpaths merge in an image of `width` × `height` pixels, for the sample of index `sample` of every
/// pixel and as many light subpaths as `light_paths`. Nowhere, if nothing in `world` could have it happen.
[[nodiscard]] Merging make_merging(const World& world, int width, int height, double light_paths, std::uint32_t sample,
                                   const MergeSettings& options);

}  // namespace etendue
