#include "wave/surface_lanes.h"

#include "core/frame.h"
#include "core/ray.h"
#include "world/triangle_point.h"

namespace etendue {

void SurfaceLanes::set_up_points(std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const TrianglePoint<Wide> point(p0.load(l), edge1.load(l), edge2.load(l), u.load(l));
        position.store(l, point.position);
        geometric_normal.store(l, point.normal);
        clearance.store(l, etendue::clearance(point.normal, position_error(point.extent)));
        const auto frame = BasicFrame<Wide>::from_normal(usable_normal(triangle_normal.load(l), point.normal));
        tangent.store(l, frame.tangent);
        bitangent.store(l, frame.bitangent);
        normal.store(l, frame.normal);
    }
}

}  // namespace etendue
