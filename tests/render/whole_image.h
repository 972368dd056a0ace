// Options of a render of a whole image.
#pragma once

#include "render/render.h"

#include <cstdint>

namespace etendue::test {

[[nodiscard]] inline RenderOptions whole_image(int width, int height, std::uint32_t spp, std::uint32_t seed = 0) {
    RenderOptions options;
    options.full_width = width;
    options.full_height = height;
    options.window = {0, 0, width, height};
    options.spp = spp;
    options.seed = seed;
    return options;
}

}  // namespace etendue::test
