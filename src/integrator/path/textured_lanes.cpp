#include "integrator/path/textured_lanes.h"

#include "world/section_ellipse.h"

namespace etendue {

void TexturedLanes::set_up(const BlockLanes& surfaces, std::size_t count) {
    for (std::size_t l = 0; l < count; l += Wide::kWidth) {
        const Imath::Vec2<Wide> barycentric = surfaces.u.load(l);
        const Imath::Vec2<Wide> first = uv_edge1.load(l);
        const Imath::Vec2<Wide> second = uv_edge2.load(l);
        const Imath::Vec2<Wide> origin = uv0.load(l);
        uv.store(l, {origin.x + first.x * barycentric.x + second.x * barycentric.y,
                     origin.y + first.y * barycentric.x + second.y * barycentric.y});
        const Imath::Vec3<Wide> normal = surfaces.geometric_normal.load(l);
        const Imath::Vec3<Wide> wo = surfaces.wo.load(l);
        const SectionEllipse<Wide> section({-wo.x, -wo.y, -wo.z}, width.load(l), normal);
        const TextureEllipse<Wide> ellipse(section, surfaces.edge1.load(l), surfaces.edge2.load(l), normal, first,
                                           second);
        along.store(l, ellipse.along);
        across.store(l, ellipse.across);
    }
}

}  // namespace etendue
