#include "loader/gltf/glb.h"

#include <cstdint>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
static_assert(kGlbJsonOffset == kHeaderBytes + kChunkHeaderBytes);

/// The little-endian number at `offset`, which must lie inside.
std::uint32_t read_u32(std::span<const unsigned char> bytes, std::size_t offset) {
    return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[offset + 2]) << 16 | static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

}  // namespace

bool is_glb(std::span<const unsigned char> bytes) {
    return bytes.size() >= 4 && read_u32(bytes, 0) == kMagic;
}

std::size_t glb_json_length(std::span<const unsigned char, kGlbJsonOffset> header) {
    return read_u32(header, kHeaderBytes);
}

GlbChunks split_glb(std::span<const unsigned char> bytes, const SourceLocation& where) {
    if (!is_glb(bytes)) throw SceneError(where, "not a binary glTF file: it does not start with 'glTF'");
    if (bytes.size() < kHeaderBytes) throw SceneError(where, "the binary glTF file ends inside its header");
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
        throw SceneError(where, fmt::format("binary glTF version {} is not supported, only 2", version));
    }
    const std::uint32_t length = read_u32(bytes, 8);
    if (length > bytes.size() || length < kHeaderBytes) {
        throw SceneError(
            where, fmt::format("the binary glTF file says that it has {} bytes, but it has {}", length, bytes.size()));
    }
    bytes = bytes.first(length);

    GlbChunks chunks;
    std::size_t offset = kHeaderBytes;
    for (int index = 0; offset < bytes.size(); ++index) {
        if (bytes.size() - offset < kChunkHeaderBytes) {
            throw SceneError(where, fmt::format("chunk {} of the binary glTF file ends inside its header", index));
        }
        const std::uint32_t size = read_u32(bytes, offset);
        const std::uint32_t type = read_u32(bytes, offset + 4);
        offset += kChunkHeaderBytes;
        if (size > bytes.size() - offset) {
            throw SceneError(where, fmt::format("chunk {} of the binary glTF file claims {} bytes, but {} are left",
                                                index, size, bytes.size() - offset));
        }
        const std::span<const unsigned char> content = bytes.subspan(offset, size);
        if (index == 0) {
            if (type != kJsonChunk) throw SceneError(where, "the first chunk of the binary glTF file is not JSON");
            chunks.json = {reinterpret_cast<const char*>(content.data()), content.size()};
        } else if (index == 1 && type == kBinChunk) {
            chunks.bin = content;
        }
        offset += size;
    }
    if (chunks.json.empty()) throw SceneError(where, "the binary glTF file has no JSON");
    return chunks;
}

}  // namespace etendue
