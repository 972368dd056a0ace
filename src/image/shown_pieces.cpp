#include "image/shown_pieces.h"

#include "core/error.h"
#include "core/refused_input.h"
#include "image/jpeg.h"
#include "image/read.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Holds a range of bytes, [begin, end), of a file.
struct ByteRange {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
};

/// Adds a range that follows the last of `ranges`; neighbours become one, so that millions of them take no memory.
void add_range(std::vector<ByteRange>& ranges, const ByteRange& range) {
    if (!ranges.empty() && ranges.back().end == range.begin)
        ranges.back().end = range.end;
    else
        ranges.push_back(range);
}

enum class HiddenBytes { LeftOut, Blank };

/// Returns the pieces of a file of `size` bytes that are shown if `ranges`, in ascending order, are not.
std::vector<FilePiece> pieces_around(std::span<const ByteRange> ranges, std::uint64_t size, HiddenBytes hidden) {
    std::vector<FilePiece> pieces;
    if (ranges.empty()) return pieces;
    std::uint64_t end = 0;
    for (const ByteRange& range : ranges) {
        if (range.begin > end) pieces.push_back({end, range.begin - end});
        const std::uint64_t begin = std::max(range.begin, end);
        end = std::max(range.end, end);
        if (hidden == HiddenBytes::Blank && end > begin) pieces.push_back({begin, end - begin, true});
    }
    if (end < size) pieces.push_back({end, size - end});
    return pieces;
}

/// Returns the number that `bytes`, at most eight, stand for.
std::uint64_t number_of(std::span<const std::uint8_t> bytes, bool is_big_endian) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        value = (value << 8) | bytes[is_big_endian ? i : bytes.size() - 1 - i];
    return value;
}

/// Returns whether the format demands the chunk, or it holds transparency or colours.
bool changes_png(std::string_view chunk) {
    constexpr unsigned char kAncillary = 0x20;
    constexpr std::array<std::string_view, 5> kColors{"tRNS", "gAMA", "cHRM", "sRGB", "iCCP"};
    return (static_cast<unsigned char>(chunk.front()) & kAncillary) == 0 || std::ranges::count(kColors, chunk) > 0;
}

/// Walks the directories of a TIFF file: one for each page, and one for its Exif (TIFF 6.0, section 2). BigTIFF has
/// numbers of eight bytes in place of four, and counts entries by such.
class TiffDirectories {
  public:
    TiffDirectories(const ByteSource& source, std::uint64_t size) : source_(source), size_(size) {
        constexpr std::uint64_t kBigTiff = 43;
        std::array<std::uint8_t, 16> head{};
        (void)source_(0, head);
        is_big_endian_ = head[0] == 'M';
        const std::span<const std::uint8_t> bytes(head);
        is_big_ = number_of(bytes.subspan(2, 2), is_big_endian_) == kBigTiff;
        first_ = number_of(bytes.subspan(is_big_ ? 8 : 4, word_bytes()), is_big_endian_);
    }

    /// Returns the places, in ascending order, of the types of entries that are hidden.
    [[nodiscard]] std::vector<ByteRange> hidden() {
        std::set<std::uint64_t> known;
        std::uint64_t page = first_;
        while (page != 0 && known.size() < kMostParts && known.insert(page).second) {
            std::vector<std::uint64_t> exif;
            page = read_directory(page, exif);
            std::vector<std::uint64_t> no_more;  // nobody looks for Exif in Exif
            for (const std::uint64_t directory : exif)
                if (directory != 0) (void)read_directory(directory, no_more);
        }
        std::ranges::sort(hidden_, {}, &ByteRange::begin);
        return std::move(hidden_);
    }

  private:
    // 256 for each of the most pages.
    static constexpr std::uint64_t kMostTags = std::uint64_t{1} << 20;
    /// Is how many times the file all values may claim: pages share some, such as a colour profile.
    static constexpr std::uint64_t kMostSharing = 64;

    [[nodiscard]] std::size_t word_bytes() const { return is_big_ ? 8 : 4; }
    [[nodiscard]] std::size_t count_bytes() const { return is_big_ ? 8 : 2; }
    [[nodiscard]] std::size_t entry_bytes() const { return is_big_ ? 20 : 12; }

    [[nodiscard]] std::optional<std::uint64_t> number_at(std::uint64_t offset, std::size_t bytes) const {
        std::array<std::uint8_t, 8> word{};
        const std::span<std::uint8_t> number = std::span(word).first(bytes);
        if (offset >= size_ || source_(offset, number) < bytes) return std::nullopt;
        return number_of(number, is_big_endian_);
    }

    /// Returns the bytes of one value of `type`, 0 if there is no such type.
    static std::uint64_t value_bytes(std::uint64_t type) {
        constexpr std::array<std::uint64_t, 19> kBytes{0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
        return type < kBytes.size() ? kBytes[type] : 0;
    }

    /// Reads a directory, adds the places of those with its Exif, and returns that of the next, 0 if there is none.
    std::uint64_t read_directory(std::uint64_t offset, std::vector<std::uint64_t>& exif) {
        const std::optional<std::uint64_t> count = number_at(offset, count_bytes());
        if (!count || *count > size_ / entry_bytes()) return 0;
        tags_ += *count;
        if (tags_ > kMostTags) throw RefusedInput(fmt::format("it has more than {} tags", kMostTags));
        const std::uint64_t begin = offset + count_bytes();
        std::vector<std::uint8_t> entries(static_cast<std::size_t>(*count) * entry_bytes());
        entries.resize(source_(begin, entries));
        std::uint64_t claimed = 0;
        for (std::size_t at = 0; at + entry_bytes() <= entries.size(); at += entry_bytes())
            claimed += read_entry(begin + at, std::span(entries).subspan(at, entry_bytes()), exif);
        claimed_ += claimed;
        // One tag that claims too much is not read, but of many each would be, to the end of the file.
        if (claimed > 2 * size_ || claimed_ / kMostSharing > size_) {
            if (offset == first_)
                throw IoError(fmt::format("its tags claim {} bytes, but the file has {}", claimed, size_));
            // Nothing of another page is read; what leads there may be no directory.
            for (std::size_t at = 0; at + entry_bytes() <= entries.size(); at += entry_bytes()) hide_type(begin + at);
        }
        return number_at(begin + *count * entry_bytes(), word_bytes()).value_or(0);
    }

    void hide_type(std::uint64_t entry) { hidden_.push_back({entry + 2, entry + 4}); }

    /// Returns how much of the file an entry claims for its value, at most all of it.
    std::uint64_t read_entry(std::uint64_t place, std::span<const std::uint8_t> entry,
                             std::vector<std::uint64_t>& exif) {
        constexpr std::uint64_t kXmp = 700, kIptc = 33723, kExif = 34665;
        const std::uint64_t tag = number_of(entry.first(2), is_big_endian_);
        if (tag == kXmp || tag == kIptc) {
            hide_type(place);
            return 0;
        }
        const std::uint64_t bytes = value_bytes(number_of(entry.subspan(2, 2), is_big_endian_));
        const std::span<const std::uint8_t> value = entry.last(word_bytes());
        if (tag == kExif)
            exif.push_back(number_of(value.first(std::min<std::size_t>(bytes, word_bytes())), is_big_endian_));
        const std::uint64_t count = number_of(entry.subspan(4, word_bytes()), is_big_endian_);
        if (bytes == 0 || count <= word_bytes() / bytes) return 0;  // it stands in the entry
        return count > size_ / bytes ? size_ : count * bytes;
    }

    const ByteSource& source_;
    std::uint64_t size_;
    bool is_big_endian_ = false;
    bool is_big_ = false;
    std::uint64_t first_ = 0;
    std::uint64_t tags_ = 0;
    std::uint64_t claimed_ = 0;  ///< bytes
    std::vector<ByteRange> hidden_;
};

}  // namespace

// A chunk is a big-endian 32-bit length, a type of four letters, that many bytes and a checksum of four (PNG
// specification, 5.3).
std::vector<FilePiece> shown_pieces_of_png(const ByteSource& source, std::uint64_t size) {
    constexpr std::uint64_t kSignature = 8, kAroundData = 12;
    std::vector<ByteRange> hidden;
    std::array<std::uint8_t, 8> head{};
    for (std::uint64_t begin = kSignature; begin + kAroundData <= size;) {
        if (source(begin, head) < head.size()) break;
        const std::uint64_t end = begin + kAroundData + number_of(std::span(head).first(4), true);
        if (end > size) break;
        const std::string_view type(reinterpret_cast<const char*>(head.data()) + 4, 4);
        if (!changes_png(type)) add_range(hidden, {begin, end});
        if (type == "IEND") break;
        begin = end;
    }
    return pieces_around(hidden, size, HiddenBytes::LeftOut);
}

std::vector<FilePiece> shown_pieces_of_jpeg(std::span<const std::byte> jpeg) {
    constexpr unsigned kJfif = 0xe0, kAdobe = 0xee, kLastApplication = 0xef, kComment = 0xfe, kScan = 0xda;
    // libjpeg looks at JFIF's and Adobe's itself, of which a file has one or two.
    constexpr int kMostShown = 16;
    // The progressions of libjpeg have 24 for four channels, and libtiff decodes no more than 100.
    constexpr int kMostScans = 64;
    std::vector<ByteRange> hidden;
    int shown = 0;
    int scans = 0;
    (void)walk_jpeg_segments(jpeg, [&](unsigned marker, std::size_t begin, std::size_t end) {
        const bool is_application = marker >= kJfif && marker <= kLastApplication;
        const bool is_shown = (marker == kJfif || marker == kAdobe) && ++shown <= kMostShown;
        if (marker == kComment || (is_application && !is_shown)) add_range(hidden, {begin, end});
        if (marker == kScan && ++scans > kMostScans)
            throw RefusedInput(fmt::format("it has more than {} scans", kMostScans));
    });
    return pieces_around(hidden, jpeg.size(), HiddenBytes::LeftOut);
}

std::vector<FilePiece> shown_pieces_of_tiff(const ByteSource& source, std::uint64_t size) {
    return pieces_around(TiffDirectories(source, size).hidden(), size, HiddenBytes::Blank);
}

}  // namespace etendue
