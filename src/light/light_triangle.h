// The triangles that mesh lights are made of.
#pragma once

#include "core/vec.h"

namespace etendue {

/// A triangle in world space.
struct LightTriangle {
    Vec3f p0, edge1, edge2;
};

}  // namespace etendue
