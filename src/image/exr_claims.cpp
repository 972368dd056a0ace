#include "image/exr_claims.h"

#include "core/error.h"
#include "core/refused_input.h"
#include "image/read.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Lines of a chunk by the number of its compression; the last for those that are not known.
constexpr std::array<std::uint64_t, 11> kChunkLines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256, 256};
/// Lines or tiles that may be decoded at once, whatever the file's size: 65536 x 256 pixels of four floats.
constexpr std::uint64_t kMostChunkBytes = std::uint64_t{256} << 20;
/// Deflated data may be this many times larger than their encoding.
constexpr std::uint64_t kMostInflation = 1100;

// Programs write some hundred attributes into a part at most. OpenImageIO looks through all of a part for each of them:
// 60,000 take it 17 s, and as many as are allowed here a tenth of one at most.
constexpr std::uint64_t kMostAttributesOfPart = 4096;
/// Is the most attributes of all parts: 16 for each of the most parts. Each text of a list counts as one, since it
/// takes as much memory.
constexpr std::uint64_t kMostAttributes = 65536;
/// Is the most channels of all parts: as many as a file may have layers.
constexpr std::uint64_t kMostListedChannels = 65536;

std::uint64_t saturated_product(std::uint64_t a, std::uint64_t b) {
    std::uint64_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? ~std::uint64_t{0} : product;
}

std::uint64_t rounded_up_quotient(std::uint64_t a, std::uint64_t b) {
    return a / b + (a % b != 0 ? 1 : 0);
}

/// Numbers and strings of an attribute's value, none beyond its end.
class ValueReader {
  public:
    ValueReader(const ByteSource& source, const ExrAttribute& attribute)
        : source_(source), attribute_(attribute), offset_(0) {}

    [[nodiscard]] std::uint64_t left() const { return attribute_.value_size - offset_; }
    std::uint8_t take_u8() { return take<1>()[0]; }
    std::uint32_t take_u32() {
        const auto bytes = take<4>();
        std::uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
        return value;
    }
    std::int64_t take_i32() { return static_cast<std::int32_t>(take_u32()); }
    void skip(std::uint64_t bytes) {
        if (bytes > left()) fail();
        offset_ += bytes;
    }
    [[noreturn]] void fail() const {
        throw IoError(fmt::format("the header's attribute '{}' claims more than it has", attribute_.name));
    }

  private:
    template <std::size_t Count>
    std::array<std::uint8_t, Count> take() {
        std::array<std::uint8_t, Count> bytes{};
        if (Count > left() || source_(attribute_.value_begin + offset_, bytes) < Count) fail();
        offset_ += Count;
        return bytes;
    }

    const ByteSource& source_;
    const ExrAttribute& attribute_;
    std::uint64_t offset_;
};

/// Holds what decides in one header how much memory its part takes.
struct Part {
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t pixel_bytes = 0;
    std::size_t compression = kChunkLines.size() - 1;
    std::uint64_t tile_width = 0;  ///< 0 for lines
    std::uint64_t tile_height = 0;
    std::optional<std::int64_t> chunk_count{};

    [[nodiscard]] bool has_tiles() const { return tile_width > 0; }
};

void read_window(ValueReader value, Part& part) {
    const std::int64_t x0 = value.take_i32();
    const std::int64_t y0 = value.take_i32();
    const std::int64_t x1 = value.take_i32();
    const std::int64_t y1 = value.take_i32();
    part.width = static_cast<std::uint64_t>(std::max<std::int64_t>(0, x1 - x0 + 1));
    part.height = static_cast<std::uint64_t>(std::max<std::int64_t>(0, y1 - y0 + 1));
}

/// Holds what is counted over all headers of a file.
struct Counts {
    std::uint64_t parts = 0;
    std::uint64_t attributes = 0;
    std::uint64_t attributes_of_part = 0;
    std::uint64_t channels = 0;
};

/// Counts one more; throws RefusedInput if that is too many.
void count_one(std::uint64_t& count, std::uint64_t most, std::string_view what) {
    if (++count > most) throw RefusedInput(fmt::format("it has more than {} {}", most, what));
}

/// Names, each with a type, a flag, three bytes that are not used and two numbers.
void read_channels(ValueReader value, Part& part, Counts& counts) {
    constexpr std::uint32_t kHalf = 1;
    while (value.take_u8() != 0) {
        count_one(counts.channels, kMostListedChannels, "channels");
        while (value.take_u8() != 0) {
        }
        part.pixel_bytes += value.take_u32() == kHalf ? 2 : 4;
        value.skip(12);
    }
}

void check_strings(ValueReader value, Counts& counts) {
    while (value.left() > 0) {
        count_one(counts.attributes, kMostAttributes, "attributes and texts in them");
        value.skip(value.take_u32());
    }
}

void check_preview(ValueReader value) {
    const std::uint64_t width = value.take_u32();
    const std::uint64_t height = value.take_u32();
    value.skip(saturated_product(saturated_product(width, height), 4));
}

/// Deflated behind the size that it has otherwise.
void check_manifest(ValueReader value) {
    if (value.take_u32() > saturated_product(value.left(), kMostInflation)) value.fail();
}

void read_attribute(const ByteSource& source, const ExrAttribute& attribute, Part& part, Counts& counts) {
    count_one(counts.attributes_of_part, kMostAttributesOfPart, "attributes in one part");
    count_one(counts.attributes, kMostAttributes, "attributes and texts in them");
    const auto is = [&](std::string_view name, std::string_view type) {
        return attribute.name == name && attribute.type == type;
    };
    const ValueReader value(source, attribute);
    if (is("dataWindow", "box2i")) read_window(value, part);
    if (is("channels", "chlist")) read_channels(value, part, counts);
    if (is("compression", "compression"))
        part.compression = std::min<std::size_t>(ValueReader(value).take_u8(), kChunkLines.size() - 1);
    if (is("chunkCount", "int")) part.chunk_count = ValueReader(value).take_i32();
    if (is("tiles", "tiledesc")) {
        ValueReader tiles = value;
        part.tile_width = tiles.take_u32();
        part.tile_height = tiles.take_u32();
        if (part.tile_width == 0 || part.tile_height == 0) throw IoError("the header claims tiles without pixels");
    }
    if (attribute.type == "stringvector") check_strings(value, counts);
    if (attribute.type == "preview") check_preview(value);
    if (attribute.type == "idmanifest") check_manifest(value);
}

void check_part(const Part& part, std::uint64_t size) {
    const auto refuse = [&](std::string_view what) {
        throw IoError(fmt::format("the header claims {} x {} pixels{}, which {} bytes cannot hold", part.width,
                                  part.height, what, size));
    };
    const std::uint64_t lines = kChunkLines[part.compression];
    // The table of where its chunks begin has eight bytes for each, and is taken before a chunk is looked at.
    const std::uint64_t chunks = part.has_tiles()
                                     ? saturated_product(rounded_up_quotient(part.width, part.tile_width),
                                                         rounded_up_quotient(part.height, part.tile_height))
                                     : rounded_up_quotient(part.height, lines);
    if (saturated_product(chunks, 8) > size) refuse("");
    if (part.chunk_count &&
        (*part.chunk_count < 0 || saturated_product(static_cast<std::uint64_t>(*part.chunk_count), 8) > size))
        refuse(fmt::format(" in {} chunks", *part.chunk_count));
    const std::uint64_t chunk_bytes = saturated_product(
        saturated_product(part.has_tiles() ? part.tile_width : part.width, part.has_tiles() ? part.tile_height : lines),
        part.pixel_bytes);
    if (chunk_bytes > std::max(kMostChunkBytes, saturated_product(size, kMostInflation)))
        refuse(fmt::format(" of {} bytes in chunks of {} bytes", part.pixel_bytes, chunk_bytes));
}

}  // namespace

void check_exr_claims(const ByteSource& source, std::uint64_t size) {
    Part part;
    Counts counts;
    walk_exr_headers(
        source, size, [&](const ExrAttribute& attribute) { read_attribute(source, attribute, part, counts); },
        [&] {
            check_part(part, size);
            part = {};
            count_one(counts.parts, kMostParts, "parts");
            counts.attributes_of_part = 0;
        });
}

}  // namespace etendue
