// Exact shapes as geometries of Embree's.
#pragma once

#include "shape/shape.h"
#include "world/embree.h"

namespace etendue {

/// Holds what Embree hands back when a ray comes near a shape.
struct EmbreeShape {
    ExactShape shape;
    RTCFilterFunctionN intersect_filter;  ///< or null
    RTCFilterFunctionN occluded_filter;   ///< or null
};

/// Makes `geometry`, of Embree's user type, the one shape, which must stay where it is.
void set_shape(RTCGeometry geometry, const EmbreeShape& shape);

}  // namespace etendue
