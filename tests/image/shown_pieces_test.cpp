// Pictures with all that OpenImageIO would read of them for hours, or until the memory or the stack ends.
#include "image/shown_pieces.h"

#include "core/error.h"
#include "core/refused_input.h"
#include "core/write_file.h"
#include "image/image_reader.h"
#include "image/jpeg.h"
#include "image/layers.h"
#include "image/read.h"
#include "image_test_files.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace etendue {

namespace {

/// An unsigned number of `bytes` bytes.
std::string number(std::uint64_t value, std::size_t bytes, bool is_big_endian = true) {
    std::string text;
    for (std::size_t i = 0; i < bytes; ++i)
        text += static_cast<char>((value >> (8 * (is_big_endian ? bytes - 1 - i : i))) & 255);
    return text;
}

std::string repeated(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

/// XMP of that many levels, each of which the library takes some of its stack for.
std::string nested_xmp(int levels) {
    return "<rdf:Description>" + repeated("<rdf:li>", levels) + repeated("</rdf:li>", levels) + "</rdf:Description>";
}

std::span<const std::byte> bytes_in(const std::string& file) {
    return std::as_bytes(std::span(file));
}

std::string text_of_file(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_all(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns the bytes of `file` that the library would see.
std::string joined(const std::string& file, const std::vector<FilePiece>& pieces) {
    if (pieces.empty()) return file;
    std::string shown;
    for (const FilePiece& piece : pieces)
        shown += piece.is_blank ? std::string(piece.size, '\0') : file.substr(piece.begin, piece.size);
    return shown;
}

std::string shown_of_png(const std::string& file) {
    return joined(file, shown_pieces_of_png(byte_source(bytes_in(file)), file.size()));
}

std::string shown_of_jpeg(const std::string& file) {
    return joined(file, shown_pieces_of_jpeg(bytes_in(file)));
}

std::string chunk(const std::string& type, const std::string& data) {
    std::uint32_t crc = 0xffffffffu;
    for (const char c : type + data) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    return number(data.size(), 4) + type + data + number(~crc, 4);
}

TEST(ShownPieces, TextsOfAPngAreLeftOut) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> values(20 * 10 * 4);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i * 7);
    const std::string plain =
        text_of_file(write_reference(folder / "a.png", {20, 10, 4, OIIO::TypeDesc::UINT8}, values));
    constexpr std::size_t kBehindHeader = 33;
    const std::string xmp = chunk("iTXt", std::string("XML:com.adobe.xmp\0\0\0\0\0", 22) + nested_xmp(200'000));
    const std::string texts = chunk("tEXt", std::string("a\0b", 3)) + xmp + chunk("tIME", std::string(7, '\1'));
    std::string file = plain;
    file.insert(kBehindHeader, texts);
    file.insert(file.size() - 12, chunk("eXIf", "II"));
    EXPECT_EQ(shown_of_png(file), shown_of_png(plain));
    const std::string gamma = chunk("gAMA", number(45455, 4));
    EXPECT_NE(shown_of_png(std::string(plain).insert(kBehindHeader, gamma)).find(gamma), std::string::npos);

    write_text(folder / "b.png", file);
    EXPECT_EQ(read_image_8bit(folder / "b.png").pixels, values);
    EXPECT_EQ(read_image_8bit(bytes_in(file)).pixels, values);
    ImageReader reader{ImageSource(folder / "b.png")};
    std::vector<float> row(20 * 4);
    for (const int y : {7, 2}) {
        reader.read_rows(0, y, y + 1, row);
        for (std::size_t i = 0; i < row.size(); ++i)
            ASSERT_FLOAT_EQ(row[i], static_cast<float>(values[static_cast<std::size_t>(y) * 80 + i]) / 255.0f) << y;
    }
}

TEST(ShownPieces, BrokenPngsAreShownAsTheyAre) {
    const std::string signature = "\x89PNG\r\n\x1a\n";
    for (const std::string& file : {signature, signature + "abc", signature + number(1000, 4) + "tEXt" + "abcdef",
                                    signature + number(0xffffffff, 4) + "tEXt" + "abcdef"})
        EXPECT_EQ(shown_of_png(file), file);
}

std::string segment(unsigned char marker, const std::string& data) {
    return std::string("\xff") + static_cast<char>(marker) + number(data.size() + 2, 2) + data;
}

/// An application segment with so many keywords.
std::string iptc_segment(unsigned keywords) {
    std::string records;
    for (unsigned i = 0; i < keywords; ++i)
        records += std::string("\x1c\x02\x19\0\5", 5) + std::to_string(10'000 + i).substr(0, 5);
    const std::string head = std::string("Photoshop 3.0\0008BIM\4\4\0\0\0\0", 24);
    return segment(0xed, head + number(records.size(), 2) + records);
}

std::int64_t peak_memory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{usage.ru_maxrss} << 10;
}

TEST(ShownPieces, CommentsOfAJpegAreLeftOut) {
    ImageF image(40, 30, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 50) / 50.0f;
    const std::vector<unsigned char> encoded = encode_jpeg(image, 90);
    const std::string plain(encoded.begin(), encoded.end());
    const Image8 expected = read_image_8bit(bytes_in(plain));

    constexpr std::size_t kBehindStart = 2;
    const std::string xmp = std::string("http://ns.adobe.com/xap/1.0/\0", 29) + nested_xmp(3000);
    std::string file = plain;
    file.insert(file.size() - 2, segment(0xfe, "at the end"));
    file.insert(kBehindStart, repeated(segment(0xfe, "comment"), 1000) + segment(0xe1, xmp) + iptc_segment(6000));
    EXPECT_EQ(shown_of_jpeg(file), shown_of_jpeg(plain));
    const std::int64_t before = peak_memory();
    const Image8 read = read_image_8bit(bytes_in(file));
    EXPECT_EQ(read.pixels, expected.pixels);
    EXPECT_FALSE(is_cut_jpeg(bytes_in(file)));
    const TemporaryFolder folder;
    write_text(folder / "a.jpg", file);
    EXPECT_EQ(read_image_8bit(folder / "a.jpg").pixels, expected.pixels);
    EXPECT_FALSE(is_cut_jpeg(folder / "a.jpg"));
    EXPECT_LT(peak_memory() - before, std::int64_t{64} << 20);

    // Segments that say how colours are stored stay, but only the first of them.
    const std::string adobe = segment(0xee, std::string("Adobe\0\x64\0\0\0\0\1", 12));
    EXPECT_EQ(shown_of_jpeg(std::string(plain).insert(kBehindStart, adobe)),
              shown_of_jpeg(plain).insert(kBehindStart, adobe));
    EXPECT_LT(shown_of_jpeg(std::string(plain).insert(kBehindStart, repeated(adobe, 1000))).size(),
              plain.size() + 20 * adobe.size());
}

TEST(ShownPieces, ScansOfAJpegAreCounted) {
    const auto with_scans = [](int count) {
        return "\xff\xd8" + repeated(segment(0xda, "") + "abc", count) + "\xff\xd9";
    };
    EXPECT_EQ(shown_of_jpeg(with_scans(64)), with_scans(64));
    EXPECT_THROW((void)shown_of_jpeg(with_scans(65)), RefusedInput);
    EXPECT_THROW((void)read_image_info(bytes_in(with_scans(65))), RefusedInput);
    const std::string behind_reserved = "\xff\xd8" + segment(0xda, "") + "\xff\x02\xff\xff\xff\xd0" +
                                        repeated(segment(0xda, "") + "abc", 100) + "\xff\xd9";
    EXPECT_THROW((void)shown_of_jpeg(behind_reserved), RefusedInput);
}

struct TiffKind {
    bool is_big_endian = false;
    bool is_big_tiff = false;

    [[nodiscard]] std::size_t word() const { return is_big_tiff ? 8 : 4; }
    [[nodiscard]] std::string text(std::uint64_t value, std::size_t bytes) const {
        return number(value, bytes, is_big_endian);
    }
};

struct TiffTag {
    std::uint64_t tag = 0;
    std::uint64_t type = 0;
    std::uint64_t count = 0;
    std::string value{};                          ///< bytes
    std::optional<std::uint64_t> shared_place{};  ///< of the value, if it is that of another tag
};

constexpr std::uint64_t kByte = 1;
constexpr std::uint64_t kShort = 3;
constexpr std::uint64_t kLong = 4;

/// Grey pixels 0 to 15, 4 x 4 of them, on each page.
std::string tiff(const TiffKind& kind, const std::vector<TiffTag>& more, int pages = 1) {
    const std::size_t head_size = kind.is_big_tiff ? 16 : 8;
    std::string data;
    for (int i = 0; i < 16; ++i) data += static_cast<char>(i);
    std::vector<TiffTag> tags;
    const auto add_short = [&](std::uint64_t tag, std::uint64_t value) {
        tags.push_back({tag, kShort, 1, kind.text(value, 2)});
    };
    add_short(256, 4);  // width
    add_short(257, 4);  // height
    add_short(258, 8);  // bits
    add_short(259, 1);  // not compressed
    add_short(262, 1);  // black is zero
    tags.push_back({273, kLong, 1, kind.text(head_size, 4)});
    add_short(277, 1);   // channels
    add_short(278, 4);   // rows of a strip
    add_short(279, 16);  // bytes of a strip
    tags.insert(tags.end(), more.begin(), more.end());
    std::string entries;
    for (const TiffTag& tag : tags) {
        std::string value = tag.value;
        if (tag.shared_place || value.size() > kind.word()) {
            value = kind.text(tag.shared_place.value_or(head_size + data.size()), kind.word());
            data += tag.value;
        }
        value.resize(kind.word(), '\0');
        entries += kind.text(tag.tag, 2) + kind.text(tag.type, 2) + kind.text(tag.count, kind.word()) + value;
    }
    if (data.size() % 2 != 0) data += '\0';
    const std::string count = kind.text(tags.size(), kind.is_big_tiff ? 8 : 2);
    const std::size_t first = head_size + data.size();
    std::string file = kind.is_big_endian ? "MM" : "II";
    file += kind.is_big_tiff ? kind.text(43, 2) + kind.text(8, 2) + kind.text(0, 2) : kind.text(42, 2);
    file += kind.text(first, kind.word()) + data;
    for (int page = 0; page < pages; ++page) {
        const std::size_t next = file.size() + count.size() + entries.size() + kind.word();
        file += count + entries + kind.text(page + 1 < pages ? next : 0, kind.word());
    }
    return file;
}

std::vector<FilePiece> pieces_of_tiff(const std::string& file) {
    return shown_pieces_of_tiff(byte_source(bytes_in(file)), file.size());
}

constexpr TiffKind kTiffKinds[] = {{false, false}, {true, false}, {false, true}, {true, true}};

TEST(ShownPieces, XmpOfATiffIsHidden) {
    const std::string xmp = nested_xmp(200'000);
    const std::string iptc = repeated(std::string("\x1c\x02\x19\0\3abc", 8), 10);
    std::vector<std::uint8_t> expected(16);
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = static_cast<std::uint8_t>(i);
    const TemporaryFolder folder;
    for (const TiffKind& kind : kTiffKinds) {
        const std::string name =
            std::string(kind.is_big_endian ? "big-endian " : "") + (kind.is_big_tiff ? "BigTIFF" : "TIFF");
        EXPECT_TRUE(pieces_of_tiff(tiff(kind, {{305, 2, 2, std::string("a\0", 2)}})).empty()) << name;
        const std::string file = tiff(kind, {{700, kByte, xmp.size(), xmp}, {33723, kLong, iptc.size() / 4, iptc}}, 3);
        const std::string shown = joined(file, pieces_of_tiff(file));
        ASSERT_EQ(shown.size(), file.size()) << name;
        int changes = 0;
        for (std::size_t i = 0; i < file.size(); ++i) changes += shown[i] != file[i] ? 1 : 0;
        EXPECT_EQ(changes, 6) << name << ": the types of two tags on three pages";
        write_text(folder / "a.tif", file);
        EXPECT_EQ(read_image_8bit(bytes_in(file)).pixels, expected) << name;
        EXPECT_EQ(read_image_8bit(folder / "a.tif").pixels, expected) << name;
        EXPECT_EQ(read_layers(folder / "a.tif").parts.size(), 3u) << name;
    }
}

TEST(ShownPieces, StripsThatATiffDoesNotHaveAreAnError) {
    const TiffKind kind;
    std::string file = tiff(kind, {});
    const std::string entry = kind.text(273, 2) + kind.text(kLong, 2) + kind.text(1, 4);
    const std::size_t place = file.find(entry);
    ASSERT_NE(place, std::string::npos);
    EXPECT_EQ(read_image_8bit(bytes_in(file)).pixels.size(), 16u);
    file.replace(place + entry.size(), 4, kind.text(1'000'000'000, 4));
    EXPECT_THROW((void)read_image_8bit(bytes_in(file)), IoError);
}

TEST(ShownPieces, TagsOfATiffClaimNoMoreThanThereIs) {
    const std::string profile(100'000, 'p');
    for (const TiffKind& kind : kTiffKinds) {
        std::vector<TiffTag> tags{{34675, 7, profile.size(), profile}};
        EXPECT_TRUE(pieces_of_tiff(tiff(kind, tags)).empty());
        // One that leads nowhere is not read; the others need not go without.
        std::vector<TiffTag> one_is_broken = tags;
        one_is_broken.push_back({40'000, kByte, 0x7fffffff, {}, 100});
        EXPECT_TRUE(pieces_of_tiff(tiff(kind, one_is_broken)).empty());
        for (unsigned i = 0; i < 50; ++i) tags.push_back({40'000 + i, kByte, profile.size(), {}, 100});
        const std::string file = tiff(kind, tags);
        EXPECT_THROW((void)pieces_of_tiff(file), IoError);
        EXPECT_THROW((void)read_image_info(bytes_in(file)), IoError);
    }
}

TEST(ShownPieces, WhatLeadsToNoDirectoryEndsTheWalk) {
    for (const TiffKind& kind : kTiffKinds) {
        const std::string file = tiff(kind, {});
        for (std::size_t length = 4; length < file.size(); ++length)
            EXPECT_TRUE(pieces_of_tiff(file.substr(0, length)).empty()) << length;
        // The only directory follows itself.
        std::string circle = file;
        const std::size_t place = kind.is_big_tiff ? 8 : 4;
        circle.replace(circle.size() - kind.word(), kind.word(), circle.substr(place, kind.word()));
        EXPECT_TRUE(pieces_of_tiff(circle).empty());
    }
}

}  // namespace

}  // namespace etendue
