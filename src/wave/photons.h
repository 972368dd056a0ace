// The photons that the samples of a pass share.
#pragma once

#include "transport/photon_map.h"
#include "wave/aov/path_words.h"
#include "wave/tile_job.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Bounds the light subpaths of one index, and with them the memory of photons, whatever the size of the image.
inline constexpr std::size_t kMostPhotonPaths = std::size_t{1} << 20u;

/// Returns the step between the pixels of `window`, counted row by row from the first one, whose light subpaths leave
/// photons.
[[nodiscard]] inline std::size_t photon_step(const PixelRect& window) {
    return (window.area() + kMostPhotonPaths - 1) / kMostPhotonPaths;
}
/// Returns how many pixels of `window` have light subpaths that leave photons.
[[nodiscard]] inline std::size_t photon_paths(const PixelRect& window) {
    const std::size_t step = photon_step(window);
    return (window.area() + step - 1) / step;
}
/// Returns those pixels of `window` that lie in `tile`, a part of it, each with its sample `sample`.
[[nodiscard]] std::vector<PixelJob> photon_pixels(const PixelRect& window, const PixelRect& tile, std::uint32_t sample);

/// Holds the photons of a few light subpaths, with their words.
struct PhotonList {
    std::vector<Photon> photons;
    PathWords words;

    /// Appends `photon`, whose words are `range` of `from`.
    void add(Photon photon, const PathWords& from, WordRange range) {
        const WordRange copied = words.copy(from, range);
        photon.first_word = copied.first;
        photon.word_count = copied.count;
        photons.push_back(photon);
    }
};

/// Holds the photons of one sample of every pixel.
class SharedPhotons {
  public:
    /// Takes the photons of `lists` in their order, and leaves them empty.
    SharedPhotons(std::span<PhotonList> lists, const MergeRadius& radius, const ThreadPool& threads);

    [[nodiscard]] const PhotonMap& map() const { return map_; }
    /// Returns the words that the photons' ranges are of.
    [[nodiscard]] const PathWords& words() const { return words_; }
    [[nodiscard]] std::size_t bytes() const { return map_.bytes() + words_.bytes(); }

  private:
    PathWords words_;
    PhotonMap map_;
};

}  // namespace etendue
