#include "denoise/window_fit.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace etendue {

namespace {

/// λ, in the units of features that are scaled to a deviation of 1 over the image.
constexpr double kRidge = 1e-6;
/// Independent sums of a dot product, so that it can be computed with vector instructions.
constexpr int kLanes = 8;

double dot(const float* a, const float* b, int size) {
    std::array<double, kLanes> sums{};
    for (int i = 0; i < size; i += kLanes)
        for (int lane = 0; lane < kLanes; ++lane)
            sums[static_cast<std::size_t>(lane)] += static_cast<double>(a[i + lane]) * static_cast<double>(b[i + lane]);
    double sum = 0.0;
    for (const double s : sums) sum += s;
    return sum;
}

}  // namespace

WindowFit::WindowFit(int radius, int row_stride, int feature_count)
    : radius_(radius),
      row_stride_(row_stride),
      size_(((2 * radius + 1) * row_stride + kLanes - 1) / kLanes * kLanes),
      unknowns_(3 + feature_count),
      weights_(static_cast<std::size_t>(size_)),
      columns_(static_cast<std::size_t>(size_ * unknowns_)),
      targets_(static_cast<std::size_t>(size_ * kFitChannels)),
      weighted_(static_cast<std::size_t>(size_)) {
    equations_.unknowns = unknowns_;
    for (int i = 0; i < (2 * radius + 1) * row_stride; ++i) {
        column(0)[i] = 1.0f;
        column(1)[i] = static_cast<float>(i % row_stride - radius) / static_cast<float>(radius);
        const int row = i / row_stride;
        column(2)[i] = static_cast<float>(row - radius) / static_cast<float>(radius);
    }
}

void WindowFit::fill_rows(const Planes& target, const Planes& features) {
    for (int row = 0; row < 2 * radius_ + 1; ++row) {
        const int y = y_ + row - radius_;
        const int x = x_ - radius_;
        for (int feature = 0; feature < unknowns_ - 3; ++feature) {
            const float* values = features.row(feature, y) + x;
            const float centre = features.row(feature, y_)[x_];
            float* to = column(3 + feature) + row * row_stride_;
            for (int i = 0; i < row_stride_; ++i) to[i] = values[i] - centre;
        }
        for (int channel = 0; channel < kFitChannels; ++channel)
            std::copy_n(target.row(channel, y) + x, row_stride_, targets_.data() + channel * size_ + row * row_stride_);
    }
}

void WindowFit::fit(const Planes& target, const Planes& features, std::span<const float> weights, int x, int y) {
    x_ = x;
    y_ = y;
    std::copy(weights.begin(), weights.end(), weights_.begin());
    fill_rows(target, features);
    for (int i = 0; i < unknowns_; ++i) {
        const float* values = column(i);
        for (int q = 0; q < size_; ++q)
            weighted_[static_cast<std::size_t>(q)] = weights_[static_cast<std::size_t>(q)] * values[q];
        const auto row = static_cast<std::size_t>(i);
        for (int j = 0; j <= i; ++j)
            equations_.matrix[row][static_cast<std::size_t>(j)] = dot(weighted_.data(), column(j), size_);
        for (int channel = 0; channel < kFitChannels; ++channel)
            equations_.right_hand_side[static_cast<std::size_t>(channel)][row] =
                dot(weighted_.data(), targets_.data() + channel * size_, size_);
    }
    const double weight_sum = equations_.matrix[0][0];
    for (std::size_t i = 1; i < static_cast<std::size_t>(unknowns_); ++i)
        equations_.matrix[i][i] += kRidge * weight_sum;
    solve(equations_);
}

void WindowFit::add_to(Planes& sums) const {
    const int side = 2 * radius_ + 1;
    std::array<float, 2 * kLargestWindowRadius + 1> fitted;
    for (int row = 0; row < side; ++row) {
        const int y = y_ + row - radius_;
        const int x = x_ - radius_;
        const float* weights = weights_.data() + row * row_stride_;
        for (int channel = 0; channel < kFitChannels; ++channel) {
            fitted.fill(0.0f);
            const auto& beta = equations_.right_hand_side[static_cast<std::size_t>(channel)];
            for (int j = 0; j < unknowns_; ++j) {
                const auto slope = static_cast<float>(beta[static_cast<std::size_t>(j)]);
                const float* values = column(j) + row * row_stride_;
                for (int i = 0; i < side; ++i) fitted[static_cast<std::size_t>(i)] += slope * values[i];
            }
            float* to = sums.row(channel, y) + x;
            for (int i = 0; i < side; ++i) to[i] += weights[i] * fitted[static_cast<std::size_t>(i)];
        }
        float* to = sums.row(kFitChannels, y) + x;
        for (int i = 0; i < side; ++i) to[i] += weights[i];
    }
}

}  // namespace etendue
