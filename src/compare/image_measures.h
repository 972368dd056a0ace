// The measures that `etendue diff` takes of a pair of images, by their names on the command line.
#pragma once

#include "color/color_config.h"
#include "compare/image_pair.h"
#include "core/parallel.h"
#include "metrics/flip.h"
#include "metrics/not_finite.h"
#include "metrics/pixel_selection.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// All names: those of metrics/error_metrics.h, "ldr-flip", "hdr-flip", and "flip" for the one of the two that fits.
[[nodiscard]] std::vector<std::string> measure_names();
/// Returns the names of the measures that are taken if none is named.
[[nodiscard]] std::vector<std::string> default_measures();
/// `name` with "flip" made "ldr-flip" for images encoded for a display, else "hdr-flip".
[[nodiscard]] std::string resolve_measure(std::string_view name, bool is_encoded);

struct MeasureOptions {
    HdrFlipOptions flip{};              ///< LDR-FLIP takes its pixels per degree
    std::optional<PixelRect> region{};  ///< part of `MeasuredPair::pair.window`, in the full image's coordinates
};

struct Measure {
    std::string name;
    double value = 0.0;                        ///< NaN if no pixel is left to measure
    std::string description;                   ///< the formula and its constants
    std::optional<ExposureRange> exposures{};  ///< exposures of hdr-flip
};

/// A pair, and what of it is not finite and was therefore set to black in both and left out of every measure.
class MeasuredPair {
  public:
    /// `pair.window` and `options.region` must have pixels, the latter inside the former.
    MeasuredPair(ImagePair pair, const MeasureOptions& options);

    [[nodiscard]] const ImagePair& pair() const { return pair_; }
    [[nodiscard]] const NotFinite& not_finite_in_image() const { return image_faults_; }
    [[nodiscard]] const NotFinite& not_finite_in_reference() const { return reference_faults_; }
    /// Pixels that were measured.
    [[nodiscard]] std::size_t pixel_count() const;
    /// Pixels of the region that were left out.
    [[nodiscard]] std::size_t left_out_count() const;
    /// Selects, among the pixels of the window, those of the region that were not left out.
    [[nodiscard]] PixelSelection selection() const;

    /// Takes the measures in `names`, which are resolved, and keeps the map of the first: one channel, of the whole
    /// window.
    [[nodiscard]] std::vector<Measure> measure(const std::vector<std::string>& names, const ColorConfig& colors,
                                               const ThreadPool& threads);
    [[nodiscard]] const ImageF& map() const { return map_; }

  private:
    ImagePair pair_;
    MeasureOptions options_;
    NotFinite image_faults_;
    NotFinite reference_faults_;
    std::vector<std::uint8_t> left_out_;
    ImageF map_;
};

}  // namespace etendue
