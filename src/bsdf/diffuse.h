// Lambertian reflection.
//
// f = albedo / pi. Sampled by the cosine; every sample has weight `albedo`. Example: chalk, matte paint.
#pragma once

#include "bsdf/bsdf_sample.h"

namespace etendue {

struct Diffuse {
    Rgb albedo{0.5f};  ///< reflected share per channel, [0, 1]

    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    [[nodiscard]] bool has_non_delta() const { return true; }
};

}  // namespace etendue
