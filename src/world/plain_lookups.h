// Look-ups in the textures of many plain surfaces.
#pragma once

#include "texture/texture_lookups.h"

#include <cstddef>

namespace etendue {

/// Surfaces add to it what their textures are asked for (Materials::add_lookups); once that is computed (`finish`),
/// each in the same order takes its lobe from it (Materials::lobe).
class PlainLookups {
  public:
    void clear() {
        texels_.clear();
        next_ = 0;
    }
    void add(const Texture& texture, Vec2f uv, const TextureFootprint& footprint) {
        texels_.add(texture, uv, footprint);
    }
    void finish() { texels_.finish(); }
    /// Returns the next of the results, which are in the order of the look-ups.
    [[nodiscard]] const Rgb& take() { return texels_[next_++]; }
    [[nodiscard]] std::size_t bytes() const { return texels_.bytes(); }

  private:
    TextureLookups texels_;
    std::size_t next_ = 0;
};

}  // namespace etendue
