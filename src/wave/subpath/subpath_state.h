// Where a subpath has got to.
#pragma once

#include "transport/mis.h"
#include "wave/aov/path_words.h"
#include "wave/subpath/path_vertex.h"

#include <cstdint>

namespace etendue {

/// Holds a subpath under way; ray and interior stand in arrays of their own.
struct SubpathState : SubpathProgress {
    WordRange words;
    std::uint32_t slot = 0;
    bool lights_directly = true;  ///< every scattering but the last was a delta
};

}  // namespace etendue
