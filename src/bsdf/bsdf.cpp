#include "bsdf/bsdf.h"

#include "sampling/sobol.h"

namespace etendue {

BsdfValue evaluate_bsdf(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi, TransportMode mode) {
    return std::visit([&](const auto& lobe) { return lobe.evaluate(wo, wi, mode); }, bsdf);
}

BsdfSample sample_bsdf(const Bsdf& bsdf, const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) {
    return std::visit([&](const auto& lobe) { return lobe.sample(wo, u_lobe, u, mode); }, bsdf);
}

bool has_non_delta(const Bsdf& bsdf) {
    return std::visit([](const auto& lobe) { return lobe.has_non_delta(); }, bsdf);
}

bool is_two_sided_interface(const Bsdf& bsdf) {
    return std::holds_alternative<SmoothDielectric>(bsdf) || std::holds_alternative<RoughDielectric>(bsdf);
}

Rgb estimate_albedo(const Bsdf& bsdf, const Vec3f& wo, int count) {
    Rgb sum;
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        const float u_lobe = owen_sobol_2d(index, 0x51ed270bu).x;
        sum += sample_bsdf(bsdf, wo, u_lobe, owen_sobol_2d(index, 0x2545f491u), TransportMode::Importance).weight;
    }
    return sum / static_cast<float>(count);
}

}  // namespace etendue
