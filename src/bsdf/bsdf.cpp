#include "bsdf/bsdf.h"

#include "sampling/sobol.h"

namespace etendue {

Rgb estimate_albedo(const Bsdf& bsdf, const Vec3f& wo, int count, std::uint32_t seed) {
    Rgb sum;
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        const float u_lobe = owen_sobol_2d(index, hash_combine(seed, 0)).x;
        sum += sample_bsdf(bsdf, wo, u_lobe, owen_sobol_2d(index, hash_combine(seed, 1)), TransportMode::Importance)
                   .weight;
    }
    return sum / static_cast<float>(count);
}

}  // namespace etendue
