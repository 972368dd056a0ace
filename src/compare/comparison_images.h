// The pictures of a comparison's report.
#pragma once

#include "compare/comparison_measures.h"
#include "output/display_image.h"
#include "report/comparison_report.h"

#include <cstdint>
#include <optional>
#include <span>

namespace etendue {

/// Adds the reference, the first finished image of every variant, their `maps` of error and the maps of the z-tests to
/// `images`, and what the maps' colours stand for to `report`.
void add_images(ReportImages& images, ComparisonReport& report, std::span<const FinishedImages> finished,
                const std::optional<Reference>& reference, const ErrorMaps& maps, const DisplayView& view,
                const MeasureContext& context);

/// Says how the image of a strategy is rendered.
struct StrategyPlan {
    std::uint32_t spp = 1;
    double scale = 1.0;  ///< pixels of a side by those of the image that takes the times planned by
};

/// Returns the plan for an image that takes up to `seconds`, if its first sample takes `first_sample` and each other
/// `sample`: of up to 8 samples, or, where not even one fits, of a smaller image, down to a quarter of a side.
[[nodiscard]] StrategyPlan fit_strategies(double seconds, double first_sample, double sample);

/// Renders every strategy of `variant`, which has some, of paths of up to `longest` edges, with and without weights,
/// as small images, which take about a fifth of the CPU time of all renders of `report` or less, by what those of the
/// variant, `renders`, took. Nothing but a note is added where no such path is kept, and nothing at all if it is
/// interrupted; false then.
bool add_strategies(ReportImages& images, ComparisonReport& report, const Variant& variant,
                    const VariantRenders& renders, int longest, const DisplayView& view, const MeasureContext& context,
                    bool quiet);

}  // namespace etendue
