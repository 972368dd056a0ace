// The exposure of the PNG where nobody asks for one.
#pragma once

#include "image/image.h"
#include "output/output_frame.h"

#include <string>

namespace etendue {

/// Luminance that 95% of the pixels are to stay below, and that the brightest 5% are to reach: between the two, an
/// image is left as it is.
inline constexpr float kHighlight = 1.5f;
inline constexpr float kDimHighlight = 0.4f;
/// Tells lamps from highlights: a lamp is brighter than this many times the luminance that 75% of the pixels stay
/// below, and than `kHighlight`.
inline constexpr float kLamp = 16.0f;
/// Luminance that half of the pixels are to reach, for which an image is brightened by up to `kMostRaise` stops more.
inline constexpr float kDimMedian = 0.03f;
inline constexpr float kMostRaise = 3.0f;

/// Holds an exposure with the reason why it was chosen.
struct ChosenExposure {
    float stops = 0.0f;
    std::string reason;
};

/// Chooses the exposure nearest to 0, in hundredths of a stop and within 20 stops, that brings the luminance of the
/// pixels of `image`, which has three channels or more, to where the constants above have it. Pixels that are black or
/// not finite do not count; luminance has the weights of Rec. 709.
[[nodiscard]] ChosenExposure choose_exposure(const ImageF& image);

/// Gives `frame` the exposure that its pixels ask for, unless it has one.
void choose_missing_exposure(OutputFrame& frame);

}  // namespace etendue
