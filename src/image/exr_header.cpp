#include "image/exr_header.h"

#include <algorithm>
#include <cstddef>

namespace etendue {

namespace {

constexpr std::size_t kMagicAndVersion = 8;
constexpr std::size_t kFlagsByte = 5;
constexpr std::uint8_t kMultiPart = 0x10;

// The zero-terminated string at `offset`, which is moved behind its zero; empty at the end of the bytes.
std::string_view take_string(std::span<const std::uint8_t> bytes, std::size_t& offset) {
    const std::size_t begin = offset;
    while (offset < bytes.size() && bytes[offset] != 0) ++offset;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + begin, offset - begin);
    ++offset;
    return text;
}

}  // namespace

// A header is a sequence of attributes, each a name, a type (both zero-terminated), a little-endian 32-bit size and
// that many bytes; an empty name ends it. Files of several parts have as many headers, and an empty one at their end
// (openexr.com, "OpenEXR File Layout").
bool rename_exr_attribute(std::span<std::uint8_t> exr, std::string_view from, std::string_view to) {
    if (from.size() != to.size()) return false;
    const bool multi_part = exr.size() > kFlagsByte && (exr[kFlagsByte] & kMultiPart) != 0;
    std::size_t offset = kMagicAndVersion;
    bool renamed = false;
    bool begins = true;  // a header
    while (offset < exr.size()) {
        const std::size_t name_begin = offset;
        const std::string_view name = take_string(exr, offset);
        if (name.empty()) {
            if (!multi_part || begins) return renamed;
            begins = true;
            continue;
        }
        begins = false;
        if (name == from) {
            std::copy(to.begin(), to.end(), exr.begin() + static_cast<std::ptrdiff_t>(name_begin));
            renamed = true;
        }
        take_string(exr, offset);
        if (offset + 4 > exr.size()) return renamed;
        std::size_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) size |= static_cast<std::size_t>(exr[offset + i]) << (8 * i);
        offset += 4 + size;
    }
    return renamed;
}

}  // namespace etendue
