#include "image/jpeg.h"

#include "core/error.h"
#include "image/encoded_image.h"
#include "image/image_functions.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <variant>

namespace etendue {

namespace {

using Bytes = std::span<const std::byte>;

/// True if no end marker follows the segments and the coded data of a JPEG (ITU-T T.81, annex B).
bool lacks_end(Bytes bytes) {
    constexpr unsigned kEnd = 0xd9, kStart = 0xd8, kFirstRestart = 0xd0;
    const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
    std::size_t i = 0;
    while (i + 3 < bytes.size()) {
        const unsigned marker = at(i + 1);
        if (at(i) != 0xff || marker == 0xff) {
            ++i;
        } else if (marker == kEnd) {
            return false;
        } else if (marker < 2 || (marker >= kFirstRestart && marker <= kStart)) {
            i += 2;  // stands alone, or is a coded 0xff
        } else {
            i += 2 + ((at(i + 2) << 8) | at(i + 3));
        }
    }
    // It may be all that is left.
    for (; i + 1 < bytes.size(); ++i)
        if (at(i) == 0xff && at(i + 1) == kEnd) return false;
    return true;
}

}  // namespace

std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality) {
    return image_functions().encode_jpeg(image, quality);
}

bool is_cut_jpeg(const ImageSource& source) {
    constexpr std::int64_t kMostBytes = 4 * kMaxImagePixels;
    const EncodedImage image = look_at(source);
    if (image.format.name != "jpeg" || image.size > kMostBytes) return false;
    if (const auto* bytes = std::get_if<Bytes>(&source)) return lacks_end(*bytes);
    std::vector<std::byte> bytes(static_cast<std::size_t>(image.size));
    std::ifstream stream(std::get<std::filesystem::path>(source), std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream) throw IoError("the file cannot be read");
    return lacks_end(bytes);
}

}  // namespace etendue
