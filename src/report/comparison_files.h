// A comparison as papers and other programs take it: a table of numbers, tables in LaTeX, plots.
#pragma once

#include "report/comparison_report.h"
#include "report/plot.h"

#include <string>
#include <vector>

namespace etendue {

/// Comma-separated values with a line of names: one row for each image that was measured, of each render, and for each
/// region of each last image. What is not known is empty. docs/compare.md lists the columns.
[[nodiscard]] std::string to_csv(const ComparisonReport& report);

/// Two tables for LaTeX with its package booktabs: of variants, and of ratios with their intervals.
[[nodiscard]] std::string to_tex(const ComparisonReport& report);

/// A plot, and the stem of its files' names: "relmse-time".
struct NamedPlot {
    std::string name{};
    Plot plot{};
};

/// The errors of each metric over time and over samples, both logarithmic, with the variants' means as lines with
/// marks, their medians as thin ones, the seeds' range as areas, and a line of the slope of independent samples.
/// Nothing of metrics that were not measured on the way, or have no error above 0.
[[nodiscard]] std::vector<NamedPlot> convergence_plots(const ComparisonReport& report);

/// Returns the stems of the names of all plots that there may be.
[[nodiscard]] std::vector<std::string> convergence_plot_names(const std::vector<std::string>& metrics);

}  // namespace etendue
