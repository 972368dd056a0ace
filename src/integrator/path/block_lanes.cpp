#include "integrator/path/block_lanes.h"

#include "core/ray.h"
#include "light/mesh_light.h"
#include "sampling/mis.h"
#include "transport/connecting_ray.h"
#include "world/lane_scattering.h"

#include <limits>

namespace etendue {

using WideVec3 = Imath::Vec3<Wide>;

void BlockLanes::sample_mesh_lights(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const LightTriangleSample<Wide> sample = front.load(l).sample(position.load(l), u_light.load(l));
        light_wi.store(l, sample.wi);
        light_end.store(l, sample.end);
        light_distance.store(l, sample.distance);
        light_pdf.store(l, sample.pdf_solid_angle * expected_samples.load(l));
    }
}

template <bool kSamples>
void BlockLanes::evaluate_diffuse(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const OrientedSurface<Wide> oriented = surface(l);
        const BasicDiffuse<Wide> lobe{albedo.load(l)};
        const BasicBsdfValue<Wide> value = etendue::evaluate_diffuse(
            oriented, lobe, oriented.frame.to_local(light_wi.load(l)), TransportMode::Radiance);
        f_cos.store(l, value.f_cos);
        pdf.store(l, value.pdf_solid_angle);
        if constexpr (kSamples) {
            const BasicBsdfSample<Wide> sample =
                sample_diffuse(oriented, lobe, u_bsdf.load(l), TransportMode::Radiance);
            next_direction.store(l, sample.wi);
            next_weight.store(l, sample.weight);
            next_pdf.store(l, sample.pdf_solid_angle);
        }
    }
}
template void BlockLanes::evaluate_diffuse<false>(std::size_t count);
template void BlockLanes::evaluate_diffuse<true>(std::size_t count);

void BlockLanes::set_next_origins(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth)
        next_origin.store(
            l, offset_origin(position.load(l), geometric_normal.load(l), clearance.load(l), next_direction.load(l)));
}

void BlockLanes::weigh_light(std::size_t count, const PathColumns& paths, std::size_t first) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const Wide by_light = light_pdf.load(l);
        const Wide weight = power_heuristic(by_light, pdf.load(l) * light_by_chance.load(l)) / by_light;
        // What is no number goes on, to be counted with what it makes of its sample.
        const auto is_dark = by_light <= Wide(0.0f) || is_black(f_cos.load(l));
        const BasicRgb<Wide> light = paths.throughput.load(first + l) * f_cos.load(l) * light_radiance.load(l) * weight;
        contribution.store(l, light);
        arrives.store(l, select(is_dark || is_black(light), Wide(0.0f), Wide(1.0f)));
        const WideVec3 wi = light_wi.load(l);
        const WideVec3 origin = offset_origin(position.load(l), geometric_normal.load(l), clearance.load(l), wi);
        shadow_origin.store(l, origin);
        const ConnectingRay<Wide> connection(origin, light_end.load(l));
        const auto is_far = light_distance.load(l) == Wide(kInfinity);
        shadow_direction.store(
            l, {select(is_far, wi.x, connection.direction.x), select(is_far, wi.y, connection.direction.y),
                select(is_far, wi.z, connection.direction.z)});
        shadow_t_max.store(l, select(is_far, Wide(kInfinity), connection.t_max));
    }
}

void BlockLanes::scatter(std::size_t count, PathColumns& paths, std::size_t first) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const std::size_t i = first + l;
        const WideMask by_lanes = is_wide.load(l) != Wide(0.0f);
        const BasicRgb<Wide> weight = next_weight.load(l);
        goes_on.store(l, select(by_lanes, select(is_black(weight), Wide(0.0f), Wide(1.0f)), goes_on.load(l)));
        const BasicRgb<Wide> before = paths.throughput.load(i);
        paths.throughput.store(i, select<Wide>(by_lanes, before * weight, before));
        paths.pdf_solid_angle.store(i, select(by_lanes, next_pdf.load(l), paths.pdf_solid_angle.load(i)));
        const WideBits history = paths.history.load(i);
        paths.history.store(i, select(by_lanes, path_history::after_lobe(history, 1), history));
        const auto move = [&](auto& column, const auto& next) {
            column.store(i, select(by_lanes, next.load(l), column.load(i)));
        };
        move(paths.origin.x, next_origin.x);
        move(paths.origin.y, next_origin.y);
        move(paths.origin.z, next_origin.z);
        move(paths.direction.x, next_direction.x);
        move(paths.direction.y, next_direction.y);
        move(paths.direction.z, next_direction.z);
    }
}

}  // namespace etendue
