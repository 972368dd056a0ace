#include "core/shown_text.h"
#include "report/comparison_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// One column of most papers.
constexpr double kPlotWidth = 252.0;  // points
constexpr double kPlotHeight = 190.0;
constexpr double kFontSize = 8.0;
constexpr PlotColor kInk{};
constexpr PlotColor kMuted{0.36, 0.38, 0.41};
constexpr PlotColor kGrid{0.85, 0.86, 0.87};
constexpr PlotColor kPaper{1.0, 1.0, 1.0};
/// Okabe and Ito's colours for the colour-blind, as the page has them on white.
constexpr std::array<PlotColor, 6> kVariantColors{{{0.0, 0.447, 0.698},
                                                   {0.78, 0.318, 0.0},
                                                   {0.0, 0.502, 0.369},
                                                   {0.659, 0.271, 0.498},
                                                   {0.502, 0.4, 0.0},
                                                   {0.333, 0.357, 0.388}}};
constexpr std::size_t kLongestName = 28;  // bytes of a name in a legend
constexpr double kWidestName = 130.0;     // width of a name in a legend, points

const PlotColor& color_of(std::size_t variant) {
    return kVariantColors[variant % kVariantColors.size()];
}

/// Returns a name, cut if it is too long or too wide for a legend.
std::string legend_name(const std::string& name) {
    std::string shown = name;
    for (std::size_t length = kLongestName; shown.size() > kLongestName || text_width(shown, kFontSize) > kWidestName;
         --length)
        shown = fmt::format("{}...", first_characters(name, length - 3));
    return shown;
}

/// A logarithmic axis from `low` to `high`, logarithms to base 10, to the positions `from` and `to`.
struct LogAxis {
    double low = 0.0;
    double high = 1.0;
    double from = 0.0;
    double to = 1.0;

    [[nodiscard]] double at(double value) const {
        return from + (std::log10(value) - low) / (high - low) * (to - from);
    }
};

LogAxis log_axis(const std::vector<double>& values, double from, double to) {
    const auto [least, most] = std::ranges::minmax(values);
    const double margin = 0.05 * std::max(0.5, std::log10(most / least));
    return {std::log10(least) - margin, std::log10(most) + margin, from, to};
}

struct AxisTick {
    double value;
    bool is_decade;
    std::string label;  ///< empty for none
    std::string raised;
};

/// Ticks at 1 to 9 times each power of ten; where there are few decades, 2 and 5 have labels too.
std::vector<AxisTick> ticks_of(const LogAxis& axis) {
    const int first = static_cast<int>(std::floor(axis.low));
    const int last = static_cast<int>(std::ceil(axis.high));
    const bool is_plain = first >= -3 && last <= 4;
    const bool is_roomy = axis.high - axis.low < 1.7;
    std::vector<AxisTick> ticks;
    for (int exponent = first; exponent <= last; ++exponent)
        for (int digit = 1; digit <= 9; ++digit) {
            const double value = digit * std::pow(10.0, exponent);
            if (std::log10(value) < axis.low || std::log10(value) > axis.high) continue;
            AxisTick& tick = ticks.emplace_back(AxisTick{value, digit == 1, "", ""});
            if (digit != 1 && !(is_roomy && (digit == 2 || digit == 5))) continue;
            if (is_plain) {
                tick.label = fmt::format("{:g}", value);
            } else {
                tick.label = digit == 1 ? "10" : fmt::format("{}·10", digit);
                tick.raised = exponent < 0 ? fmt::format("−{}", -exponent) : fmt::format("{}", exponent);
            }
        }
    return ticks;
}

/// The points of a mark around `at`: variants are told apart without colour.
std::vector<PlotPoint> mark(std::size_t variant, const PlotPoint& at) {
    constexpr double kRadius = 2.2;
    constexpr std::array<std::pair<int, double>, 6> kCorners{
        {{24, 0.0}, {4, 0.5}, {3, 0.5}, {4, 0.0}, {3, 0.0}, {6, 0.0}}};
    const auto& [corners, turn] = kCorners[variant % kCorners.size()];
    std::vector<PlotPoint> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + turn) / corners + 0.5 * std::numbers::pi;
        points.push_back({at.x + kRadius * std::cos(angle), at.y + kRadius * std::sin(angle)});
    }
    return points;
}

struct PlotSeries {
    std::size_t variant;
    std::vector<double> work;
    std::vector<SeedValues> errors;
};

class ConvergencePlot {
  public:
    ConvergencePlot(const ComparisonReport& report, const ReportedMetric& metric, bool over_time) : report_(report) {
        for (std::size_t v = 0; v < report.variants.size(); ++v) {
            PlotSeries series{.variant = v, .work = {}, .errors = {}};
            for (const ConvergenceStep& step : report.variants[v].convergence) {
                const auto found = step.errors.find(metric.key);
                if (found == step.errors.end() || !(found->second.mean() > 0.0)) continue;
                if (!std::isfinite(found->second.mean())) continue;
                const double work = !over_time       ? static_cast<double>(step.spp)
                                    : report.by_wall ? step.seconds.mean()
                                                     : step.cpu_seconds.mean();
                if (!(work > 0.0)) continue;
                series.work.push_back(work);
                series.errors.push_back(found->second);
            }
            if (!series.work.empty()) series_.push_back(std::move(series));
        }
        if (series_.empty()) return;
        plot_ = {.width = kPlotWidth,
                 .height = kPlotHeight,
                 .title = fmt::format("{} of {}", metric.name, report.scene),
                 .parts = {}};
        set_axes();
        draw_axes(over_time ? (report.by_wall ? "time (s)" : "CPU time (s)") : "samples per pixel", metric.name);
        const bool is_squared = metric.key.find("mse") != std::string::npos;
        draw_guide(is_squared ? -1.0 : -0.5);
        draw_key(is_squared ? "−1" : "−½");
        for (const PlotSeries& series : series_) draw_range(series);
        for (const PlotSeries& series : series_) draw_lines(series);
        draw_legend();
    }

    [[nodiscard]] bool is_empty() const { return series_.empty(); }
    [[nodiscard]] Plot take() { return std::move(plot_); }

  private:
    void set_axes() {
        std::vector<double> work;
        std::vector<double> errors;
        for (const PlotSeries& series : series_) {
            work.insert(work.end(), series.work.begin(), series.work.end());
            for (const SeedValues& values : series.errors)
                for (const double error : {values.mean(), values.median(), values.least(), values.largest()})
                    if (error > 0.0 && std::isfinite(error)) errors.push_back(error);
        }
        x_ = log_axis(work, 38.0, kPlotWidth - 6.0);
        y_ = log_axis(errors, kPlotHeight - 30.0, 16.0);
    }

    void draw_line(PlotPoint a, PlotPoint b, const PlotColor& color, double width, std::vector<double> dash = {}) {
        plot_.parts.emplace_back(PlotShape{.points = {a, b}, .stroke = color, .width = width, .dash = std::move(dash)});
    }

    void draw_axes(const std::string& x_title, const std::string& y_title) {
        for (const AxisTick& tick : ticks_of(x_)) {
            const double x = x_.at(tick.value);
            if (tick.is_decade) draw_line({x, y_.to}, {x, y_.from}, kGrid, 0.5);
            draw_line({x, y_.from}, {x, y_.from + (tick.label.empty() ? 1.5 : 3.0)}, kMuted, 0.5);
            if (!tick.label.empty())
                plot_.parts.emplace_back(PlotText{.at = {x, y_.from + 11.0},
                                                  .text = tick.label,
                                                  .raised = tick.raised,
                                                  .anchor = PlotAnchor::Middle,
                                                  .size = kFontSize,
                                                  .color = kMuted});
        }
        for (const AxisTick& tick : ticks_of(y_)) {
            const double y = y_.at(tick.value);
            if (tick.is_decade) draw_line({x_.from, y}, {x_.to, y}, kGrid, 0.5);
            draw_line({x_.from - (tick.label.empty() ? 1.5 : 3.0), y}, {x_.from, y}, kMuted, 0.5);
            if (!tick.label.empty())
                plot_.parts.emplace_back(PlotText{.at = {x_.from - 5.0, y + 0.35 * kFontSize},
                                                  .text = tick.label,
                                                  .raised = tick.raised,
                                                  .anchor = PlotAnchor::End,
                                                  .size = kFontSize,
                                                  .color = kMuted});
        }
        plot_.parts.emplace_back(PlotShape{
            .points = {{x_.from, y_.to}, {x_.from, y_.from}, {x_.to, y_.from}}, .stroke = kInk, .width = 0.8});
        plot_.parts.emplace_back(PlotText{.at = {0.5 * (x_.from + x_.to), kPlotHeight - 5.0},
                                          .text = x_title,
                                          .anchor = PlotAnchor::Middle,
                                          .size = kFontSize,
                                          .color = kInk});
        plot_.parts.emplace_back(PlotText{.at = {3.0, 10.0}, .text = y_title, .size = kFontSize, .color = kInk});
    }

    /// A line of `slope` in logarithms, as far as it lies within the axes, from the first point of the first series.
    void draw_guide(double slope) {
        const double x0 = std::log10(series_.front().work.front());
        const double y0 = std::log10(series_.front().errors.front().mean());
        const auto y_at = [&](double x) { return y0 + slope * (x - x0); };
        const double from = std::max(x_.low, x0 + (y_.high - y0) / slope);
        const double to = std::min(x_.high, x0 + (y_.low - y0) / slope);
        if (!(to > from)) return;
        draw_line({x_.at(std::pow(10.0, from)), y_.at(std::pow(10.0, y_at(from)))},
                  {x_.at(std::pow(10.0, to)), y_.at(std::pow(10.0, y_at(to)))}, kMuted, 0.5, {0.8, 2.4});
    }

    /// Says at the top right what bands, dashes and dots are, with room for fonts that are wider than Helvetica.
    void draw_key(const char* slope) {
        constexpr double kRoom = 16.0;
        const std::size_t seeds = series_.front().errors.front().values.size();
        plot_.parts.emplace_back(PlotText{.at = {x_.to - kRoom, 10.0},
                                          .text = fmt::format("{}{}dots: slope {}", seeds > 1 ? "band: range, " : "",
                                                              seeds > 2 ? "dashes: median, " : "", slope),
                                          .anchor = PlotAnchor::End,
                                          .size = 0.75 * kFontSize,
                                          .color = kMuted});
    }

    void draw_range(const PlotSeries& series) {
        std::vector<PlotPoint> area;
        std::vector<PlotPoint> lower;
        for (std::size_t i = 0; i < series.work.size(); ++i) {
            const double least = series.errors[i].least(), largest = series.errors[i].largest();
            if (!(least > 0.0) || !std::isfinite(largest)) continue;
            area.push_back({x_.at(series.work[i]), y_.at(largest)});
            lower.push_back({x_.at(series.work[i]), y_.at(least)});
        }
        area.insert(area.end(), lower.rbegin(), lower.rend());
        if (lower.size() > 1)
            plot_.parts.emplace_back(PlotShape{
                .points = std::move(area), .is_closed = true, .fill = color_of(series.variant), .fill_opacity = 0.18});
    }

    void draw_lines(const PlotSeries& series) {
        std::vector<PlotPoint> means;
        std::vector<PlotPoint> medians;
        for (std::size_t i = 0; i < series.work.size(); ++i) {
            means.push_back({x_.at(series.work[i]), y_.at(series.errors[i].mean())});
            if (series.errors[i].median() > 0.0)
                medians.push_back({x_.at(series.work[i]), y_.at(series.errors[i].median())});
        }
        const PlotColor& color = color_of(series.variant);
        if (series.errors.front().values.size() > 2)
            plot_.parts.emplace_back(
                PlotShape{.points = std::move(medians), .stroke = color, .width = 0.5, .dash = {2.0, 1.5}});
        plot_.parts.emplace_back(PlotShape{.points = means, .stroke = color, .width = 1.2});
        for (const PlotPoint& point : means) draw_mark(series.variant, point);
    }

    void draw_mark(std::size_t variant, const PlotPoint& at) {
        plot_.parts.emplace_back(PlotShape{
            .points = mark(variant, at), .is_closed = true, .fill = color_of(variant), .stroke = kPaper, .width = 0.4});
    }

    /// Returns how many points of the means lie in the area.
    [[nodiscard]] std::ptrdiff_t points_within(const PlotPoint& least, const PlotPoint& most) const {
        std::ptrdiff_t count = 0;
        for (const PlotSeries& series : series_)
            for (std::size_t i = 0; i < series.work.size(); ++i) {
                const double x = x_.at(series.work[i]), y = y_.at(series.errors[i].mean());
                count += x >= least.x && x <= most.x && y >= least.y && y <= most.y ? 1 : 0;
            }
        return count;
    }

    /// At the top right or the bottom left, which errors that fall leave free.
    void draw_legend() {
        constexpr double kLine = 10.5;
        double widest = 0.0;
        std::vector<std::string> names;
        for (const PlotSeries& series : series_) {
            names.push_back(legend_name(report_.variants[series.variant].name));
            widest = std::max(widest, text_width(names.back(), kFontSize));
        }
        const double width = widest + 19.0;
        const double height = kLine * static_cast<double>(names.size()) + 2.0;
        const bool is_left = points_within({x_.from, y_.from - height}, {x_.from + width, y_.from}) <
                             points_within({x_.to - width, y_.to}, {x_.to, y_.to + height});
        const double left = is_left ? x_.from + 4.0 : x_.to - width + 3.0;
        const double top = is_left ? y_.from - height - 1.0 : y_.to;
        const double right = left + width - 3.0;
        plot_.parts.emplace_back(
            PlotShape{.points = {{left - 3.0, top}, {right, top}, {right, top + height}, {left - 3.0, top + height}},
                      .is_closed = true,
                      .fill = kPaper,
                      .fill_opacity = 0.8});
        for (std::size_t i = 0; i < names.size(); ++i) {
            const double y = top + kLine * (static_cast<double>(i) + 0.75);
            draw_mark(series_[i].variant, {left + 3.0, y - 0.35 * kFontSize});
            plot_.parts.emplace_back(
                PlotText{.at = {left + 10.0, y}, .text = names[i], .size = kFontSize, .color = kInk});
        }
    }

    const ComparisonReport& report_;
    std::vector<PlotSeries> series_;
    LogAxis x_;
    LogAxis y_;
    Plot plot_;
};

constexpr std::array kPlotAxes{"time", "spp"};

std::string plot_name(const std::string& metric, const char* axis) {
    return metric + "-" + axis;
}

}  // namespace

std::vector<std::string> convergence_plot_names(const std::vector<std::string>& metrics) {
    std::vector<std::string> names;
    for (const std::string& metric : metrics)
        for (const char* axis : kPlotAxes) names.push_back(plot_name(metric, axis));
    return names;
}

std::vector<NamedPlot> convergence_plots(const ComparisonReport& report) {
    std::vector<NamedPlot> plots;
    for (const ReportedMetric& metric : report.metrics)
        for (const char* axis : kPlotAxes)
            if (ConvergencePlot plot(report, metric, axis == kPlotAxes.front()); !plot.is_empty())
                plots.push_back({plot_name(metric.key, axis), plot.take()});
    return plots;
}

}  // namespace etendue
