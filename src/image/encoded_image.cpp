#include "image/encoded_image.h"

#include "core/error.h"
#include "core/refused_input.h"
#include "image/exr_claims.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

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

void show_instead(std::shared_ptr<const std::vector<std::byte>> rewritten, EncodedImage& image) {
    image.source = std::span<const std::byte>(*rewritten);
    image.size = static_cast<std::int64_t>(rewritten->size());
    image.rewritten = std::move(rewritten);
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
    show_instead(std::move(rewritten), image);
}

/// Takes out of a JPEG what the library is not shown.
void rewrite_jpeg(EncodedImage& image) {
    constexpr std::int64_t kMostBytes = 4 * kMaxImagePixels;
    if (image.size > kMostBytes)
        throw RefusedInput(fmt::format("{} bytes are more than are read of a JPEG ({})", image.size, kMostBytes));
    std::vector<std::byte> file;
    std::span<const std::byte> bytes;
    if (const auto* memory = std::get_if<std::span<const std::byte>>(&image.source)) {
        bytes = *memory;
    } else {
        file = first_bytes(std::get<std::filesystem::path>(image.source), static_cast<std::size_t>(image.size));
        bytes = file;
    }
    const std::vector<FilePiece> pieces = shown_pieces_of_jpeg(bytes);
    if (pieces.empty()) return;
    auto rewritten = std::make_shared<std::vector<std::byte>>();
    for (const FilePiece& piece : pieces) {
        const auto shown = bytes.subspan(piece.begin, piece.size);
        rewritten->insert(rewritten->end(), shown.begin(), shown.end());
    }
    show_instead(std::move(rewritten), image);
}

}  // namespace

EncodedImage look_at(const ImageSource& source) {
    const Beginning beginning = std::visit([](const auto& place) { return beginning_of(place); }, source);
    if (beginning.size == 0) throw IoError("the file is empty");
    const auto format = detect_format(std::span(beginning.head).first(beginning.head_size));
    if (!format) throw IoError("not an image of a known format (PNG, JPEG, WebP, OpenEXR, Radiance HDR, TIFF)");
    EncodedImage image{source, *format, beginning.size};
    const auto size = static_cast<std::uint64_t>(beginning.size);
    const ByteSource bytes = std::visit([](const auto& place) { return byte_source(place); }, source);
    if (format->name == "openexr") check_exr_claims(bytes, size);
    if (format->name == "png") image.pieces = shown_pieces_of_png(bytes, size);
    if (format->name == "tiff") image.pieces = shown_pieces_of_tiff(bytes, size);
    if (format->name == "jpeg") rewrite_jpeg(image);
    if (format->name == "hdr") rewrite_radiance(image);
    return image;
}

}  // namespace etendue
