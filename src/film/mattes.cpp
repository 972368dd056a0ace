#include "film/mattes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace etendue {

void MatteBuffer::add(std::size_t pixel, std::size_t matte, std::uint32_t id, double weight) {
    if (id == kNoId) return;
    const std::size_t first = first_slot(pixel, matte);
    std::size_t lightest = first;
    for (std::size_t slot = first; slot < first + slots_; ++slot) {
        if (ids_[slot] == id || ids_[slot] == kNoId) {
            ids_[slot] = id;
            weights_[slot] += weight;
            return;
        }
        if (std::abs(weights_[slot]) < std::abs(weights_[lightest])) lightest = slot;
    }
    if (slots_ == 0 || std::abs(weight) <= std::abs(weights_[lightest])) return;
    ids_[lightest] = id;
    weights_[lightest] = weight;
}

void MatteBuffer::add(std::size_t pixel, const MatteBuffer& other, std::size_t other_pixel) {
    for (std::size_t matte = 0; matte < mattes_; ++matte) {
        const std::size_t first = other.first_slot(other_pixel, matte);
        for (std::size_t slot = first; slot < first + slots_ && other.ids_[slot] != kNoId; ++slot)
            add(pixel, matte, other.ids_[slot], other.weights_[slot]);
    }
}

std::vector<MatteShare> MatteBuffer::ranked(std::size_t pixel, std::size_t matte) const {
    std::vector<MatteShare> shares;
    const std::size_t first = first_slot(pixel, matte);
    for (std::size_t slot = first; slot < first + slots_; ++slot)
        if (weights_[slot] > 0.0) shares.push_back({ids_[slot], weights_[slot]});
    std::ranges::sort(shares, [](const MatteShare& a, const MatteShare& b) {
        return std::tuple(-a.weight, a.id) < std::tuple(-b.weight, b.id);
    });
    return shares;
}

}  // namespace etendue
