#include "report/student_t.h"

#include <cmath>
#include <initializer_list>
#include <limits>

namespace etendue {

namespace {

/// The continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz's method as Thompson and Barnett
/// (1986) changed it. Converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
    constexpr double kTiny = 1e-300;  // in place of 0, which nothing can be divided by
    constexpr int kMostTerms = 100000;
    const auto not_zero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
    double numerator = 1.0;
    double denominator = 1.0 / not_zero(1.0 - (a + b) * x / (a + 1.0));
    double fraction = denominator;
    for (int m = 1; m < kMostTerms; ++m) {
        const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        double change = 1.0;
        for (const double term : {even, odd}) {
            denominator = 1.0 / not_zero(1.0 + term * denominator);
            numerator = not_zero(1.0 + term / numerator);
            change = numerator * denominator;
            fraction *= change;
        }
        if (std::abs(change - 1.0) < 4.0 * std::numeric_limits<double>::epsilon()) break;
    }
    return fraction;
}

/// I_x(a, b) with y = 1 - x, which may be too near 1 to be found from x.
double regularized_beta(double a, double b, double x, double y) {
    if (x <= 0.0) return 0.0;
    if (y <= 0.0) return 1.0;
    // DLMF 8.17.22 and, where the fraction converges slowly, the reflection 8.17.4.
    const double factor =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(y));
    if (x < (a + 1.0) / (a + b + 2.0)) return factor * beta_fraction(a, b, x) / a;
    return 1.0 - factor * beta_fraction(b, a, y) / b;
}

}  // namespace

double student_two_sided(double t, double degrees) {
    // Abramowitz and Stegun 26.7.1 with 26.5.27.
    const double squares = degrees + t * t;
    return regularized_beta(0.5 * degrees, 0.5, degrees / squares, t * t / squares);
}

double student_quantile(double confidence, double degrees) {
    const double outside = 1.0 - confidence;
    double low = 0.0, high = 1.0;
    while (student_two_sided(high, degrees) > outside && high < 1e150) high *= 2.0;
    // Bisection: as exact as the probability is, and asked for a few times in a program's life.
    for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
        (student_two_sided(middle, degrees) > outside ? low : high) = middle;
    return high;
}

}  // namespace etendue
