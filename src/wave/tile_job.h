// Which samples of a tile to take.
#pragma once

#include "film/film.h"
#include "film/pixel_filter.h"
#include "sampling/sampler.h"
#include "transport/merge_radius.h"
#include "wave/aov/aov_set.h"

#include <cstdint>
#include <limits>
#include <span>

namespace etendue {

class LampImages;
class SharedPhotons;
class WaveProfile;

/// Names a pixel that is to get samples: its index in the tile, row by row, and that of its first sample.
struct PixelJob {
    std::uint32_t pixel = 0;
    std::uint32_t first_sample = 0;
};

/// Names the samples to take: `sample_count` of every pixel of `rect`, beginning with index `first_sample`, or of
/// `pixels` alone, each beginning with its own.
struct TileJob {
    PixelRect rect;
    PixelRect window;  ///< pixels that splats may fall into; each has a light path per sample
    int full_width = 0;
    int full_height = 0;
    std::uint32_t first_sample = 0;
    std::uint32_t sample_count = 1;
    std::uint32_t seed = 0;
    SampleSequence sequence = SampleSequence::Sobol;
    const PixelFilter* filter = nullptr;  ///< not null
    const AovSet* aovs = nullptr;         ///< contents of the tile's layers; null if it has none
    /// Bounds the largest component of an indirect contribution to a sample, which is scaled, so that its hue stays.
    /// Direct is the light of paths C S* L and C S* . L: what the eye sees, mirrors and smooth glass apart, and what
    /// lights it without another bounce. All other light is indirect.
    float clamp_indirect = std::numeric_limits<float>::infinity();
    std::span<const PixelJob> pixels{};  ///< empty for all
    /// Says where subpaths of bidirectional methods merge; all samples have one index, time and wavelength then.
    Merging merging{};
    const SharedPhotons* photons = nullptr;   ///< photons to merge with; null if there are none, or none yet
    const LampImages* lamp_images = nullptr;  ///< images that get samples of their own; null for none
    WaveProfile* profile = nullptr;           ///< profile of the thread that renders; null if nobody asks
};

/// Returns the key of the numbers that samples with this key share if they merge: all of one index have one time and
/// one wavelength, since a photon of another time or colour would be none.
[[nodiscard]] inline SampleKey shared_key(const TileJob& job, SampleKey key) {
    constexpr std::uint32_t kNoPixel = std::numeric_limits<std::uint32_t>::max();
    return job.merging.merges() ? SampleKey{make_pixel_seed(job.seed, kNoPixel, kNoPixel), key.index} : key;
}

}  // namespace etendue
