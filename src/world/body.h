// What fills a closed surface, and where its boundary is crossed.
#pragma once

#include "medium/homogeneous_medium.h"
#include "world/interior.h"

#include <cstdint>

namespace etendue {

/// Describes what fills the closed surfaces of a material.
struct Filling {
    HomogeneousMedium medium{};
    float ior = 1.0f;         ///< at 587.6 nm, against vacuum
    float dispersion = 0.0f;  ///< 20 over the Abbe number
    int priority = 0;
};

/// A ray at the boundary of a body.
struct Crossing {
    Interior outside{};  ///< where it is, or will be, on the front side of the surface
    Interior inside{};   ///< and on the back
    /// Another body fills the space on both sides: there is no boundary to see here.
    bool is_covered = false;
    float outside_ior = 1.0f;
    float outside_dispersion = 0.0f;
    float inside_ior = 1.0f;
    float inside_dispersion = 0.0f;

    [[nodiscard]] bool disperses() const { return outside_dispersion > 0.0f || inside_dispersion > 0.0f; }
    /// Index inside over outside at a wavelength in nanometres; 0 stands for 587.6.
    [[nodiscard]] float relative_ior(float nm) const;
};

}  // namespace etendue
