#include "world/interior.h"

#include <algorithm>

namespace etendue {

void Interior::enter(std::uint32_t body) {
    if (count_ < kCapacity) bodies_[count_++] = body;
}

void Interior::leave(std::uint32_t body) {
    const auto end = bodies_.begin() + count_;
    const auto found = std::find(bodies_.begin(), end, body);
    if (found == end) return;
    *found = bodies_[--count_];
}

bool operator==(const Interior& a, const Interior& b) {
    return std::is_permutation(a.bodies_.begin(), a.bodies_.begin() + a.count_, b.bodies_.begin(),
                               b.bodies_.begin() + b.count_);
}

std::uint32_t Interior::filling() const {
    return count_ == 0 ? kNone : *std::min_element(bodies_.begin(), bodies_.begin() + count_);
}

}  // namespace etendue
