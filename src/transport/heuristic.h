// How multiple importance sampling weighs strategies against each other.
#pragma once

namespace etendue {

enum class Heuristic {
    Power,    ///< exponent 2 (Veach 1997, section 9.2.4)
    Balance,  ///< exponent 1
};

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
