// Pictures of numbers that are no colours: normals, depths, ids.
#pragma once

#include "image/image.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace etendue {

enum class DataStyle {
    Signed,  ///< -1 is black, 0 is grey and 1 is white: directions
    Range,   ///< the smallest value is black and the largest white: depths, positions
    Ids,     ///< a colour for each value, black for 0
    Mattes,  ///< Cryptomatte: channels in pairs of id and coverage, colours of ids weighed by coverage
};

/// Values that a picture shows as black and as white.
struct DataRange {
    float low = 0.0f;
    float high = 1.0f;
};

struct DataPicture {
    ImageF pixels;     ///< three channels in [0, 1], as they are to be stood in a PNG: no curve is to follow
    std::string made;  ///< how, in words
};

/// Values from here on stand for "nothing was hit" in depths, and are no part of a range.
inline constexpr float kFarAway = 1e10f;

/// Returns true for a layer whose name says that it holds ids: "id", or one that ends in "_id", "Id" or "ID".
[[nodiscard]] bool names_ids(std::string_view layer);

/// `Signed` for several channels that are all from -1 to 1, else `Range`.
[[nodiscard]] DataStyle style_of_values(const ImageF& image);

/// One channel is shown as grey, two as red and green, three as red, green and blue; of four (`Mattes`) all count.
/// `range` is that of `Range`, for all channels; without it, each has its own. What is no number is black, what is far
/// away white.
[[nodiscard]] DataPicture show_data(const ImageF& image, DataStyle style, const std::optional<DataRange>& range = {});

}  // namespace etendue
