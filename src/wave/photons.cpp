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
        list.words = {};
    }
    return words;
}

std::vector<std::vector<Photon>> take_photons(std::span<PhotonList> lists) {
    std::vector<std::vector<Photon>> photons;
    for (PhotonList& list : lists) photons.push_back(std::move(list.photons));
    return photons;
}

}  // namespace

std::vector<PixelJob> photon_pixels(const PixelRect& window, const PixelRect& tile, std::uint32_t sample) {
    const std::size_t step = photon_step(window);
    std::vector<PixelJob> pixels;
    std::uint32_t in_tile = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x, ++in_tile) {
            const std::size_t in_window =
                static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
                static_cast<std::size_t>(x - window.x0);
            if (in_window % step == 0) pixels.push_back({in_tile, sample});
        }
    return pixels;
}

SharedPhotons::SharedPhotons(std::span<PhotonList> lists, const MergeRadius& radius, const ThreadPool& threads)
    : words_(gather_words(lists)), map_(take_photons(lists), radius, threads) {}

}  // namespace etendue
