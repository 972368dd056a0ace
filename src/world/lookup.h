// Textures at a surface point.
#pragma once

#include "world/surface_point.h"
#include "world/world.h"

#include <algorithm>
#include <cstddef>

namespace etendue {

[[nodiscard]] inline Texel lookup(const WorldData& data, const TextureSlot& slot, const Vec2f (&uv)[2]) {
    const Vec2f c = uv[slot.texcoord];
    const Vec2f transformed{slot.row0.x * c.x + slot.row0.y * c.y + slot.row0.z,
                            slot.row1.x * c.x + slot.row1.y * c.y + slot.row1.z};
    return data.textures[static_cast<std::size_t>(slot.texture)].lookup(transformed);
}

/// `factor` times the texture's `channel(texel)`, if there is a texture.
template <typename Channel>
[[nodiscard]] float scaled(const WorldData& data, float factor, const TextureSlot& slot, const SurfacePoint& point,
                           const Channel& channel) {
    return slot.valid() ? factor * channel(lookup(data, slot, point.uv)) : factor;
}
[[nodiscard]] inline Rgb scaled(const WorldData& data, const Rgb& factor, const TextureSlot& slot,
                                const SurfacePoint& point) {
    return slot.valid() ? factor * lookup(data, slot, point.uv).rgb : factor;
}

[[nodiscard]] inline Rgb clamp_unit(const Rgb& c) {
    return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
}

}  // namespace etendue
