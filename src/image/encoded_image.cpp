#include "image/encoded_image.h"

#include "core/error.h"
#include "image/exr_claims.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

namespace etendue {

namespace {

struct Beginning {
    std::array<std::byte, kMagicBytes> head{};
    std::size_t head_size = 0;
    std::int64_t size = 0;
};

Beginning beginning_of(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) throw IoError("the file does not exist");
    if (error) throw IoError(error.message());
    // Reading a pipe or a device could block for ever.
    if (!std::filesystem::is_regular_file(status)) throw IoError("not a regular file");

    Beginning beginning;
    beginning.size = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) throw IoError("the file cannot be opened");
    stream.read(reinterpret_cast<char*>(beginning.head.data()), static_cast<std::streamsize>(beginning.head.size()));
    beginning.head_size = static_cast<std::size_t>(stream.gcount());
    return beginning;
}

Beginning beginning_of(std::span<const std::byte> bytes) {
    Beginning beginning;
    beginning.size = static_cast<std::int64_t>(bytes.size());
    beginning.head_size = std::min(bytes.size(), beginning.head.size());
    std::copy_n(bytes.begin(), beginning.head_size, beginning.head.begin());
    return beginning;
}

std::vector<std::byte> first_bytes(const std::filesystem::path& path, std::size_t most) {
    std::vector<std::byte> bytes(most);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

std::vector<std::byte> first_bytes(std::span<const std::byte> bytes, std::size_t most) {
    bytes = bytes.first(std::min(bytes.size(), most));
    return {bytes.begin(), bytes.end()};
}

/// Gives a Radiance picture a header that the library reads, if it has another.
void rewrite_radiance(EncodedImage& image) {
    const auto first = [&](std::size_t most) {
        most = std::min(most, static_cast<std::size_t>(image.size));
        return std::visit([most](const auto& place) { return first_bytes(place, most); }, image.source);
    };
    const RadianceHeader header = parse_radiance_header(first(kMostRadianceHeader));
    if (header.is_plain) return;
    // Four bytes a pixel where none is packed.
    constexpr std::size_t kMostPixelBytes = 4 * static_cast<std::size_t>(kMaxImagePixels);
    const std::vector<std::byte> file = first(header.size + kMostPixelBytes);
    const std::string plain = plain_radiance_header(header);
    const auto plain_bytes = std::as_bytes(std::span(plain));
    auto rewritten = std::make_shared<std::vector<std::byte>>(plain_bytes.begin(), plain_bytes.end());
    rewritten->insert(rewritten->end(), file.begin() + static_cast<std::ptrdiff_t>(header.size), file.end());
    image.radiance = header;
    image.source = std::span<const std::byte>(*rewritten);
    image.size = static_cast<std::int64_t>(rewritten->size());
    image.rewritten = std::move(rewritten);
}

ByteSource bytes_of(const std::filesystem::path& path) {
    const auto stream = std::make_shared<std::ifstream>(path, std::ios::binary);
    return [stream](std::uint64_t offset, std::span<std::uint8_t> bytes) {
        stream->clear();
        stream->seekg(static_cast<std::streamoff>(offset));
        stream->read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return static_cast<std::size_t>(std::max<std::streamsize>(0, stream->gcount()));
    };
}

ByteSource bytes_of(std::span<const std::byte> all) {
    return [all](std::uint64_t offset, std::span<std::uint8_t> bytes) {
        const std::size_t count = offset < all.size() ? std::min(bytes.size(), all.size() - offset) : 0;
        if (count > 0) std::memcpy(bytes.data(), all.data() + offset, count);
        return count;
    };
}

}  // namespace

EncodedImage look_at(const ImageSource& source) {
    const Beginning beginning = std::visit([](const auto& place) { return beginning_of(place); }, source);
    if (beginning.size == 0) throw IoError("the file is empty");
    const auto format = detect_format(std::span(beginning.head).first(beginning.head_size));
    if (!format) throw IoError("not an image of a known format (PNG, JPEG, WebP, OpenEXR, Radiance HDR, TIFF)");
    if (format->name == "openexr")
        check_exr_claims(std::visit([](const auto& place) { return bytes_of(place); }, source),
                         static_cast<std::uint64_t>(beginning.size));
    EncodedImage image{source, *format, beginning.size};
    if (format->name == "hdr") rewrite_radiance(image);
    return image;
}

}  // namespace etendue
