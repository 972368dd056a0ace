#include "report/ratio_interval.h"

#include "report/student_t.h"

#include <cmath>

namespace etendue {

LogEstimate product(const LogEstimate& a, const LogEstimate& b) {
    const double variance = a.variance + b.variance;
    return {a.value + b.value, variance,
            variance * variance / (a.variance * a.variance / a.degrees + b.variance * b.variance / b.degrees)};
}

RatioInterval ratio_interval(const LogEstimate& a, const LogEstimate& b, double confidence) {
    // The logarithms of a quotient and of a product have equal variances and degrees of freedom.
    const LogEstimate spread = product(a, b);
    const double difference = a.value - b.value;
    // Where nothing varies, Student's distribution has no degrees of freedom.
    const double margin = spread.variance > 0.0
                              ? student_quantile(confidence, spread.degrees) * std::sqrt(spread.variance)
                              : spread.variance;
    return {std::exp(difference), std::exp(difference - margin), std::exp(difference + margin)};
}

}  // namespace etendue
