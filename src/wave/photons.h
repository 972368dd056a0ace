// The photons that the samples of a pass share.
#pragma once

#include "transport/photon_map.h"
#include "wave/aov/path_words.h"

#include <cstddef>
#include <span>
#include <vector>

namespace etendue {

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
    /// Takes the photons of `lists` in their order.
    SharedPhotons(std::span<PhotonList> lists, const MergeRadius& radius);

    [[nodiscard]] const PhotonMap& map() const { return map_; }
    /// Returns the words that the photons' ranges are of.
    [[nodiscard]] const PathWords& words() const { return words_; }
    [[nodiscard]] std::size_t bytes() const { return map_.bytes() + words_.bytes(); }

  private:
    PathWords words_;
    PhotonMap map_;
};

}  // namespace etendue
