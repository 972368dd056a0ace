#include "wave/subpath/subpath_job.h"

#include "transport/subpath.h"

namespace etendue {

Wavelength SubpathJob::wavelength(std::uint32_t slot) const {
    return world().spectral_response().sample(
        sample_2d(job.sequence, shared_key(job, samples[slot].key), kSubpathWavelengthDimension).x);
}

bool SubpathJob::needs(SubpathEnd end, SubpathDimension which) const {
    switch (which) {
        case SubpathDimension::Medium:
            return world().traits().has_scattering_bodies;
        case SubpathDimension::LightChoice:
            return end == SubpathEnd::AtEye ? world().traits().chooses_lights : world().traits().has_lens;
        default:
            return true;
    }
}

std::uint32_t SubpathJob::connection_key(SubpathEnd end, int index, std::uint32_t slot) const {
    if (!world().traits().has_transparency) return 0;
    // Another one than that of the subpath's own ray.
    return ~sample_bits(samples[slot].key, subpath_dimension(end, index, SubpathDimension::Alpha));
}

}  // namespace etendue
