// What `etendue compare` has measured: variants of rendering one scene, against a reference and against each other.
//
// A plain description, in the order of the report. Numbers that are not known are NaN, and null in JSON.
#pragma once

#include "core/pixel_rect.h"
#include "metrics/block_agreement.h"
#include "report/ratio_interval.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A number of each of several renders that differ in their seeds.
struct SeedValues {
    std::vector<double> values{};

    [[nodiscard]] double mean() const;
    /// Returns the middle one, or the mean of the two in the middle; fireflies of a few do not move it.
    [[nodiscard]] double median() const;
    /// Standard deviation of one of them; unknown of fewer than two.
    [[nodiscard]] double deviation() const;
    [[nodiscard]] double least() const;
    [[nodiscard]] double largest() const;
    /// Returns the logarithm of the mean, with a variance to first order: that of the mean over its square.
    [[nodiscard]] LogEstimate log_mean() const;
};

/// By the key of the metric: "relmse".
using ErrorsByMetric = std::map<std::string, SeedValues>;

/// A metric as the report explains it.
struct ReportedMetric {
    std::string key{};
    std::string name{};
    std::string formula{};  ///< with its constants
};

/// Where all seeds of a variant were looked at.
struct ConvergenceStep {
    std::uint32_t spp = 0;
    SeedValues seconds{};
    SeedValues cpu_seconds{};
    ErrorsByMetric errors{};
};

/// Exponents of the error against samples and times, fitted to its means over the seeds; unknown where no line fits.
struct ConvergenceSlope {
    double spp = kUnknown;
    double seconds = kUnknown;
    double cpu_seconds = kUnknown;
};

struct VariantReport {
    std::string name{};
    std::string options{};               ///< options that make the variant what it is
    std::string command{};               ///< command that renders the variant's first image
    std::string command_note{};          ///< how the render of `command` differs from that image; empty if it does not
    std::vector<std::uint32_t> seeds{};  ///< seeds of the variant's renders, in their order
    std::vector<std::string> cannot_find{};  ///< sentences
    std::uint32_t spp = 0;
    SeedValues seconds{};
    SeedValues cpu_seconds{};
    double samples_per_cpu_second = 0.0;
    std::uint64_t rays = 0;        ///< rays of one render, on average
    double rays_per_second = 0.0;  ///< rays by the time by which variants are compared
    std::array<double, 3> mean{};  ///< R, G, B of all renders
    std::uint64_t dropped_samples = 0;
    ErrorsByMetric errors{};       ///< errors of the last images; empty without a reference
    double variance = kUnknown;    ///< variance of one render, as relative_variance of metrics/ defines it
    double efficiency = kUnknown;  ///< 1 / (variance × time), the time by which variants are compared
    std::vector<ConvergenceStep> convergence{};
    std::map<std::string, ConvergenceSlope> slopes{};  ///< by metric
};

/// Returns why the seeds' errors of `variant` by `metric` have tails too heavy for an interval of their mean, the end
/// of a sentence; empty if they do not. docs/compare.md states the bounds.
[[nodiscard]] std::string heavy_tail(const VariantReport& variant, const std::string& metric);

/// Returns the share of the relMSE of `variant` that trimming leaves out; unknown if either error is.
[[nodiscard]] double trimmed_share(const VariantReport& variant);

/// How long one variant takes to come to another's error.
struct ReachedError {
    double seconds = 0.0;
    bool extrapolated = false;  ///< along the fitted slope, beyond what was rendered
};

struct PairReport {
    std::string a{};
    std::string b{};
    /// Holds a's over b's: metrics, "relmse_time", "relmse-trimmed_time", "rays_per_second", "efficiency".
    std::map<std::string, RatioInterval> ratios{};
    std::map<std::string, std::string> no_interval{};  ///< why a ratio has no interval, by its key in `ratios`
    std::optional<ReachedError> a_reaches_b{};
    std::optional<ReachedError> b_reaches_a{};
    std::string different_light{};  ///< why they show different light by what was asked for; empty if they do not
    bool comparable = true;         ///< they show the same light, and both find all of it
    std::string not_tested{};       ///< why a test says nothing of them, the end of a sentence; empty if it does
    /// Names the variant that is black where the other is not, if this is why they are not tested; else empty.
    std::string black_variant{};
    std::optional<BlockAgreement> agreement{};
    AgreementOptions agreement_options{};

    /// Returns the smallest relative difference of the whole images' means that the test would have seen, and that of
    /// a block of median noise; unknown without a test.
    [[nodiscard]] double smallest_of_image() const;
    [[nodiscard]] double smallest_of_block() const;
    /// Returns the outcome of the test in a word: "agree", "disagree", "not tested", or "no difference seen" if it
    /// would have seen only a large one or could look at the whole image only.
    [[nodiscard]] std::string_view verdict() const;
};

/// A variant that no test of agreement says anything of, and why.
struct UntestedVariant {
    std::string name{};
    std::string why{};
};

/// One variant within a part of the image. Without a reference there are no errors.
struct RegionVariant {
    std::string name{};
    std::array<double, 3> mean{};
    SeedValues luminance{};   ///< mean of the region: of renders alone, so that variants are independent
    SeedValues mean_error{};  ///< error of `luminance` against the reference, relative
    /// Holds the relative standard error of the reference's mean of the region.
    double reference_error = kUnknown;
    ErrorsByMetric errors{};
    double rel_mse_time = kUnknown;  ///< relMSE times the seconds by which variants are compared
};

struct RegionReport {
    std::string name{};
    bool found = false;  ///< by the program, where variants differ most; else named by the user
    PixelRect pixels{};
    std::vector<RegionVariant> variants{};
    double reference_noise = kUnknown;  ///< relMSE of the reference's own noise in the region
};

/// The image of one strategy.
struct StrategyReport {
    int s = 0;
    int t = 0;
    double weighted_mean = 0.0;  ///< luminance
    double unweighted_mean = 0.0;
    double share = 0.0;             ///< share of the luminance of the weighted images of its length, [0, 1]
    double mean_weight = kUnknown;  ///< mean of its weights, by the light that it makes; unknown where it makes none

    [[nodiscard]] int edges() const { return s + t - 1; }
};

/// Paths of one length in the pyramid of strategies.
struct StrategyRow {
    int edges = 0;
    double exposure = 0.0;  ///< stops by which its images are brighter than the others
};

struct StrategiesReport {
    std::string variant{};
    std::uint32_t spp = 0;
    int longest = 0;                           ///< edges
    std::vector<StrategyReport> strategies{};  ///< by length, then by s
    std::vector<StrategyRow> rows{};           ///< by length
};

/// Seeds from `first` on; after the last there is comes 0.
struct SeedRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct ReferenceReport {
    std::string kind{};                       ///< "file", "integrator", "pooled", or "none"
    std::string text{};                       ///< a sentence
    std::map<std::string, double> weights{};  ///< weights of variants in a pooled reference
    double noise_rel_mse = kUnknown;          ///< relMSE of the reference's own noise, which squared errors are without
    double noise_bound = kUnknown;            ///< largest relMSE that the reference's own noise can have, if not known
    SeedRange seeds{};                        ///< seeds that it was pooled from or rendered with; else none
    std::uint32_t spp = 0;                    ///< samples per pixel of all renders, if it was rendered
    double seconds = kUnknown;                ///< seconds of these renders
    double cpu_seconds = kUnknown;

    /// Returns the relMSE that the reference's own noise has, or can have at most. Returns 0 if nothing is known of
    /// this noise, and for a pooled reference, whose noise is much of the errors in any case.
    [[nodiscard]] double noise() const;
    /// Returns whether `noise()` is over a tenth of the relMSE `error`, so that noise decides ratios of such errors.
    [[nodiscard]] bool is_noisy_for(double error) const;
};

/// Holds the values that the first and the last colour of a kind of maps stand for.
struct MapScale {
    double low = 0.0;
    double high = 1.0;
};

struct ComparisonReport {
    std::string program{};
    std::string created{};  ///< ISO 8601, UTC
    std::string command{};
    std::string scene{};
    std::string scene_path{};
    int width = 0;  ///< pixels of the whole image
    int height = 0;
    std::optional<PixelRect> crop{};
    std::string working_space{};
    std::string display{};
    std::string view{};
    std::string look{};  ///< empty for the view's own
    double exposure = 0.0;
    int threads = 0;
    std::string isa{};
    std::map<std::string, std::string> libraries{};
    bool by_wall = false;                ///< variants are compared by time on the clock, else by CPU time
    std::optional<double> seconds{};     ///< seconds of each render by that time, if times are equal
    std::optional<std::uint32_t> spp{};  ///< samples per pixel of each render, if these are equal
    int seeds = 0;
    std::uint32_t first_seed = 0;
    ReferenceReport reference;
    std::vector<ReportedMetric> metrics{};
    std::map<std::string, MapScale> maps{};  ///< by the beginning of their images' keys: "error/relmse", or all of it
    std::vector<std::string> notes{};
    std::vector<VariantReport> variants{};
    std::vector<PairReport> pairs{};
    std::vector<RegionReport> regions{};
    std::optional<StrategiesReport> strategies{};

    /// False if a test says of two comparable variants that their images differ.
    [[nodiscard]] bool agrees() const;
    /// Returns the variants that no test says anything of, in their order.
    [[nodiscard]] std::vector<UntestedVariant> untested() const;
    /// Returns the key of the metric that comes first: relMSE, or the trimmed one where tails leave a ratio of relMSE
    /// without an interval. Returns nothing without a reference.
    [[nodiscard]] std::string leading_metric() const;
    /// Returns the seconds by which variants are compared.
    [[nodiscard]] const SeedValues& time_of(const VariantReport& variant) const {
        return by_wall ? variant.seconds : variant.cpu_seconds;
    }
};

/// Returns which variant is best and by how much, a sentence without its full stop. By errors times the time if times
/// were to be equal and differ by more than a tenth; by efficiency without a reference.
[[nodiscard]] std::string headline(const ComparisonReport& report);

/// docs/compare.md describes it.
[[nodiscard]] std::string to_json(const ComparisonReport& report);

/// PNG files by the keys under which the page looks for them.
using ReportImages = std::map<std::string, std::vector<unsigned char>>;

/// One HTML file that shows the report and needs nothing else.
[[nodiscard]] std::string make_page(const ComparisonReport& report, const ReportImages& images);

}  // namespace etendue
