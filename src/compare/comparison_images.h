// The pictures of a comparison's report.
#pragma once

#include "compare/comparison_measures.h"
#include "output/display_image.h"
#include "report/comparison_report.h"

#include <optional>
#include <span>

namespace etendue {

/// Adds the reference, the first finished image of every variant, their `maps` of error and the maps of the z-tests to
/// `images`, and what the maps' colours stand for to `report`.
void add_images(ReportImages& images, ComparisonReport& report, std::span<const FinishedImages> finished,
                const std::optional<Reference>& reference, const ErrorMaps& maps, const DisplayView& view,
                const MeasureContext& context);

/// Renders every strategy of `variant`, which has some, of paths of up to `longest` edges, with and without weights,
/// as small images. Nothing but a note is added where no such path is kept, and nothing at all if it is interrupted;
/// false then.
bool add_strategies(ReportImages& images, ComparisonReport& report, const Variant& variant, int longest,
                    const DisplayView& view, const MeasureContext& context, bool quiet);

}  // namespace etendue
