#include "bsdf/thin_film.h"

#include "bsdf/fresnel.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

float reflectance_at_normal(float ior_below, float ior_above) {
    const float root = (ior_below - ior_above) / (ior_below + ior_above);
    return root * root;
}

/// Index of a lossless base in air.
float ior_from_reflectance(float f0) {
    const float root = std::sqrt(std::clamp(f0, 0.0f, 0.9999f));
    return (1.0f + root) / (1.0f - root);
}

/// One Gaussian of the fit of a colour matching function in the domain of optical path differences (Belcour and Barla,
/// section 4): `height` sqrt(2 pi `variance`) is its area.
struct Gaussian {
    float height, position, variance;

    [[nodiscard]] float operator()(float phase, float shift) const {
        return height * std::sqrt(2.0f * kPi * variance) * std::cos(position * phase + shift) *
               std::exp(-phase * phase * variance);
    }
};

/// Returns the colour of an interference of the order whose path difference is `path_nm` and whose phase is shifted by
/// `shift` (Belcour and Barla, equation 12), relative to the white of equal energy. A film far thinner than the
/// wavelengths of light is a tenth too red in a working space whose white is D65, as it is with the implementation
/// notes of KHR_materials_iridescence.
Rgb sensitivity(const XyzToWorking& to_working, float path_nm, float shift) {
    constexpr Gaussian kX{5.4856e-13f, 1.6810e+06f, 4.3278e+09f};
    constexpr Gaussian kSecondX{9.7470e-14f, 2.2399e+06f, 4.5282e+09f};
    constexpr Gaussian kY{4.4201e-13f, 1.7953e+06f, 9.3046e+09f};
    constexpr Gaussian kZ{5.2481e-13f, 2.2084e+06f, 6.6121e+09f};
    constexpr float kWhite = 1.0685e-7f;
    const float phase = 2.0f * kPi * path_nm * 1e-9f;
    const float x = (kX(phase, shift) + kSecondX(phase, shift)) / kWhite;
    const float y = kY(phase, shift) / kWhite;
    const float z = kZ(phase, shift) / kWhite;
    const auto row = [&](const Rgb& r) { return r.r * x + r.g * y + r.b * z; };
    return {row(to_working[0]), row(to_working[1]), row(to_working[2])};
}

/// Holds the reflectance at the film's lower face, and the phase that the face shifts, radians.
struct LowerFace {
    float reflectance;
    float phase;
};

}  // namespace

Rgb ThinFilm::reflectance(const Rgb& f0, float cos_theta) const {
    // Light turns by Snell's law; a film whose index is that of what lies above does not reflect at all.
    const float sin2_film = (1.0f - cos_theta * cos_theta) / (ior * ior);
    const float cos_film = std::sqrt(std::max(0.0f, 1.0f - sin2_film));
    const float upper = fresnel_schlick(Rgb(reflectance_at_normal(ior, 1.0f)), cos_theta).r;
    const float passed = 1.0f - upper;
    const auto lower_face = [&](float base_f0) {
        const float base_ior = ior_from_reflectance(base_f0 + 1e-4f);
        const float r = fresnel_schlick(Rgb(reflectance_at_normal(base_ior, ior)), cos_film).r;
        return LowerFace{r, base_ior < ior ? kPi : 0.0f};
    };
    const std::array<LowerFace, 3> lower{lower_face(f0.r), lower_face(f0.g), lower_face(f0.b)};
    // Longer paths have lost all colour; the bound keeps what files may say from overflowing.
    constexpr float kLongestPath = 1e6f;
    const float path_nm = std::min(kLongestPath, 2.0f * ior * thickness_nm * cos_film);

    // Equation 10: the mean over wavelengths, and the first two orders of interference.
    std::array<float, 3> result{};
    for (std::size_t c = 0; c < 3; ++c) {
        const float both = std::clamp(upper * lower[c].reflectance, 1e-5f, 0.9999f);
        const float root = std::sqrt(both);
        const float through = passed * passed * lower[c].reflectance / (1.0f - both);
        float value = upper + through;
        float amplitude = through - passed;
        for (int order = 1; order <= 2; ++order) {
            amplitude *= root;
            const auto m = static_cast<float>(order);
            const Rgb color = sensitivity(*xyz_to_working, m * path_nm, m * (kPi + lower[c].phase));
            value += 2.0f * amplitude * (c == 0 ? color.r : c == 1 ? color.g : color.b);
        }
        result[c] = std::clamp(value, 0.0f, 1.0f);
    }
    return {result[0], result[1], result[2]};
}

}  // namespace etendue
