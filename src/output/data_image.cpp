#include "output/data_image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

using Triple = std::array<float, 3>;

/// Rounding of 16-bit floats takes unit vectors this far beyond 1.
constexpr float kSlack = 2e-3f;

std::size_t count_of_pixels(const ImageF& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// Fills a picture from `of_pixel`, which gets the values of one.
template <typename OfPixel>
ImageF picture_of(const ImageF& image, const OfPixel& of_pixel) {
    ImageF picture(image.width, image.height, 3);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < count_of_pixels(image); ++i) {
        const Triple color = of_pixel(std::span(image.pixels).subspan(i * channels, channels));
        std::copy(color.begin(), color.end(), picture.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return picture;
}

/// The first three of `values`; one for all three, black for a third that is not there.
Triple first_three(std::span<const float> values) {
    if (values.size() == 1) return {values[0], values[0], values[0]};
    return {values[0], values[1], values.size() > 2 ? values[2] : -std::numeric_limits<float>::infinity()};
}

float in_range(float value, const DataRange& range) {
    if (std::isnan(value)) return 0.0f;
    if (value >= kFarAway) return 1.0f;
    if (value <= -kFarAway) return 0.0f;
    // In double precision: the two may be as far apart as no float tells.
    const double extent = static_cast<double>(range.high) - static_cast<double>(range.low);
    if (!(extent > 0.0)) return 0.0f;
    const double share = (static_cast<double>(value) - static_cast<double>(range.low)) / extent;
    return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

/// From the smallest to the largest value of a channel that is not far away; 0 to 1 if there is none.
DataRange range_of(const ImageF& image, std::size_t channel) {
    DataRange range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (std::size_t i = channel; i < image.pixels.size(); i += static_cast<std::size_t>(image.channels)) {
        const float value = image.pixels[i];
        if (!(std::abs(value) < kFarAway)) continue;
        range.low = std::min(range.low, value);
        range.high = std::max(range.high, value);
    }
    return range.low <= range.high ? range : DataRange{};
}

/// A colour that is bright enough to be seen and differs for ids that are near each other.
Triple color_of_id(float id) {
    if (id == 0.0f) return {0.0f, 0.0f, 0.0f};
    // The finaliser of MurmurHash3 (A. Appleby), which is in the public domain.
    std::uint32_t hash = std::bit_cast<std::uint32_t>(id);
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    hash ^= hash >> 16;
    const auto byte = [hash](int shift) { return static_cast<float>((hash >> shift) & 0xffu) / 255.0f; };
    return {0.25f + 0.75f * byte(0), 0.25f + 0.75f * byte(8), 0.25f + 0.75f * byte(16)};
}

Triple color_of_matte(std::span<const float> values) {
    Triple color{};
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
        const Triple id = color_of_id(values[i]);
        const float coverage = std::isfinite(values[i + 1]) ? std::clamp(values[i + 1], 0.0f, 1.0f) : 0.0f;
        for (std::size_t c = 0; c < 3; ++c) color[c] += coverage * id[c];
    }
    return color;
}

DataPicture show_range(const ImageF& image, const std::optional<DataRange>& told) {
    std::array<DataRange, 3> ranges{};
    const std::size_t count = std::min<std::size_t>(static_cast<std::size_t>(image.channels), 3);
    std::string made;
    for (std::size_t c = 0; c < 3; ++c) {
        ranges[c] = told ? *told : c < count ? range_of(image, c) : ranges[0];
        if (c < count && (c == 0 || !told))
            made += fmt::format("{}{:g} to {:g}", c == 0 ? "" : ", ", ranges[c].low, ranges[c].high);
    }
    return {picture_of(image,
                       [&](std::span<const float> values) {
                           Triple color = first_three(values);
                           for (std::size_t c = 0; c < 3; ++c)
                               color[c] = in_range(color[c], ranges[count == 1 ? 0 : c]);
                           return color;
                       }),
            made + " as black to white"};
}

}  // namespace

bool names_ids(std::string_view layer) {
    return layer == "id" || layer == "ID" || layer.ends_with("_id") || layer.ends_with("Id") || layer.ends_with("ID");
}

DataStyle style_of_values(const ImageF& image) {
    if (image.channels < 2) return DataStyle::Range;
    const auto is_signed_unit = [](float value) { return !(std::abs(value) > 1.0f + kSlack); };
    return std::ranges::all_of(image.pixels, is_signed_unit) ? DataStyle::Signed : DataStyle::Range;
}

DataPicture show_data(const ImageF& image, DataStyle style, const std::optional<DataRange>& range) {
    switch (style) {
        case DataStyle::Signed:
            return show_range(image, DataRange{-1.0f, 1.0f});
        case DataStyle::Range:
            return show_range(image, range);
        case DataStyle::Ids:
            return {picture_of(image, [](std::span<const float> values) { return color_of_id(values[0]); }),
                    "a colour for each id"};
        case DataStyle::Mattes:
            break;
    }
    return {picture_of(image, color_of_matte), "a colour for each id, weighed by coverage"};
}

}  // namespace etendue
