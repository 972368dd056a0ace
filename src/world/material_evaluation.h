// Materials at a point: textures looked up, numbers handed to the lobes.
#pragma once

#include "bsdf/bsdf.h"
#include "core/rgb.h"
#include "world/surface_point.h"
#include "world/world.h"

#include <cstdint>

namespace etendue {

/// Share of light that a surface stops, [0, 1]: what is not is let through unchanged.
[[nodiscard]] float evaluate_opacity(const WorldData& data, std::uint32_t geometry, std::uint32_t triangle,
                                     Vec2f barycentric);

/// Base colour in the working space: factor, texture and vertex colour.
[[nodiscard]] Rgb evaluate_base_color(const WorldData& data, const GltfModel& model, const SurfacePoint& point);

[[nodiscard]] Bsdf evaluate_gltf_model(const WorldData& data, const GltfModel& model, const SurfacePoint& point);

/// Emitted radiance without regard to sides, working space.
[[nodiscard]] Rgb evaluate_emission(const WorldData& data, const Material& material, const SurfacePoint& point);

/// The frame around the normal that the material's normal map asks for.
[[nodiscard]] Frame apply_normal_map(const WorldData& data, const Material& material, const SurfacePoint& point,
                                     float bitangent_sign);

}  // namespace etendue
