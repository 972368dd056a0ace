// Triangles of mesh lights that are sampled for many paths at once.
#pragma once

#include "core/columns.h"
#include "light/mesh_light.h"

#include <cstddef>

namespace etendue {

/// As in LightTriangleFront.
struct LightFrontColumns {
    Vec3Columns p0, edge1, edge2, normal;
    Column clearance, area, back;

    void set(std::size_t lane, const LightTriangleFront<float>& front) {
        p0.set(lane, front.p0);
        edge1.set(lane, front.edge1);
        edge2.set(lane, front.edge2);
        normal.set(lane, front.normal);
        clearance.set(lane, front.clearance);
        area.set(lane, front.area);
        back.set(lane, front.back);
    }
    [[nodiscard]] LightTriangleFront<Wide> load(std::size_t first) const {
        return {p0.load(first),        edge1.load(first), edge2.load(first), normal.load(first),
                clearance.load(first), area.load(first),  back.load(first)};
    }
};

}  // namespace etendue
