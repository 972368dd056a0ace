// Student's t-test: is the mean of independent samples the expected one?
#pragma once

#include <span>
#include <string>

namespace etendue::test {

struct TTestResult {
    double mean = 0.0;
    double standard_error = 0.0;  ///< standard error of the mean
    double t = 0.0;
    double p_value = 1.0;  ///< probability of a larger |t| if the mean is the expected one

    [[nodiscard]] std::string str() const;
};

/// Two-sided test of at least two `samples`, whose mean should be `expected`. Deviations up to `tolerance` (absolute,
/// >= 0) count as none: what rounding or a closed form's own error explains. Samples without variance give p = 1 within
/// the tolerance and 0 beyond it.
[[nodiscard]] TTestResult t_test(std::span<const double> samples, double expected, double tolerance = 0.0);

}  // namespace etendue::test
