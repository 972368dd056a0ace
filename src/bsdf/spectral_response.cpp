#include "bsdf/spectral_response.h"

#include "bsdf/color_matching.h"

#include <algorithm>

namespace etendue {

SpectralResponse::SpectralResponse(const XyzToWorking& xyz_to_working) {
    std::array<std::array<double, 3>, kSteps> response{};
    std::array<double, 3> total{};
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double nm = static_cast<double>(kFirstNm) + (static_cast<double>(i) + 0.5) * static_cast<double>(kStepNm);
        const std::array<double, 3> xyz = color_matching_xyz(nm);
        for (std::size_t c = 0; c < 3; ++c) {
            const Rgb& row = xyz_to_working[c];
            const double value = static_cast<double>(row.r) * xyz[0] + static_cast<double>(row.g) * xyz[1] +
                                 static_cast<double>(row.b) * xyz[2];
            response[i][c] = std::max(0.0, value);
            total[c] += response[i][c];
        }
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < kSteps; ++i) {
        for (std::size_t c = 0; c < 3; ++c) response[i][c] /= total[c];
        const double mean = (response[i][0] + response[i][1] + response[i][2]) / 3.0;
        if (mean > 0.0)
            weight_[i] = {static_cast<float>(response[i][0] / mean), static_cast<float>(response[i][1] / mean),
                          static_cast<float>(response[i][2] / mean)};
        sum += mean;
        cumulative_[i + 1] = static_cast<float>(sum);
    }
    cumulative_.back() = 1.0f;
}

Wavelength SpectralResponse::sample(float u) const {
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, u);
    const auto step = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    const float width = cumulative_[step + 1] - cumulative_[step];
    const float t = width > 0.0f ? std::clamp((u - cumulative_[step]) / width, 0.0f, 1.0f) : 0.5f;
    return {kFirstNm + (static_cast<float>(step) + t) * kStepNm, weight_[step], u};
}

float dispersed_ior(float ior, float dispersion, float nm) {
    if (nm == 0.0f || dispersion == 0.0f) return ior;
    const float abbe_term = (ior - 1.0f) * dispersion / 20.0f;
    return std::max(1.0f, ior + abbe_term * (523655.0f / (nm * nm) - 1.5168f));
}

}  // namespace etendue
