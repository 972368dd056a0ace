// Which image formats are read, recognised by their first bytes rather than by a name that may lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace etendue {

/// A format that can be decoded. To add another, add its row in encoded_format.cpp.
struct EncodedFormat {
    std::string_view name;   ///< name of the format, as in ImageInfo::format
    std::string_view magic;  ///< the bytes that every such file starts with
    /// Most bytes of decoded pixels that one encoded byte can stand for; a header that claims more is a lie.
    std::int64_t max_expansion;
    std::string_view magic_at_8 =
        {};  ///< and the bytes from the ninth on, in formats that are one of many in a container
    int bits_per_pixel =
        0;  ///< before compression, where a pixel may be less than what is decoded of it; 0 if it is that
};

/// How many bytes `detect_format` wants to see.
inline constexpr std::size_t kMagicBytes = 26;

/// The format whose magic bytes `head` starts with, if any.
[[nodiscard]] std::optional<EncodedFormat> detect_format(std::span<const std::byte> head);

}  // namespace etendue
