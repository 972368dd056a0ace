#include "integrator/bdpt/connection_lanes.h"

namespace etendue {

void BetweenLanes::connect(std::size_t count, const WeightRule& rule) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const BasicDiffuseEnd<Wide> end = eye.load(l, count);
        store(l, end.origin, connect_ends(rule, end, light.load(l, count), merged.load(l), scale.load(l)));
    }
}

void ToLightLanes::connect(std::size_t count, const WeightRule& rule, const LightAim& aim) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const BasicDiffuseEnd<Wide> end = eye.load(l, count);
        const LightTriangleFront<Wide> triangle = front.load(l);
        const LightTriangleSample<Wide> sample = triangle.sample(end.position, u.load(l));
        wi.store(l, sample.wi);
        store(l, end.origin,
              connect_to_triangle(rule, end, triangle, sample, radiance.load(l), probability.load(l),
                                  choice_ratio.load(l), aim));
    }
}

void ToCameraLanes::connect(std::size_t count, const WeightRule& rule, float samples_per_path) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const BasicDiffuseEnd<Wide> end = light.load(l, count);
        store(l, end.origin, connect_to_lens(rule, end, lens.load(l), w.load(l), importance.load(l), samples_per_path));
    }
}

}  // namespace etendue
