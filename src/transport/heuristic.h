// How densities enter the weights of multiple importance sampling.
#pragma once

#include "scene/integrator_settings.h"

namespace etendue {

/// Raises a density, or a ratio of densities, to the exponent of the heuristic.
struct Raised {
    Heuristic heuristic = Heuristic::Balance;

    /// Returns `ratio` raised to the heuristic's exponent; a template of its lane type, see core/lane.h, or of double.
    template <typename T>
    [[nodiscard]] T operator()(T ratio) const {
        return heuristic == Heuristic::Power ? ratio * ratio : ratio;
    }
};

}  // namespace etendue
