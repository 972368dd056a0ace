#include "support/t_test.h"

#include <cmath>
#include <numeric>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

namespace etendue::test {

std::string TTestResult::str() const {
    return fmt::format("mean = {:.6g} +- {:.2g}, t = {:.3f}, p = {:.3g}", mean, standard_error, t, p_value);
}

TTestResult t_test(std::span<const double> samples, double expected, double tolerance) {
    const auto count = static_cast<double>(samples.size());
    TTestResult result;
    result.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / count;
    double squares = 0.0;
    for (const double sample : samples) squares += (sample - result.mean) * (sample - result.mean);
    result.standard_error = std::sqrt(squares / (count - 1.0) / count);
    const double difference = result.mean - expected;
    // Written so that a mean that is not a number does not pass.
    if (std::abs(difference) <= tolerance) return result;
    result.t = std::copysign(std::abs(difference) - tolerance, difference) / result.standard_error;
    if (!std::isfinite(result.t)) {
        result.p_value = 0.0;
        return result;
    }
    const boost::math::students_t distribution(count - 1.0);
    result.p_value = 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(result.t)));
    return result;
}

}  // namespace etendue::test
