// The report of `etendue diff` on two images.
#pragma once

#include "compare/image_measures.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Holds the most that a measure may be.
struct Limit {
    std::string measure;
    double value = 0.0;
};

/// Describes a map of errors that was written.
struct MapWritten {
    std::string file;
    std::string measure;
    double largest = 0.0;
    std::string scale;  ///< where `largest` comes from
};

/// Holds what was measured.
struct DiffResult {
    std::vector<Measure> measures;
    std::vector<Limit> limits;  ///< their names resolved
    std::optional<MapWritten> map;

    [[nodiscard]] std::optional<double> limit_of(std::string_view measure) const {
        std::optional<double> lowest;
        for (const Limit& limit : limits)
            if (limit.measure == measure && (!lowest || limit.value < *lowest)) lowest = limit.value;
        return lowest;
    }
    /// Written so that what is not a number is too much.
    [[nodiscard]] bool is_too_large(const Measure& measure) const {
        const auto limit = limit_of(measure.name);
        return limit && !(measure.value <= *limit);
    }
};

/// Prints the measures, a line each.
void print_report(const MeasuredPair& pair, const MeasureOptions& options, const DiffResult& result);

/// Prints the measures as JSON, and whether all was within its limits.
void print_json(const MeasuredPair& pair, const MeasureOptions& options, const DiffResult& result, bool passed);

/// Says which pixels of both images are not finite, if any are.
void log_faults(const MeasuredPair& pair);

}  // namespace etendue
