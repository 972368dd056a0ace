#include "image/radiance_header.h"

#include "core/error.h"
#include "core/xyz.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::string_view kRgbFormat = "32-bit_rle_rgbe";
constexpr std::string_view kXyzFormat = "32-bit_rle_xyze";

std::string_view trimmed(std::string_view text) {
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// Takes what stands before the next blank off `text`.
std::string_view take_word(std::string_view& text) {
    text = trimmed(text);
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    return word;
}

/// Takes the next line, without its end, off `text`; nothing if there is no end.
std::optional<std::string_view> take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    return line;
}

float positive_number(std::string_view text, std::string_view what) {
    float value = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= std::numeric_limits<float>::min()) ||
        !std::isfinite(value))
        throw IoError(fmt::format("its header's {} is not a number above 0", what));
    return value;
}

/// Takes "-Y 8" or another such pair off `text`: the axis with its sign, and the number of pixels.
std::pair<std::string_view, int> take_axis(std::string_view& text) {
    const std::string_view axis = take_word(text);
    const std::string_view number = take_word(text);
    int count = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), count);
    const bool is_axis = axis.size() == 2 && (axis[0] == '+' || axis[0] == '-') && (axis[1] == 'X' || axis[1] == 'Y');
    if (!is_axis || error != std::errc() || end != number.data() + number.size() || count <= 0)
        throw IoError("its header does not end with its size, as in '-Y 512 +X 1024'");
    return {axis, count};
}

void read_size(std::string_view line, RadianceHeader& header) {
    const auto [slow, rows] = take_axis(line);
    const auto [fast, columns] = take_axis(line);
    if (slow[1] == fast[1]) throw IoError("its header gives the size along one axis twice");
    header.by_columns = slow[1] == 'X';
    const std::string_view x = header.by_columns ? slow : fast;
    const std::string_view y = header.by_columns ? fast : slow;
    header.width = header.by_columns ? rows : columns;
    header.height = header.by_columns ? columns : rows;
    header.from_right = x[0] == '-';
    header.from_bottom = y[0] == '+';
}

void read_variable(std::string_view line, RadianceHeader& header) {
    const std::size_t equals = line.find('=');
    if (line.starts_with('#') || equals == std::string_view::npos) return;
    const std::string_view name = trimmed(line.substr(0, equals));
    std::string_view value = trimmed(line.substr(equals + 1));
    if (name == "FORMAT") {
        if (value != kRgbFormat && value != kXyzFormat)
            throw IoError(fmt::format("its header's FORMAT is neither {} nor {}", kRgbFormat, kXyzFormat));
        header.is_xyz = value == kXyzFormat;
    } else if (name == "EXPOSURE") {
        header.exposure *= positive_number(value, name);
    } else if (name == "COLORCORR") {
        Rgb factor;
        for (float* const channel : {&factor.r, &factor.g, &factor.b})
            *channel = positive_number(take_word(value), name);
        header.exposure *= factor;
    }
}

}  // namespace

RadianceHeader parse_radiance_header(std::span<const std::byte> file) {
    const std::string_view all(reinterpret_cast<const char*>(file.data()), std::min(file.size(), kMostRadianceHeader));
    std::string_view text = all;
    RadianceHeader header;
    const auto next_line = [&] {
        const std::optional<std::string_view> line = take_line(text);
        if (!line) throw IoError("its header has no end");
        return *line;
    };
    // OpenImageIO looks for FORMAT in the first 100 lines, of less than 128 bytes each; these limits leave room.
    constexpr std::size_t kLongestLine = 100, kMostLines = 50;
    std::size_t lines = 0;
    bool is_short = true;
    for (std::string_view line = next_line(); !trimmed(line).empty(); line = next_line()) {
        read_variable(line, header);
        is_short = is_short && line.size() <= kLongestLine && ++lines <= kMostLines;
    }
    for (const float factor : {header.exposure.r, header.exposure.g, header.exposure.b})
        if (!(factor > 0.0f) || !std::isfinite(factor)) throw IoError("its header's exposures multiply to no number");
    read_size(next_line(), header);
    header.size = all.size() - text.size();
    const std::string_view read = all.substr(0, header.size);
    header.is_plain = is_short && !header.by_columns && !header.from_bottom && !header.from_right && !header.is_xyz &&
                      header.exposure == Rgb(1.0f) && read.find('\r') == std::string_view::npos &&
                      read.find(fmt::format("\nFORMAT={}\n", kRgbFormat)) != std::string_view::npos;
    return header;
}

std::string plain_radiance_header(const RadianceHeader& header) {
    const auto [rows, columns] =
        header.by_columns ? std::pair(header.width, header.height) : std::pair(header.height, header.width);
    return fmt::format("#?RADIANCE\nFORMAT={}\n\n-Y {} +X {}\n", kRgbFormat, rows, columns);
}

ImageF developed(ImageF scanlines, const RadianceHeader& header) {
    ImageF picture(header.width, header.height, scanlines.channels);
    for (int y = 0; y < header.height; ++y)
        for (int x = 0; x < header.width; ++x) {
            const int column = header.from_right ? header.width - 1 - x : x;
            const int row = header.from_bottom ? header.height - 1 - y : y;
            const auto from = header.by_columns ? scanlines.pixel(row, column) : scanlines.pixel(column, row);
            const std::span<float> to = picture.pixel(x, y);
            if (to.size() < 3) {
                std::ranges::copy(from, to.begin());
                continue;
            }
            const float value[3] = {from[0] / header.exposure.r, from[1] / header.exposure.g,
                                    from[2] / header.exposure.b};
            for (std::size_t c = 0; c < 3; ++c) {
                const auto& matrix = kXyzToRec709[c];
                to[c] = header.is_xyz
                            ? static_cast<float>(matrix[0] * value[0] + matrix[1] * value[1] + matrix[2] * value[2])
                            : value[c];
            }
        }
    return picture;
}

}  // namespace etendue
