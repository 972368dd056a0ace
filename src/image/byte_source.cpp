#include "image/byte_source.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <ios>
#include <memory>

namespace etendue {

namespace {

/// Reads a file through a block, since whoever walks through a header asks for a few bytes at a time.
class FileBytes {
  public:
    explicit FileBytes(const std::filesystem::path& path) : stream_(path, std::ios::binary) {}

    std::size_t read(std::uint64_t offset, std::span<std::uint8_t> bytes) {
        if (bytes.size() > block_.size()) return read_through(offset, bytes);
        const bool is_held =
            offset >= begin_ && offset - begin_ <= filled_ && bytes.size() <= filled_ - (offset - begin_);
        if (!is_held) {
            begin_ = offset;
            filled_ = read_through(offset, block_);
        }
        const auto first = static_cast<std::size_t>(offset - begin_);
        const std::size_t count = std::min(bytes.size(), filled_ - first);
        std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>(first), count, bytes.begin());
        return count;
    }

  private:
    std::size_t read_through(std::uint64_t offset, std::span<std::uint8_t> bytes) {
        stream_.clear();
        stream_.seekg(static_cast<std::streamoff>(offset));
        stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return static_cast<std::size_t>(std::max<std::streamsize>(0, stream_.gcount()));
    }

    std::ifstream stream_;
    std::array<std::uint8_t, 4096> block_{};
    std::uint64_t begin_ = 0;  ///< place of the block in the file, bytes
    std::size_t filled_ = 0;
};

}  // namespace

ByteSource byte_source(const std::filesystem::path& path) {
    const auto file = std::make_shared<FileBytes>(path);
    return [file](std::uint64_t offset, std::span<std::uint8_t> bytes) { return file->read(offset, bytes); };
}

ByteSource byte_source(std::span<const std::byte> all) {
    return [all](std::uint64_t offset, std::span<std::uint8_t> bytes) {
        const std::size_t count = offset < all.size() ? std::min(bytes.size(), all.size() - offset) : 0;
        if (count > 0) std::memcpy(bytes.data(), all.data() + offset, count);
        return count;
    };
}

}  // namespace etendue
