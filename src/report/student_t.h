// Student's distribution, as far as intervals of means need it.
#pragma once

namespace etendue {

/// The probability that |T| exceeds `t` >= 0, T of Student's distribution with `degrees` > 0 degrees of freedom, which
/// need not be whole.
[[nodiscard]] double student_two_sided(double t, double degrees);

/// The t that |T| stays below with probability `confidence` in (0, 1).
[[nodiscard]] double student_quantile(double confidence, double degrees);

}  // namespace etendue
