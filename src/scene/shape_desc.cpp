#include "scene/mesh_desc.h"

namespace etendue {

std::vector<Vec3f> ShapeDesc::corners() const {
    const Vec3f half(half_size.x, half_size.y, is_flat(kind) ? 0.0f : half_size.z);
    std::vector<Vec3f> corners;
    for (int corner = 0; corner < (is_flat(kind) ? 4 : 8); ++corner)
        corners.push_back(half * Vec3f((corner & 1) != 0 ? 1.0f : -1.0f, (corner & 2) != 0 ? 1.0f : -1.0f,
                                       (corner & 4) != 0 ? 1.0f : -1.0f));
    return corners;
}

}  // namespace etendue
