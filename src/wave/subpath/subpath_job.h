// The job that subpaths are traced for.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/dimensions.h"
#include "transport/mis.h"
#include "wave/camera_wave.h"

#include <cstdint>
#include <span>

namespace etendue {

/// Returns what the weights of the paths of a job depend on.
[[nodiscard]] inline MisContext mis_context(const World& world, const TileJob& job,
                                            const IntegratorSettings& settings) {
    return {.world = world,
            .raised = Raised{settings.heuristic},
            .samples_per_light_path = static_cast<double>(job.full_width) * static_cast<double>(job.full_height) /
                                      static_cast<double>(job.window.area()),
            .merging = job.merging,
            .aims = settings.aimed_emission};
}

/// Says which samples one wave of subpaths is traced for, how long paths may be and how strategies are weighed.
struct SubpathJob {
    MisContext mis;
    const TileJob& job;
    const PathLengths& lengths;
    std::span<const CameraSample> samples{};
    std::span<const Ray> camera_rays{};  ///< rays of the samples, in their order

    [[nodiscard]] const World& world() const { return mis.world; }
    /// Returns the wavelength of the path of the sample in `slot`, if it needs one; both subpaths have the same.
    [[nodiscard]] Wavelength wavelength(std::uint32_t slot) const {
        return world().spectral_response().sample(
            sample_2d(job.sequence, shared_key(job, samples[slot].key), kSubpathWavelengthDimension).x);
    }
    [[nodiscard]] Rgb wavelength_weight(std::uint32_t slot, bool is_dispersed) const {
        return is_dispersed ? wavelength(slot).weight : Rgb(1.0f);
    }
    /// False if such numbers mean nothing in this World.
    [[nodiscard]] bool needs(SubpathEnd end, SubpathDimension which) const {
        if (which == SubpathDimension::Medium) return world().traits().has_scattering_bodies;
        if (which != SubpathDimension::LightChoice) return true;
        return end == SubpathEnd::AtEye ? world().traits().chooses_lights : world().traits().has_lens;
    }
    /// Returns the alpha key of rays that connect the vertex of this index; 0 if nothing is transparent.
    [[nodiscard]] std::uint32_t connection_key(SubpathEnd end, int index, std::uint32_t slot) const {
        if (!world().traits().has_transparency) return 0;
        // Another one than that of the subpath's own ray.
        return ~sample_bits(samples[slot].key, subpath_dimension(end, index, SubpathDimension::Alpha));
    }
    /// Returns `ray`, of a connection, at the time of the sample in `slot`.
    [[nodiscard]] Ray timed(Ray ray, std::uint32_t slot) const {
        ray.time = camera_rays[slot].time;
        return ray;
    }
};

}  // namespace etendue
