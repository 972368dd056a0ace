#include "bsdf/bsdf.h"

#include "sampling/sobol.h"

namespace etendue {

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
