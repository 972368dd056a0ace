// Which lengths of paths are asked for.
#pragma once

namespace etendue {

/// Bounds the lengths of paths, in edges: 1 is a light seen directly, 2 is direct light on a surface.
struct PathLengths {
    int max_depth = 32;
    int min_depth = 1;
    int roulette_depth = 3;
};

}  // namespace etendue
