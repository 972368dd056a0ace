// From the images of a comparison to what is reported of them.
#pragma once

#include "color/color_config.h"
#include "compare/comparison_reference.h"
#include "metrics/flip.h"
#include "report/comparison_report.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Names the errors from which the reference's noise is taken off where this noise is known.
inline constexpr std::array kErrorsWithoutNoise{"relmse", "relmse-trimmed", "mse"};

/// Holds what all measures need: colours, threads and the images that were kept.
struct MeasureContext {
    const ColorConfig& colors;
    const ThreadPool& threads;
    const ImageStore& store;
};

/// How the first image of every variant differs from the reference, pixel by pixel: one channel each.
struct ErrorMaps {
    std::vector<ImageF> rel_mse{};
    std::vector<ImageF> flip{};  ///< HDR-FLIP
    ExposureRange exposures{};   ///< that all images are looked at with: those of the reference
};

[[nodiscard]] ErrorMaps map_errors(std::span<const FinishedImages> images, const Reference& reference,
                                   const std::string& working_space, const MeasureContext& context);

/// Returns the luminance of each pixel of `image`, whose first channels are R, G and B.
[[nodiscard]] ImageF luminances(const ImageF& image, const Rgb& weights);

/// Makes the squared errors unknown of whose mean over the seeds the reference's noise, taken off, has left nothing.
void drop_drowned(ErrorsByMetric& errors);

/// A part of the image to look at, in the full image's coordinates.
struct NamedRegion {
    std::string name;
    PixelRect pixels;
    bool found = false;
};

/// Sets the largest values of `map`, 0.1% of its pixels, to 0.
void trim(ImageF& map);

/// Returns the blocks, of a sixth of the shorter side, that may be looked at, in the full image's coordinates; no two
/// overlap.
[[nodiscard]] std::vector<PixelRect> whole_blocks(const PixelRect& window);

/// The blocks of the image whose errors, of which each variant has a map, differ most between two of the variants; at
/// most three. The largest 0.1% of each map do not count. Blocks with an error that is not finite
/// have no place among them.
[[nodiscard]] std::vector<NamedRegion> find_regions(std::span<const ImageF> maps, const PixelRect& window);

/// Fills `report.variants`, `metrics`, `pairs`' ratios and `regions`; errors where there is a reference, of which
/// `maps` are then.
void measure(ComparisonReport& report, std::span<const Variant> variants, std::span<const VariantRenders> renders,
             std::span<const FinishedImages> images, const std::optional<Reference>& reference, const ErrorMaps& maps,
             std::span<const NamedRegion> regions, const MeasureContext& context);

}  // namespace etendue
