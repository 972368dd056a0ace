#include "image/jpeg.h"

#include "core/error.h"
#include "image/encoded_image.h"
#include "image/image_functions.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <variant>

namespace etendue {

std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality) {
    return image_functions().encode_jpeg(image, quality);
}

// ITU-T T.81, annex B.
bool walk_jpeg_segments(std::span<const std::byte> jpeg,
                        const std::function<void(unsigned marker, std::size_t begin, std::size_t end)>& visit) {
    constexpr unsigned kEnd = 0xd9, kStart = 0xd8, kFirstRestart = 0xd0, kFirstWithLength = 0xc0;
    const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(jpeg[i]); };
    std::size_t i = 0;
    while (i + 3 < jpeg.size()) {
        const unsigned marker = at(i + 1);
        if (at(i) != 0xff) {
            const void* const next = std::memchr(jpeg.data() + i, 0xff, jpeg.size() - i);
            i = next == nullptr ? jpeg.size()
                                : static_cast<std::size_t>(static_cast<const std::byte*>(next) - jpeg.data());
        } else if (marker == 0xff) {
            ++i;
        } else if (marker == kEnd) {
            return true;
        } else if (marker < kFirstWithLength || (marker >= kFirstRestart && marker <= kStart)) {
            i += 2;  // stands alone, is a coded 0xff or is reserved, where libjpeg looks for the next
        } else {
            const std::size_t begin = i;
            i += 2 + ((at(i + 2) << 8) | at(i + 3));
            visit(marker, begin, std::min(i, jpeg.size()));
        }
    }
    // It may be all that is left.
    for (; i + 1 < jpeg.size(); ++i)
        if (at(i) == 0xff && at(i + 1) == kEnd) return true;
    return false;
}

bool is_cut_jpeg(const ImageSource& source) {
    const EncodedImage image = look_at(source);
    if (image.format.name != "jpeg") return false;
    const auto lacks_end = [](std::span<const std::byte> jpeg) {
        return !walk_jpeg_segments(jpeg, [](unsigned, std::size_t, std::size_t) {});
    };
    if (const auto* bytes = std::get_if<std::span<const std::byte>>(&image.source)) return lacks_end(*bytes);
    std::vector<std::byte> bytes(static_cast<std::size_t>(image.size));
    std::ifstream stream(std::get<std::filesystem::path>(image.source), std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream) throw IoError("the file cannot be read");
    return lacks_end(bytes);
}

}  // namespace etendue
