// The file of the module of image formats, as a part of the program.
#pragma once

#include <cstddef>
#include <span>

namespace etendue {

[[nodiscard]] std::span<const std::byte> module_bytes();

}  // namespace etendue
