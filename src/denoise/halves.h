// An image as two independent halves of its samples, and what their difference says about its variance.
#pragma once

#include "denoise/planes.h"

namespace etendue {

/// Variances that are estimated from a difference of halves are averaged over boxes of (2 n + 1)² pixels.
inline constexpr int kVarianceRadius = 1;

/// Two estimates of the same image from samples that are independent of each other.
struct Halves {
    float share = 0.5f;  ///< s in (0, 1): the share of the samples that `a` is the mean of; `b` is of the others
    Planes a;
    Planes b;
    /// Holds the variance of the mean of all samples, per channel; Var(a) is 1/s times that, Var(b) 1/(1 - s) times.
    Planes variance;

    [[nodiscard]] float variance_scale_a() const { return 1.0f / share; }
    [[nodiscard]] float variance_scale_b() const { return 1.0f / (1.0f - share); }
};

/// Makes the halves from `whole`, the mean v of all samples, and `one_half`, the mean a of a share s = `share` of them,
/// in (0, 1); the others' mean is b = (v - s a) / (1 - s). The border of `whole` is not read.
[[nodiscard]] Halves make_halves(const Planes& whole, Planes one_half, float share);

/// True if no sample brought anything: there is no noise to take out.
[[nodiscard]] bool is_black(const Halves& halves);

/// Estimates the variance of v = s a + (1 - s) b. With n samples of variance σ²,
///     Var(a) = σ²/(s n),  Var(b) = σ²/((1 - s) n),  E[(a - b)²] = Var(v) / (s (1 - s)),
/// so that (a - b)² s (1 - s) estimates Var(v) without bias. The estimate has one degree of freedom only, and is
/// averaged over the box of kVarianceRadius.
[[nodiscard]] Planes estimated_variance(const Planes& a, const Planes& b, float share);

/// Returns the mean of all samples, s a + (1 - s) b.
[[nodiscard]] Planes mean_of_all(const Planes& a, const Planes& b, float share);

/// Each pixel the mean of the box of (2 radius + 1)² pixels around it, the image repeated beyond its edges; `radius` in
/// [0, kPlaneBorder].
[[nodiscard]] Planes box_filtered(const Planes& planes, int radius);

}  // namespace etendue
