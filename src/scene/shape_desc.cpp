#include "scene/mesh_desc.h"
#include "shape/shape.h"

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

double ShapeDesc::area(const Mat4f& to_world) const {
    if (kind == ShapeKind::Rectangle) {
        const Vec3d x(transform_vector(to_world, {2.0f * half_size.x, 0.0f, 0.0f}));
        return x.cross(Vec3d(transform_vector(to_world, {0.0f, 2.0f * half_size.y, 0.0f}))).length();
    }
    Mat4f size;
    size.setScale(half_size);
    const ExactShape shape(kind, size * to_world);
    double area = 0.0;
    for (std::uint32_t face = 0; face < shape.face_count(); ++face) area += shape.area(face);
    return area;
}

}  // namespace etendue
