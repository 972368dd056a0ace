// A point at which a subpath scatters, with all that connections to it need.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "medium/homogeneous_medium.h"
#include "transport/merging.h"
#include "transport/mis.h"
#include "wave/aov/path_words.h"
#include "world/scattering.h"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace etendue {

/// Holds a vertex of a subpath, other than the first, which lies on the light or on the lens.
struct PathVertex {
    static constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

    Vec3f position{0.0f};                 ///< metres
    Vec3f wo{0.0f};                       ///< unit, to the vertex before
    std::optional<Scattering> surface{};  ///< none in a medium, and not yet where `diffuse` is given
    /// Holds the material of a vertex with a DiffuseEnd, from which SubpathVertices::whole makes its surface.
    const Bsdf* diffuse = nullptr;
    Vec3f geometric_normal{0.0f};                ///< unit, on the surface's front
    float clearance = 0.0f;                      ///< metres, as in SurfacePoint
    const HomogeneousMedium* outside = nullptr;  ///< medium on the front; null in vacuum
    const HomogeneousMedium* inside = nullptr;   ///< medium on the back; in a medium, as `outside`
    Rgb throughput{};                            ///< as the subpath arrives, without the weight of its wavelength
    MergePlace merging{};
    std::uint32_t slot = 0;  ///< which sample
    SubpathDensities densities{};
    WordRange words{};                ///< words of the subpath as it arrives
    int index = 1;                    ///< vertices before it
    int next_edges = 1;               ///< edges of the path when a ray from here has hit; media add none
    std::uint16_t label = 0;          ///< label of the material, for words
    bool is_dispersed = false;        ///< light of other wavelengths would not be here, or would not scatter so
    bool is_connectible = true;       ///< false if all it does are deltas
    bool is_after_delta = false;      ///< the subpath has scattered by a delta, or passed a hidden boundary
    bool is_reached_directly = true;  ///< false if boundaries that other bodies hide lie before it
    bool is_seen_directly = true;     ///< nothing but deltas lie between the eye and it
    bool lights_camera = true;        ///< light that leaves it straight for the camera arrives there

    /// False in a medium.
    [[nodiscard]] bool is_on_surface() const {
        assert(surface || diffuse == nullptr);
        return surface.has_value();
    }
    /// Returns f |cos theta| towards `w`; the phase function in a medium.
    [[nodiscard]] Rgb evaluate(const Vec3f& w, TransportMode mode) const {
        return is_on_surface() ? surface->evaluate(w, mode).f_cos : Rgb(outside->phase.pdf_solid_angle(wo, w));
    }
    /// Returns `evaluate` towards `w` with the densities, 1/sr, of going there and of coming back.
    [[nodiscard]] Scattering::TwoWayValue evaluate_both_ways(const Vec3f& w, TransportMode mode) const {
        if (is_on_surface()) return surface->evaluate_both_ways(w, mode);
        // Forwards and backwards a phase function has one density.
        const float phase = outside->phase.pdf_solid_angle(wo, w);
        return {Rgb(phase), phase, phase};
    }
    /// False if the vertex scatters nothing along `towards`, of any length; quick to ask.
    [[nodiscard]] bool may_scatter(const Vec3f& towards) const {
        return !is_on_surface() || surface->may_scatter(towards);
    }
    /// Returns what the scattering of light that goes on to `w` may be taken for.
    [[nodiscard]] VertexEvent event(const Vec3f& w, TransportMode mode) const {
        return is_on_surface() ? surface_event(*surface, w, false, mode, label) : VertexEvent{};
    }
    /// Returns the absolute cosine between `w` and the geometric normal; 1 in a medium.
    [[nodiscard]] float cosine(const Vec3f& w) const { return is_on_surface() ? abs_dot(w, geometric_normal) : 1.0f; }
    /// Returns where a ray along `w` starts, clear of the surface.
    [[nodiscard]] Vec3f origin(const Vec3f& w) const {
        return is_on_surface() ? offset_origin(position, geometric_normal, clearance, w) : position;
    }
    /// Returns the medium that fills the space towards `w`; null in vacuum.
    [[nodiscard]] const HomogeneousMedium* medium(const Vec3f& w) const {
        return dot(w, geometric_normal) > 0.0f ? outside : inside;
    }
};

/// Holds what the search for connections asks of a vertex that can be connected; the search asks one vertex after the
/// other, so that these numbers lie side by side.
struct ConnectibleVertex {
    std::uint32_t vertex;  ///< its place in SubpathVertices::all
    std::uint32_t slot;    ///< this and the others as in PathVertex
    int index;
    int next_edges;
    bool is_seen_directly;
    bool is_dispersed;
    bool is_after_delta;
    bool is_in_dense;  ///< the vertex lies in a dense medium, within which nothing is connected
    float merged;      ///< SubpathDensities::merged of a vertex with a DiffuseEnd
};

}  // namespace etendue
