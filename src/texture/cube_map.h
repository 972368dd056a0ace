// Six images of what is seen from the middle of a cube.
#pragma once

#include "core/vec.h"
#include "texture/texture.h"

#include <array>

namespace etendue {

/// Each face is seen from inside and has its top row towards +Y; +Y has it towards -Z, and -Y towards +Z.
class CubeMap {
  public:
    /// `faces`: +X, -X, +Y, -Y, +Z, -Z; squares of one size with 3 linear channels.
    explicit CubeMap(std::array<ImageF, 6> faces);

    /// Value in `direction`, which need not be of unit length but must not be zero; bilinear within a face.
    [[nodiscard]] Rgb lookup(const Vec3f& direction) const;
    /// Pixels along an edge.
    [[nodiscard]] int side() const { return faces_.front().width(); }

  private:
    std::array<Texture, 6> faces_;
};

}  // namespace etendue
