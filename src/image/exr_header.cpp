#include "image/exr_header.h"

#include "core/error.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::uint64_t kMagicAndVersion = 8;
constexpr std::uint64_t kFlagsByte = 5;
constexpr std::uint8_t kMultiPart = 0x10;
constexpr std::size_t kLongestName = 255;

/// Reads from the beginning to the end, a block at a time.
class HeaderReader {
  public:
    HeaderReader(const ByteSource& source, std::uint64_t size) : source_(source), size_(size) {}

    [[nodiscard]] std::uint64_t offset() const { return offset_; }
    [[nodiscard]] std::uint64_t left() const { return size_ - std::min(size_, offset_); }
    void skip(std::uint64_t bytes) { offset_ += bytes; }

    std::uint8_t take_byte() {
        if (offset_ < begin_ || offset_ >= begin_ + filled_) {
            begin_ = offset_;
            filled_ = offset_ < size_ ? source_(offset_, block_) : 0;
            if (filled_ == 0) throw IoError("the file ends inside its header");
        }
        return block_[offset_++ - begin_];
    }
    std::uint32_t take_u32() {
        std::uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{take_byte()} << (8 * i);
        return value;
    }
    /// Ended by a zero, which is taken, too.
    std::string take_name() {
        std::string name;
        while (const std::uint8_t byte = take_byte()) {
            if (name.size() == kLongestName) throw IoError("a name in the header is too long");
            name += static_cast<char>(byte);
        }
        return name;
    }

  private:
    const ByteSource& source_;
    std::uint64_t size_;
    std::uint64_t offset_ = 0;
    std::array<std::uint8_t, 4096> block_{};
    std::uint64_t begin_ = 0;  ///< place of the block in the file, bytes
    std::size_t filled_ = 0;
};

}  // namespace

// A header is a sequence of attributes, each a name, a type (both zero-terminated), a little-endian 32-bit size and
// that many bytes; an empty name ends it. Files of several parts have as many headers, and an empty one at their end
// (openexr.com, "OpenEXR File Layout").
void walk_exr_headers(const ByteSource& source, std::uint64_t size,
                      const std::function<void(const ExrAttribute&)>& visit, const std::function<void()>& end_part) {
    HeaderReader reader(source, size);
    reader.skip(kFlagsByte);
    const bool multi_part = (reader.take_byte() & kMultiPart) != 0;
    reader.skip(kMagicAndVersion - reader.offset());
    bool is_empty = true;  // the header
    while (true) {
        ExrAttribute attribute;
        attribute.name_begin = reader.offset();
        attribute.name = reader.take_name();
        if (attribute.name.empty()) {
            if (is_empty && multi_part) return;
            end_part();
            if (!multi_part) return;
            is_empty = true;
            continue;
        }
        is_empty = false;
        attribute.type = reader.take_name();
        attribute.value_size = reader.take_u32();
        attribute.value_begin = reader.offset();
        if (attribute.value_size > reader.left())
            throw IoError(fmt::format("the header claims {} bytes for one attribute, but {} are left",
                                      attribute.value_size, reader.left()));
        visit(attribute);
        reader.skip(attribute.value_size);
    }
}

bool rename_exr_attribute(std::span<std::uint8_t> exr, std::string_view from, std::string_view to) {
    if (from.size() != to.size()) return false;
    const auto read = [exr](std::uint64_t offset, std::span<std::uint8_t> bytes) {
        const std::size_t count = std::min<std::size_t>(bytes.size(), exr.size() - offset);
        std::ranges::copy(exr.subspan(offset, count), bytes.begin());
        return count;
    };
    bool renamed = false;
    const auto rename = [&](const ExrAttribute& attribute) {
        if (attribute.name != from) return;
        std::ranges::copy(to, exr.begin() + static_cast<std::ptrdiff_t>(attribute.name_begin));
        renamed = true;
    };
    try {
        walk_exr_headers(read, exr.size(), rename, [] {});
    } catch (const IoError&) {
        // What is behind the broken place is no attribute.
    }
    return renamed;
}

}  // namespace etendue
