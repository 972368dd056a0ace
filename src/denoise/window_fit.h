// A linear function of position and features, fitted to the pixels of one window.
#pragma once

#include "denoise/least_squares.h"
#include "denoise/planes.h"

#include <span>
#include <vector>

namespace etendue {

/// Minimises over β, for each channel c of an image y and the window W around a pixel p,
///
///     Σ_{q ∈ W} w_pq (y_c(q) - x_q · β_c)² + λ Σ_{q ∈ W} w_pq Σ_{j > 0} β_cj²,
///     x_q = (1, (q - p) / R, f_1(q) - f_1(p), f_2(q) - f_2(p), …),
///
/// where λ keeps what the window cannot determine, such as the slope along a feature that is constant in it, at 0.
/// Scratch memory of one thread.
class WindowFit {
  public:
    /// For windows of `radius` with rows of `row_stride` weights, and `feature_count` <= kMostUnknowns - 3 features.
    WindowFit(int radius, int row_stride, int feature_count);

    /// Fits `target`, of kFitChannels planes, around (x, y). Borders are filled.
    void fit(const Planes& target, const Planes& features, std::span<const float> weights, int x, int y);
    /// Adds the fitted values of all pixels of the window, times their weights, to the first kFitChannels planes of
    /// `sums`, and the weights to the next.
    void add_to(Planes& sums) const;

  private:
    void fill_rows(const Planes& target, const Planes& features);
    [[nodiscard]] float* column(int unknown) { return columns_.data() + unknown * size_; }
    [[nodiscard]] const float* column(int unknown) const { return columns_.data() + unknown * size_; }

    int radius_;
    int row_stride_;
    int size_;  ///< weights of all rows together, rounded up
    int unknowns_;
    int x_ = 0;
    int y_ = 0;
    std::vector<float> weights_;
    std::vector<float> columns_;   ///< x_qj: one column of the size of a window after the other
    std::vector<float> targets_;   ///< y_c(q)
    std::vector<float> weighted_;  ///< w_pq x_qj of one j
    NormalEquations equations_;
};

}  // namespace etendue
