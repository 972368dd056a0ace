// How multiple importance sampling weighs strategies against each other.
#pragma once

namespace etendue {

enum class Heuristic {
    Power,    ///< exponent 2 (Veach 1997, section 9.2.4)
    Balance,  ///< exponent 1
};

/// A density, or a ratio of them, as the heuristic wants it.
struct Raised {
    Heuristic heuristic = Heuristic::Balance;

    /// A template of its lane type, see core/lane.h, double besides.
    template <typename T>
    [[nodiscard]] T operator()(T ratio) const {
        return heuristic == Heuristic::Power ? ratio * ratio : ratio;
    }
};

}  // namespace etendue
