// FLIP: how large the difference between two images looks when they are shown in turn at the same place.
//
// LDR-FLIP is Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images" (PACMCGIT 3(2)): images are
// filtered as the eye filters them at a viewing distance, colours are compared in a perceptual space, and differences
// at edges and points weigh more. HDR-FLIP is Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range
// Images" (Eurographics short papers): the largest LDR-FLIP error over a range of exposures. Constants are the papers';
// the matrices between RGB and XYZ are those of the authors' own program.
//
// All images are linear Rec.709 with D65 white and 3 or 4 channels, the fourth of which is not looked at. What cannot
// be shown is taken as what comes nearest: black for what is below zero and for NaN, white for infinity. Results do not
// depend on the number of threads.
#pragma once

#include "core/parallel.h"
#include "image/image.h"

#include <optional>
#include <string>
#include <string_view>

namespace etendue {

/// Pixels per degree of the visual angle on a monitor of 3840 pixels and 0.7 m width seen from 0.7 m: 67.02.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840.0 / 0.7) * 3.14159265358979323846 / 180.0;

/// Beyond these, filters are narrower than a pixel or wider than what anyone looks at.
inline constexpr double kLeastPixelsPerDegree = 1.0;
inline constexpr double kMostPixelsPerDegree = 1000.0;

/// Per pixel in [0, 1], one channel: 0 where no difference is seen. `image` and `reference` hold what the display
/// shows, in [0, 1]; what is above is clamped. Exchanging them changes nothing. `pixels_per_degree` lies in
/// [kLeastPixelsPerDegree, kMostPixelsPerDegree]. Throws std::invalid_argument if shapes differ, or channels are fewer
/// than 3.
[[nodiscard]] ImageF ldr_flip(const ImageF& image, const ImageF& reference, double pixels_per_degree,
                              const ThreadPool& threads);

/// The exposures that HDR-FLIP looks at both images with, in stops.
struct ExposureRange {
    float start = 0.0f;
    float stop = 0.0f;
    int count = 2;  ///< evenly spaced, both ends included

    [[nodiscard]] float exposure(int index) const {
        return start + (stop - start) * static_cast<float>(index) / static_cast<float>(count - 1);
    }
};

/// From `start` to `stop` >= start in steps of at most one stop or little more: max(2, ceil(stop - start)) exposures
/// (2021).
[[nodiscard]] ExposureRange exposure_range(float start, float stop);

/// The range for `reference` (2021, section 2.1): from the exposure that shows the largest luminance as 0.85 to the one
/// that shows the median luminance so. The paper does not say what to do where more than half of the image is black;
/// then the median of what is not black is taken, and for an image that is black everywhere exposure 0.
[[nodiscard]] ExposureRange exposures_for(const ImageF& reference);

struct HdrFlip {
    ImageF map;  ///< per pixel in [0, 1], one channel
    ExposureRange exposures;
};

struct HdrFlipOptions {
    double pixels_per_degree = kFlipPixelsPerDegree;
    std::optional<float> start_exposure{};  ///< stops; chosen by `exposures_for` if unset
    std::optional<float> stop_exposure{};   ///< stops; chosen by `exposures_for` if unset
};

/// The tone mapper between exposure and display: ACES as fitted by K. Narkowicz 2015, with the exposure of 0.6 that the
/// fit is usually used with undone, per channel.
inline constexpr std::string_view kFlipToneMapper = "ACES (Narkowicz 2015)";

/// Scene-linear images. Throws std::invalid_argument as `ldr_flip` does, and if the exposures start above where they
/// stop.
[[nodiscard]] HdrFlip hdr_flip(const ImageF& image, const ImageF& reference, const HdrFlipOptions& options,
                               const ThreadPool& threads);

/// Describes LDR-FLIP and its constants for a report.
[[nodiscard]] std::string describe_ldr_flip(double pixels_per_degree);
/// Describes HDR-FLIP, its constants and its exposures for a report.
[[nodiscard]] std::string describe_hdr_flip(double pixels_per_degree, const ExposureRange& exposures);

}  // namespace etendue
