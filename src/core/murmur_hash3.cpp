#include "core/murmur_hash3.h"

#include <bit>
#include <cstddef>

namespace etendue {

namespace {

/// Reads up to four bytes, the first the lowest, whatever the machine's order.
std::uint32_t little_endian(std::string_view bytes) {
    std::uint32_t word = 0;
    for (std::size_t i = bytes.size(); i > 0; --i) word = (word << 8) | static_cast<unsigned char>(bytes[i - 1]);
    return word;
}

std::uint32_t scramble(std::uint32_t word) {
    return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u;
}

}  // namespace

std::uint32_t murmur_hash3_32(std::string_view text, std::uint32_t seed) {
    constexpr std::size_t kBlock = 4;
    std::uint32_t hash = seed;
    std::string_view rest = text;
    for (; rest.size() >= kBlock; rest.remove_prefix(kBlock))
        hash = std::rotl(hash ^ scramble(little_endian(rest.substr(0, kBlock))), 13) * 5u + 0xe6546b64u;
    hash ^= scramble(little_endian(rest));
    hash ^= static_cast<std::uint32_t>(text.size());
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    return hash ^ (hash >> 16);
}

}  // namespace etendue
