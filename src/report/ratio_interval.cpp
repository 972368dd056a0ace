#include "report/ratio_interval.h"

#include "report/student_t.h"

#include <cmath>

namespace etendue {

namespace {

/// Half the interval of a − b; NaN if a variance is unknown.
double welch_margin(const LogEstimate& a, const LogEstimate& b, double confidence) {
    const double squared = a.variance + b.variance;
    // Also where nothing varies, and Student's distribution has no degrees of freedom.
    if (!(squared > 0.0)) return squared;
    const double degrees =
        squared * squared / (a.variance * a.variance / a.degrees + b.variance * b.variance / b.degrees);
    return student_quantile(confidence, degrees) * std::sqrt(squared);
}

}  // namespace

RatioInterval ratio_interval(const LogEstimate& a, const LogEstimate& b, double confidence) {
    const double difference = a.value - b.value;
    const double margin = welch_margin(a, b, confidence);
    return {std::exp(difference), std::exp(difference - margin), std::exp(difference + margin)};
}

}  // namespace etendue
