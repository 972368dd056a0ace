// Textures at a surface point.
#pragma once

#include "world/surface_point.h"
#include "world/world_data.h"

#include <cstddef>

namespace etendue {

/// A difference of texture coordinates through the slot's transform.
[[nodiscard]] inline Vec2f transform_vector(const TextureSlot& slot, Vec2f v) {
    return {slot.row0.x * v.x + slot.row0.y * v.y, slot.row1.x * v.x + slot.row1.y * v.y};
}

/// Texture coordinates through the slot's transform.
[[nodiscard]] inline Vec2f transform_point(const TextureSlot& slot, Vec2f p) {
    return transform_vector(slot, p) + Vec2f(slot.row0.z, slot.row1.z);
}

/// A footprint through the slot's transform.
[[nodiscard]] inline TextureFootprint transform_footprint(const TextureSlot& slot, const TextureFootprint& footprint) {
    return {{transform_vector(slot, footprint.diameter[0]), transform_vector(slot, footprint.diameter[1])}};
}

/// Unfiltered: what decides whether a ray passes, and what is emitted, must be one function of the point, whichever ray
/// asks and however wide it is.
[[nodiscard]] inline Texel lookup_point(const WorldData& data, const TextureSlot& slot, const Vec2f (&uv)[2]) {
    return data.textures[static_cast<std::size_t>(slot.texture)].lookup(transform_point(slot, uv[slot.texcoord]));
}

/// Filtered over the point's footprint.
[[nodiscard]] inline Texel lookup(const WorldData& data, const TextureSlot& slot, const SurfacePoint& point) {
    return data.textures[static_cast<std::size_t>(slot.texture)].lookup(
        transform_point(slot, point.uv[slot.texcoord]), transform_footprint(slot, point.footprint[slot.texcoord]));
}

/// How the slopes of a normal map are spread over the point's footprint, along the tangent and the bitangent.
[[nodiscard]] inline SlopeCovariance lookup_slope_covariance(const WorldData& data, const TextureSlot& slot,
                                                             const SurfacePoint& point) {
    return data.textures[static_cast<std::size_t>(slot.texture)].slope_covariance(
        transform_point(slot, point.uv[slot.texcoord]), transform_footprint(slot, point.footprint[slot.texcoord]));
}

/// `factor` times the texture's `channel(texel)`, if there is a texture.
template <typename Channel>
[[nodiscard]] float scaled(const WorldData& data, float factor, const TextureSlot& slot, const SurfacePoint& point,
                           const Channel& channel) {
    return slot.valid() ? factor * channel(lookup(data, slot, point)) : factor;
}
[[nodiscard]] inline Rgb scaled(const WorldData& data, const Rgb& factor, const TextureSlot& slot,
                                const SurfacePoint& point) {
    return slot.valid() ? factor * lookup(data, slot, point).rgb : factor;
}

}  // namespace etendue
