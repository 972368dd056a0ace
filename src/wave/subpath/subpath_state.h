// Where a subpath has got to.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "transport/mis.h"
#include "wave/aov/path_words.h"
#include "wave/subpath/path_vertex.h"

#include <cstdint>

namespace etendue {

/// Holds a subpath under way; ray and interior stand in arrays of their own.
struct SubpathState {
    Rgb throughput{1.0f};
    /// Multiplies the throughput for Russian roulette: eta² over the refractions of radiance, or one over what a light
    /// began with.
    float roulette_scale = 1.0f;
    Vec3f from{0.0f};  ///< the vertex before
    DepartingDensities departing;
    WordRange words;
    std::uint32_t slot = 0;
    int index = 1;  ///< index of the vertex to come
    int edges = 1;  ///< edges of the path when its ray has hit; media, clear surfaces and hidden boundaries add none
    bool is_dispersed = false;
    bool only_deltas = true;
    bool is_after_delta = false;  ///< a delta or a hidden boundary lies behind it
    bool lights_directly = true;  ///< every scattering but the last was a delta
    bool is_direct = true;        ///< no boundary that another body hides lies between `from` and where the ray is
};

}  // namespace etendue
