// The one chi-squared harness: is a sampler's output distributed as the density that it states?
//
// The domain is cut into cells of about equal probability by splitting a pilot run at its medians, so that a narrow
// lobe gets narrow cells; cells do not depend on the samples that are tested, which come from another seed. The
// expected mass of every cell is the density integrated adaptively. Samples that the sampler rejects, or that belong to
// a delta, form one more cell, whose expected mass is what the density leaves over: so the density is tested as it is,
// without normalising.
//
// A table of n tests with a false-positive rate of `kFamilyLevel` for the whole table uses `sidak_level(kFamilyLevel,
// n)` for each. Seeds are fixed: a test that passes goes on passing until code or seed change.
//
// To add a distribution: on the unit square or another rectangle use `check_rect_sampler`, for directions
// `check_sphere_sampler`, for choices among n `chi2_counts`.
#pragma once

#include "core/vec.h"
#include "support/integrate.h"
#include "support/random.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace etendue::test {

/// Probability that a whole table of tests fails although all is right.
inline constexpr double kFamilyLevel = 0.01;

/// Significance level of each of `tests` independent tests when all together have `family_level` (Sidak 1967):
/// 1 - (1 - family_level)^(1/tests).
[[nodiscard]] double sidak_level(double family_level, std::size_t tests);

struct Chi2Result {
    double statistic = 0.0;
    std::size_t degrees_of_freedom = 0;
    double p_value = 1.0;    ///< probability of a larger statistic if the distribution is the stated one
    std::string histograms;  ///< observed and expected counts, cell by cell, for the failure message

    [[nodiscard]] std::string str() const;
};

/// Pearson's test of `observed` against `expected` counts, both of the same length. Cells with fewer than 5 expected
/// are pooled. Observing anything where all pooled cells together expect nothing gives p = 0. `labels` may be empty.
[[nodiscard]] Chi2Result chi2_counts(std::span<const double> observed, std::span<const double> expected,
                                     std::span<const std::string> labels = {});

struct SamplerOptions {
    std::size_t samples = 40'000;
    std::size_t pilot_samples = 4096;
    std::uint32_t seed = 1;
    int cells_log2 = 6;       ///< 2^n cells
    double tolerance = 2e-6;  ///< largest error of the integral over one of some thousand pieces
    int least_levels = 0;     ///< how often pieces are quartered in any case: more where the density jumps
};

struct SamplerCheck {
    Chi2Result chi2;
    double pdf_integral = 0.0;  ///< integral of the stated density over the domain
    double hit_share = 0.0;     ///< share of samples that were neither rejected nor a delta
    double hit_error = 0.0;     ///< standard error of `hit_share`
};

struct Point {
    double x = 0.0;
    double y = 0.0;
};

using PointSampler = std::function<std::optional<Point>(Random&)>;
using PointDensity = std::function<double(double x, double y)>;
using DirectionSampler = std::function<std::optional<Vec3f>(Random&)>;
using DirectionDensity = std::function<double(const Vec3f&)>;

/// `density` is per unit area of `domain`. The sampler returns nothing for a rejected sample.
[[nodiscard]] SamplerCheck check_rect_sampler(const Rect& domain, const PointSampler& sampler,
                                              const PointDensity& density, const SamplerOptions& options = {});

/// `density` is per solid angle. Cells are rectangles of cosine and azimuth around the y axis, so that lobes in the x-z
/// plane, at the normal or at grazing angles, keep clear of the poles, where floats resolve the cosine badly; the plane
/// z = 0, where lobes end, is a border of cells.
[[nodiscard]] SamplerCheck check_sphere_sampler(const DirectionSampler& sampler, const DirectionDensity& density,
                                                const SamplerOptions& options = {});

/// The integral over the sphere of any function of direction, over cells that follow the points of `guide` (a sampler
/// whose density is large where `f` is).
[[nodiscard]] double integrate_sphere(const DirectionSampler& guide, const DirectionDensity& f,
                                      const SamplerOptions& options = {});

}  // namespace etendue::test
