#include "accelerator/brute_force.h"

#include "accelerator/ray_search.h"

namespace etendue {

void BruteForce::trace(RaySearch& search) const {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        if (search.test(triangles_, i)) return;
}

}  // namespace etendue
