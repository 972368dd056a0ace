#include "integrator/path/glossy_lanes.h"

#include "bsdf/plain_metallic_roughness.h"
#include "world/lane_scattering.h"

namespace etendue {

void GlossyLanes::evaluate(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> surface({tangent.load(l), bitangent.load(l), normal.load(l)},
                                            geometric_normal.load(l), wo.load(l), true);
        const PlainMetallicRoughness<Wide> lobe{base.load(l), metallic.load(l), alpha.load(l), f0.load(l), f90.load(l)};
        const Imath::Vec3<Wide> wi = light_wi.load(l);
        const Imath::Vec3<Wide> wi_local = surface.frame.to_local(wi);
        const auto both = lobe.evaluate_and_sample(surface.wo_local, wi_local, u_lobe.load(l), u.load(l));
        const BasicBsdfValue<Wide> value = placed(surface, both.value, wi, wi_local);
        f_cos.store(l, value.f_cos);
        pdf.store(l, value.pdf_solid_angle);
        const BasicBsdfSample<Wide> sample = placed(surface, both.sample, TransportMode::Radiance);
        next_direction.store(l, sample.wi);
        next_weight.store(l, sample.weight);
        next_pdf.store(l, sample.pdf_solid_angle);
    }
}

}  // namespace etendue
