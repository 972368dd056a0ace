// What Embree asks about hits that may not count: where a surface does not stop a ray, and what a ray that is to
// collect all hits has met.
#pragma once

#include "world/embree.h"
#include "world/embree_scene.h"

namespace etendue {

/// Holds the filter functions of a geometry; null where it needs none.
struct FilterFunctions {
    RTCFilterFunctionN intersect = nullptr;
    RTCFilterFunctionN occluded = nullptr;
};

/// Returns what Embree has to ask about hits as `filter` says, or, if it `collects`, to note all of them.
[[nodiscard]] FilterFunctions filter_functions(const HitFilter& filter, bool collects);

}  // namespace etendue
