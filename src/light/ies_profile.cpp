#include "light/ies_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace etendue {

AngleTable::AngleTable(std::vector<float> angles) : angles_(std::move(angles)) {
    constexpr float kTolerance = 1e-5f;  // radians; no goniophotometer turns as exactly
    const float step = (back() - front()) / static_cast<float>(size() - 1);
    bool even = true;
    for (std::size_t i = 0; i < size(); ++i)
        even = even && std::abs(angles_[i] - (front() + static_cast<float>(i) * step)) <= kTolerance;
    if (even) intervals_per_radian_ = 1.0f / step;
}

AngleTable::Place AngleTable::find(float angle) const {
    if (intervals_per_radian_ > 0.0f) {
        const std::size_t last = size() - 2;
        const float position =
            std::clamp((angle - front()) * intervals_per_radian_, 0.0f, static_cast<float>(last + 1));
        const std::size_t index = std::min(static_cast<std::size_t>(position), last);
        return {index, position - static_cast<float>(index)};
    }
    const auto above = std::upper_bound(angles_.begin() + 1, angles_.end() - 1, angle);
    const float low = *(above - 1);
    return {static_cast<std::size_t>(above - angles_.begin()) - 1,
            std::clamp((angle - low) / (*above - low), 0.0f, 1.0f)};
}

IesProfile::IesProfile(std::vector<float> vertical, std::vector<float> horizontal, std::vector<float> candela)
    : vertical_(std::move(vertical)),
      horizontal_(std::move(horizontal)),
      candela_(std::move(candela)),
      mean_(vertical_.size()) {
    // The trapezoidal rule is exact for what is interpolated linearly.
    const std::size_t height = vertical_.size();
    for (std::size_t h = 0; h + 1 < horizontal_.size(); ++h) {
        const double weight = static_cast<double>(horizontal_[h + 1] - horizontal_[h]) / (4.0 * std::numbers::pi);
        for (std::size_t v = 0; v < height; ++v)
            mean_[v] += weight * (static_cast<double>(candela_[h * height + v]) +
                                  static_cast<double>(candela_[(h + 1) * height + v]));
    }
}

float IesProfile::candela(const Vec3f& direction) const {
    // Not the arc cosine, which loses all digits near the axis.
    const float theta = std::atan2(std::sqrt(direction.x * direction.x + direction.y * direction.y), -direction.z);
    if (theta < vertical_.front() || theta > vertical_.back()) return 0.0f;
    const float phi = std::atan2(direction.y, direction.x);
    const AngleTable::Place v = vertical_.find(theta);
    const AngleTable::Place h = horizontal_.find(phi < 0.0f ? phi + 2.0f * kPi : phi);
    const float* column = candela_.data() + h.index * vertical_.size() + v.index;
    const float* next = column + vertical_.size();
    return std::lerp(std::lerp(column[0], column[1], v.fraction), std::lerp(next[0], next[1], v.fraction), h.fraction);
}

double IesProfile::mean_candela(double theta) const {
    const auto angle = static_cast<float>(theta);
    if (angle < vertical_.front() || angle > vertical_.back()) return 0.0;
    const AngleTable::Place v = vertical_.find(angle);
    return std::lerp(mean_[v.index], mean_[v.index + 1], static_cast<double>(v.fraction));
}

}  // namespace etendue
