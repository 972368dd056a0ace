// What a material is at a point, apart from how it scatters (gltf_surface.h): opacity, colour, emission, relief.
#pragma once

#include "core/rgb.h"
#include "world/surface_point.h"
#include "world/world_data.h"

#include <cstdint>

namespace etendue {

/// Share of light that a surface stops, [0, 1]: what is not is let through unchanged.
[[nodiscard]] float evaluate_opacity(const WorldData& data, std::uint32_t geometry, std::uint32_t triangle,
                                     Vec2f barycentric);

/// Base colour in the working space: factor, texture and vertex colour.
[[nodiscard]] Rgb evaluate_base_color(const WorldData& data, const GltfModel& model, const SurfacePoint& point);

/// `color` in linear Rec.709 as a base colour in the working space.
[[nodiscard]] Rgb working_base_color(const WorldData& data, const Rgb& color);

/// Emitted radiance without regard to sides, working space.
[[nodiscard]] Rgb evaluate_emission(const WorldData& data, const Material& material, const SurfacePoint& point);

/// The frame around the normal that a normal map asks for, from one with the surface's tangent and normal.
/// `bitangent_sign` is -1 where the texture lies mirrored on the surface.
[[nodiscard]] Frame apply_normal_map(const WorldData& data, const TextureSlot& map, float scale,
                                     const SurfacePoint& point, const Frame& frame, float bitangent_sign);

/// How the slopes of a normal map spread over the point's footprint, as seen in the frame `mapped` around the mean
/// normal; the others as for `apply_normal_map`.
[[nodiscard]] SlopeCovariance relief_below(const WorldData& data, const TextureSlot& map, float scale,
                                           const SurfacePoint& point, const Frame& frame, float bitangent_sign,
                                           const Frame& mapped);

/// The frame turned so that its tangent lies along the direction in which an anisotropic surface is rougher.
[[nodiscard]] Frame apply_anisotropy(const WorldData& data, const Material& material, const SurfacePoint& point,
                                     const Frame& frame, float bitangent_sign);

}  // namespace etendue
