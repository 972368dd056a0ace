#include "core/shown_text.h"
#include "report/comparison_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Writes text as LaTeX reads it; what pdfLaTeX has no letter for stays, for LuaLaTeX.
std::string tex_text(const std::string& text) {
    std::string result;
    for (const char c : shown_text(text)) {
        switch (c) {
            case '\\':
                result += "\\textbackslash{}";
                break;
            case '~':
                result += "\\textasciitilde{}";
                break;
            case '^':
                result += "\\textasciicircum{}";
                break;
            case '<':
                result += "\\textless{}";
                break;
            case '>':
                result += "\\textgreater{}";
                break;
            case '|':
                result += "\\textbar{}";
                break;
            case '"':
                result += "\\char34{}";
                break;
            // At the beginning of a row they would belong to the end of the row before.
            case '[':
            case ']':
            case '*':
                result += fmt::format("{{{}}}", c);
                break;
            case '#':
            case '$':
            case '%':
            case '&':
            case '_':
            case '{':
            case '}':
                result += fmt::format("\\{}", c);
                break;
            default:
                result += c;
        }
    }
    return result;
}

/// So many significant digits, with a power of ten where there would be many zeros, for formulas.
std::string tex_formula(double value, int digits) {
    if (!std::isfinite(value)) return "\\mbox{--}";
    if (value == 0.0) return "0";
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-12));
    if (exponent >= -3 && exponent < 5) return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
    return fmt::format("{:.{}f} \\times 10^{{{}}}", value / std::pow(10.0, exponent), digits - 1, exponent);
}

std::string tex_number(double value) {
    constexpr int kDigits = 3;
    return std::isfinite(value) ? fmt::format("${}$", tex_formula(value, kDigits)) : "--";
}

/// Returns the mark of a ratio without an interval: one for each reason.
std::string tex_mark(std::size_t reason) {
    constexpr std::array kMarks{"\\dagger", "\\ddagger", "\\S", "\\P"};
    std::string mark;
    for (std::size_t i = 0; i <= reason / kMarks.size(); ++i) mark += kMarks.at(reason % kMarks.size());
    return fmt::format("$^{{{}}}$", mark);
}

/// "p = 0.42"; a probability that would be rounded to 1 is "p > 0.99".
std::string tex_probability(double p) {
    constexpr double kNearlyOne = 0.99;
    return p > kNearlyOne ? "$p > 0.99$" : fmt::format("$p = {}$", tex_formula(p, 2));
}

std::string tex_interval(const RatioInterval& interval) {
    if (!std::isfinite(interval.low)) return tex_number(interval.ratio);
    return fmt::format("{} [{}, {}]", tex_number(interval.ratio), tex_number(interval.low), tex_number(interval.high));
}

/// Returns a table for LaTeX. `columns` has LaTeX's letter for the alignment of each column, and `below` has the rows
/// under the last line.
std::string tex_table(const std::string& columns, const std::vector<std::vector<std::string>>& rows,
                      const std::string& below = "") {
    std::string text = fmt::format("\\begin{{tabular}}{{{}}}\n\\toprule\n", columns);
    for (std::size_t i = 0; i < rows.size(); ++i)
        text += fmt::format("{} \\\\\n{}", fmt::join(rows[i], " & "), i == 0 ? "\\midrule\n" : "");
    return text + "\\bottomrule\n" + below + "\\end{tabular}\n";
}

std::vector<std::vector<std::string>> variant_rows(const ComparisonReport& report) {
    std::vector<std::vector<std::string>> rows{{"Variant", "spp", "time (s)", "CPU time (s)"}};
    for (const ReportedMetric& metric : report.metrics) rows.front().push_back(tex_text(metric.name));
    const bool has_errors = !report.metrics.empty();
    const std::string lead = report.leading_metric();
    const char* const slope_head = lead == "relmse" ? "slope of relMSE" : "slope of trimmed relMSE";
    for (const char* head : has_errors ? std::array{"median relMSE", slope_head} : std::array{"variance", "efficiency"})
        rows.front().emplace_back(head);
    for (const VariantReport& variant : report.variants) {
        std::vector<std::string> row{tex_text(variant.name), fmt::format("{}", variant.spp),
                                     tex_number(variant.seconds.mean()), tex_number(variant.cpu_seconds.mean())};
        for (const ReportedMetric& metric : report.metrics) {
            const auto error = variant.errors.find(metric.key);
            const SeedValues values = error == variant.errors.end() ? SeedValues{} : error->second;
            row.push_back(std::isfinite(values.deviation())
                              ? fmt::format("{} $\\pm$ {}", tex_number(values.mean()), tex_number(values.deviation()))
                              : tex_number(values.mean()));
        }
        if (has_errors) {
            const auto error = variant.errors.find("relmse");
            row.push_back(error == variant.errors.end() ? "--" : tex_number(error->second.median()));
            const auto slope = variant.slopes.find(lead);
            row.push_back(slope == variant.slopes.end() ? "--" : tex_number(slope->second.spp));
        } else {
            row.insert(row.end(), {tex_number(variant.variance), tex_number(variant.efficiency)});
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

using KeysAndHeads = std::vector<std::pair<std::string, std::string>>;

/// Returns the ratios to show. With a reference, they are of errors, and of errors times time; trimmed errors come
/// first if others have no interval. Without a reference, they are of rays per second and of efficiency.
KeysAndHeads shown_ratios(const ComparisonReport& report) {
    if (report.metrics.empty()) return {{"rays_per_second", "rays per second"}, {"efficiency", "efficiency"}};
    KeysAndHeads shown{{"relmse", "relMSE"},
                       {"relmse-trimmed", "trimmed"},
                       {"relmse_time", "relMSE $\\times$ time"},
                       {"relmse-trimmed_time", "trimmed $\\times$ time"}};
    if (std::ranges::any_of(report.pairs, [](const PairReport& pair) {
            return pair.no_interval.contains("relmse") && !pair.no_interval.contains("relmse-trimmed");
        }))
        // Clang 14 cannot compile libstdc++'s std::ranges::subrange, which std::ranges::stable_partition returns.
        std::stable_partition(shown.begin(), shown.end(),
                              [](const auto& ratio) { return ratio.first.starts_with("relmse-trimmed"); });
    return shown;
}

/// Returns the reasons why ratios have no interval, in the order in which they come up.
std::vector<std::string> reasons_of(const ComparisonReport& report) {
    std::vector<std::string> reasons;
    for (const PairReport& pair : report.pairs)
        for (const auto& [key, head] : shown_ratios(report))
            if (const auto why = pair.no_interval.find(key);
                why != pair.no_interval.end() && std::ranges::find(reasons, why->second) == reasons.end())
                reasons.push_back(why->second);
    return reasons;
}

/// Returns the rows that say why ratios have no interval.
std::string reason_rows(const std::vector<std::string>& reasons, std::size_t columns) {
    std::string text;
    for (std::size_t i = 0; i < reasons.size(); ++i)
        text += fmt::format("\\multicolumn{{{}}}{{l}}{{{} no interval: {}}} \\\\\n", columns, tex_mark(i),
                            tex_text(reasons[i]));
    return text;
}

/// Returns a pair's ratio with its interval, or with the mark of the reason why it has none.
std::string tex_ratio(const PairReport& pair, const std::string& key, const std::vector<std::string>& reasons) {
    const auto ratio = pair.ratios.find(key);
    if (ratio == pair.ratios.end()) return "--";
    const auto why = pair.no_interval.find(key);
    if (why == pair.no_interval.end()) return tex_interval(ratio->second);
    const auto place = std::ranges::find(reasons, why->second) - reasons.begin();
    return tex_interval(ratio->second) + tex_mark(static_cast<std::size_t>(place));
}

std::vector<std::vector<std::string>> pair_rows(const ComparisonReport& report) {
    const KeysAndHeads shown = shown_ratios(report);
    const std::vector<std::string> reasons = reasons_of(report);
    std::vector<std::vector<std::string>> rows{{"$a$ / $b$"}};
    for (const auto& [key, head] : shown) rows.front().push_back(head);
    rows.front().emplace_back("agree");
    for (const PairReport& pair : report.pairs) {
        std::vector<std::string> row{fmt::format("{} / {}", tex_text(pair.a), tex_text(pair.b))};
        for (const auto& [key, head] : shown) row.push_back(tex_ratio(pair, key, reasons));
        row.push_back(!pair.not_tested.empty() || !pair.agreement
                          ? "not tested"
                          : fmt::format("{}, {}, $\\geq {}\\,\\%$", pair.verdict(),
                                        tex_probability(pair.agreement->p_value),
                                        tex_formula(100.0 * pair.smallest_of_image(), 2)));
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string columns_of(const std::vector<std::vector<std::string>>& rows) {
    std::string columns(rows.front().size(), 'r');
    columns.front() = 'l';
    return columns;
}

}  // namespace

std::string to_tex(const ComparisonReport& report) {
    const auto variants = variant_rows(report);
    std::string text = fmt::format(
        "% {}\n% {}\n% \\input{{tables}} shows both tables; each by itself may be copied into a table of its own. "
        "With\n"
        "% \\usepackage{{booktabs}} in the preamble, their lines are those of that package.\n"
        "\\providecommand{{\\toprule}}{{\\hline}}\n\\providecommand{{\\midrule}}{{\\hline}}\n"
        "\\providecommand{{\\bottomrule}}{{\\hline}}\n\n% {}\n{}",
        report.program, shown_text(report.command),
        report.seeds > 1 ? fmt::format("Means and standard deviations over {} seeds.", report.seeds)
                         : "A single seed does not show its noise.",
        tex_table(columns_of(variants), variants));
    if (report.pairs.empty()) return text;
    const auto pairs = pair_rows(report);
    return text + fmt::format(
                      "\n% Ratios, with {:g}% confidence intervals where they are known. The percentage behind p is "
                      "the smallest\n"
                      "% difference of whole images that the test sees with a probability of {:g}. Time is\n"
                      "% {}.\n{}",
                      100.0 * kRatioConfidence, kPower, report.by_wall ? "that on the clock" : "CPU time",
                      tex_table(columns_of(pairs), pairs, reason_rows(reasons_of(report), pairs.front().size())));
}

}  // namespace etendue
