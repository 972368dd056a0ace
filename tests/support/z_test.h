// Z-test: do two estimates with known variances agree?
#pragma once

#include <string>

namespace etendue::test {

/// An estimate and the variance of that estimate (of the mean, not of one sample).
struct Estimate {
    double mean = 0.0;
    double variance = 0.0;
};

struct ZTestResult {
    double z = 0.0;
    double p_value = 1.0;  ///< probability of a larger |z| if the two estimate the same value

    [[nodiscard]] std::string str() const;
};

/// Two-sided test of `a` against `b`. Deviations up to `tolerance` (absolute, >= 0) count as none. Without variance p
/// is 1 within the tolerance and 0 beyond it.
[[nodiscard]] ZTestResult z_test(const Estimate& a, const Estimate& b, double tolerance = 0.0);

}  // namespace etendue::test
