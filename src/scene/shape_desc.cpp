#include "scene/mesh_desc.h"

#include <cstddef>

namespace etendue {

std::vector<Vec3f> ShapeDesc::corners() const {
    const Vec3f half(half_size.x, half_size.y, is_flat(kind) ? 0.0f : half_size.z);
    const int count = is_flat(kind) ? 4 : 8;
    std::vector<Vec3f> corners;
    corners.reserve(static_cast<std::size_t>(count));
    for (int corner = 0; corner < count; ++corner)
        corners.push_back(half * Vec3f((corner & 1) != 0 ? 1.0f : -1.0f, (corner & 2) != 0 ? 1.0f : -1.0f,
                                       (corner & 4) != 0 ? 1.0f : -1.0f));
    return corners;
}

}  // namespace etendue
