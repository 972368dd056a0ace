#include "report/comparison_files.h"
#include "report/csv.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace etendue {

namespace {

double value_of(const SeedValues& values, std::size_t seed) {
    return seed < values.values.size() ? values.values[seed] : kUnknown;
}

class CsvWriter {
  public:
    explicit CsvWriter(const ComparisonReport& report) : report_(report) {
        text_ = "scene,variant,options,region,render,seed,spp,last,seconds,cpu_seconds,mean_luminance";
        for (const ReportedMetric& metric : report.metrics) add_cell(csv_field(metric.key));
        text_ += "\n";
        for (const VariantReport& variant : report.variants)
            for (std::size_t seed = 0; seed < variant.seeds.size(); ++seed) add_render(variant, seed);
    }

    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    void add_render(const VariantReport& variant, std::size_t seed) {
        for (std::size_t i = 0; i + 1 < variant.convergence.size(); ++i) {
            const ConvergenceStep& step = variant.convergence[i];
            add_row(variant, seed, "", step.spp, false,
                    {value_of(step.seconds, seed), value_of(step.cpu_seconds, seed), kUnknown}, step.errors);
        }
        const double seconds = value_of(variant.seconds, seed);
        const double cpu_seconds = value_of(variant.cpu_seconds, seed);
        add_row(variant, seed, "", variant.spp, true, {seconds, cpu_seconds, kUnknown}, variant.errors);
        for (const RegionReport& region : report_.regions)
            for (const RegionVariant& part : region.variants)
                if (part.name == variant.name)
                    add_row(variant, seed, region.name, variant.spp, true,
                            {seconds, cpu_seconds, value_of(part.luminance, seed)}, part.errors);
    }

    void add_row(const VariantReport& variant, std::size_t seed, const std::string& region, std::uint32_t spp,
                 bool is_last, const std::array<double, 3>& numbers, const ErrorsByMetric& errors) {
        text_ += fmt::format("{},{},{},{},{},{},{},{}", csv_field(report_.scene), csv_field(variant.name),
                             csv_field(variant.options), csv_field(region), seed + 1, variant.seeds[seed], spp,
                             is_last ? 1 : 0);
        for (const double number : numbers) add_cell(csv_number(number));
        for (const ReportedMetric& metric : report_.metrics) {
            const auto error = errors.find(metric.key);
            add_cell(error == errors.end() ? "" : csv_number(value_of(error->second, seed)));
        }
        text_ += "\n";
    }

    void add_cell(const std::string& cell) {
        text_ += ',';
        text_ += cell;
    }

    const ComparisonReport& report_;
    std::string text_;
};

}  // namespace

std::string to_csv(const ComparisonReport& report) {
    return CsvWriter(report).text();
}

}  // namespace etendue
