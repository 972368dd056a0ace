#include "wave/photons.h"

#include <utility>

namespace etendue {

namespace {

/// Moves the words of all `lists` to one place, and the photons' ranges with them.
PathWords gather_words(std::span<PhotonList> lists) {
    PathWords words;
    for (PhotonList& list : lists) {
        const WordRange moved = words.copy(list.words, {0, static_cast<std::uint32_t>(list.words.size())});
        for (Photon& photon : list.photons) photon.first_word += moved.first;
    }
    return words;
}

std::vector<std::vector<Photon>> take_photons(std::span<PhotonList> lists) {
    std::vector<std::vector<Photon>> photons;
    for (PhotonList& list : lists) photons.push_back(std::move(list.photons));
    return photons;
}

}  // namespace

SharedPhotons::SharedPhotons(std::span<PhotonList> lists, const MergeRadius& radius)
    : words_(gather_words(lists)), map_(take_photons(lists), radius) {}

}  // namespace etendue
