// A point on a surface, with everything that its material needs.
#pragma once

#include "core/frame.h"
#include "core/vec.h"
#include "texture/footprint.h"

#include <cstdint>

namespace etendue {

struct ConeSection;
struct Material;
struct WorldData;

struct SurfacePoint {
    Vec3f position{0.0f};          ///< world space, metres
    Vec3f geometric_normal{0.0f};  ///< unit, on the front side (counter-clockwise)
    float clearance = 0.0f;        ///< metres along the normal that a ray must start off the surface (position_error.h)
    Frame shading;                 ///< interpolated and normal-mapped; its normal is on the front side too
    Vec3f coat_normal{0.0f};       ///< unit, of the clear coat if the material has one
    /// Variance of slopes about `shading` that the footprint averages, along the frame's x and y: what a normal map's
    /// relief adds to the roughness of what lies under the coat.
    Vec2f slope_variance{0.0f, 0.0f};
    float coat_slope_variance = 0.0f;  ///< variance of slopes about `coat_normal`, the mean of all directions
    Vec2f uv[2]{{0.0f, 0.0f}, {0.0f, 0.0f}};
    TextureFootprint footprint[2];        ///< the part of a texture that a look-up at each `uv` stands for
    Vec4f color{1.0f, 1.0f, 1.0f, 1.0f};  ///< vertex colour, linear Rec.709
    const Material* material = nullptr;
    std::uint32_t instance = 0;
    std::uint32_t geometry = 0;
    std::uint32_t triangle = 0;

    [[nodiscard]] bool has_spread_slopes() const { return slope_variance != Vec2f(0.0f, 0.0f); }
};

/// The surface at `barycentric` (weights of the second and third vertex) of a triangle of an instance, at `time` of the
/// shutter, [0, 1], seen by a ray with this `section`.
[[nodiscard]] SurfacePoint make_surface_point(const WorldData& data, std::uint32_t instance, std::uint32_t geometry,
                                              std::uint32_t triangle, Vec2f barycentric, float time,
                                              const ConeSection& section);

}  // namespace etendue
