// A rectangle of pixels as text.
#pragma once

#include "core/pixel_rect.h"

#include <string>

#include <fmt/format.h>

namespace etendue {

/// "x0,y0,x1,y1", as --crop takes it.
[[nodiscard]] inline std::string text_of(const PixelRect& rect) {
    return fmt::format("{},{},{},{}", rect.x0, rect.y0, rect.x1, rect.y1);
}

/// "WIDTHxHEIGHT", as --size takes it.
[[nodiscard]] inline std::string size_text_of(const PixelRect& rect) {
    return fmt::format("{}x{}", rect.width(), rect.height());
}

}  // namespace etendue
