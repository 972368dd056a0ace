// The ways in which the camera sees a surface: as it is, as the shadow on it, or as a hole.
#pragma once

#include <cstdint>

namespace etendue {

/// Names what the camera sees, straight or through clear surfaces, in the place of a surface.
enum class SeenAs : std::uint8_t {
    Surface,
    Shadow,  ///< how much light is taken from it, as alpha: the surface is a shadow catcher
    Hole,    ///< nothing, with alpha 0: the surface is a holdout
};

}  // namespace etendue
