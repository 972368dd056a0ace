// What share of light the surfaces that the camera sees scatter.
#pragma once

#include "transport/dimensions.h"
#include "world/world.h"

namespace etendue {

/// Holds the diffuse and the specular share of light that a surface scatters.
struct SurfaceAlbedo {
    Rgb diffuse;
    Rgb specular;
};

/// Returns the albedo of the surface at `point`, which `ray` from the camera has hit at `hit`, by a few samples of its
/// lobe; black if it is unlit. Where several surfaces touch, `point` becomes the one that bounds what fills the space.
[[nodiscard]] SurfaceAlbedo surface_albedo(const World& world, SurfacePoint& point, const Ray& ray, const Hit& hit,
                                           const SampleNumbers& numbers);

}  // namespace etendue
