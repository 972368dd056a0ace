// The steps of the recursion of subpath_densities.h: where subpaths begin, and where they scatter.
#pragma once

#include "integrator/subpath/subpath_wave.h"

namespace etendue {

/// Edges of the shortest way from a light, or from a surface, to the camera by another vertex: where that scatters in a
/// medium it adds none.
[[nodiscard]] inline int edges_to_connect(const World& world) {
    return world.has_scattering_bodies() ? 1 : 2;
}

/// Along the ray of `emission`.
[[nodiscard]] inline DepartingDensities leave_light(const SubpathJob& job, const Emission& emission) {
    const EmissionSample& sample = emission.sample;
    const bool at_infinity = job.world.is_at_infinity(emission.light);
    const auto position = static_cast<double>(sample.pdf_position_area);
    const auto direction = static_cast<double>(sample.pdf_direction_solid_angle);
    const auto choice = static_cast<double>(emission.probability);
    return {.d = job.world.can_be_hit(emission.light) ? 1.0 / job.raised(choice * (at_infinity ? direction : position))
                                                      : 0.0,
            .pdf_forward = at_infinity ? position : direction,
            .cosine = static_cast<double>(sample.cos_theta),
            .is_from_infinity = at_infinity};
}

/// At the first vertex of a light subpath, at `position`, where its ray has the cosine `cos_arriving`.
[[nodiscard]] inline SubpathDensities arrive_from_light(const SubpathJob& job, const Emission& emission,
                                                        const DepartingDensities& departing, const Vec3f& position,
                                                        double cos_arriving) {
    const EmissionSample& sample = emission.sample;
    const auto squared_distance = static_cast<double>(length_squared(position - sample.position));
    SubpathDensities arrived = departing.arrive(job.raised, squared_distance, cos_arriving);
    // A light that is sampled for this vertex is chosen in another way than this one was, and so are its triangles.
    auto for_vertex = static_cast<double>(job.world.light_probability(position, emission.light) *
                                          job.world.light_sample_gain(emission.light, sample.triangle, position));
    auto for_emission = static_cast<double>(emission.probability);
    if (emission.light == job.world.environment()) {
        for_vertex *= static_cast<double>(job.world.environment_pdf_solid_angle(-sample.direction));
        for_emission *= static_cast<double>(sample.pdf_direction_solid_angle);
    }
    arrived.a *= job.raised(for_vertex / for_emission);
    return arrived;
}

/// At the first vertex of an eye subpath: the lens and the film, by `camera`, say how densely camera rays fall there.
[[nodiscard]] inline SubpathDensities arrive_from_lens(const SubpathJob& job, DepartingDensities departing,
                                                       const CameraConnection& camera, double cos_arriving) {
    departing.pdf_forward = job.samples_per_light_path() * static_cast<double>(camera.importance_area);
    departing.is_from_infinity = true;  // per area already
    return departing.arrive(job.raised, 1.0, cos_arriving);
}

/// On from a vertex, with the densities of the direction and of turning back, 1/sr, and its cosine.
[[nodiscard]] inline DepartingDensities scatter(const Raised& raised, const SubpathDensities& arrived, float pdf,
                                                float reverse_pdf, float cosine) {
    return {.d = arrived.fewer(raised, static_cast<double>(reverse_pdf)),
            .pdf_forward = static_cast<double>(pdf),
            .cosine = static_cast<double>(cosine)};
}

/// The same by a delta, where one density is `reverse_ratio` times the other.
[[nodiscard]] inline DepartingDensities scatter_by_delta(const Raised& raised, const SubpathDensities& arrived,
                                                         float reverse_ratio, float cosine) {
    return {.d = arrived.b * raised(static_cast<double>(reverse_ratio)),
            .cosine = static_cast<double>(cosine),
            .is_connectible = false};
}

}  // namespace etendue
