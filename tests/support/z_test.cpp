#include "support/z_test.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace etendue::test {

std::string ZTestResult::str() const {
    return fmt::format("z = {:.3f}, p = {:.3g}", z, p_value);
}

ZTestResult z_test(const Estimate& a, const Estimate& b, double tolerance) {
    const double difference = a.mean - b.mean;
    ZTestResult result;
    // Written so that an estimate that is not a number does not pass.
    if (std::abs(difference) <= tolerance) return result;
    result.z = std::copysign(std::abs(difference) - tolerance, difference) / std::sqrt(a.variance + b.variance);
    result.p_value = std::isnan(result.z) ? 0.0 : std::erfc(std::abs(result.z) / std::numbers::sqrt2);
    return result;
}

}  // namespace etendue::test
