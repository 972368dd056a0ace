// What connections need of a vertex on a plain matte surface: little enough for one cache line, and the same whatever
// the vertex is connected to, so that many connections are computed at once.
#pragma once

#include "core/columns.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "integrator/connecting_ray.h"
#include "sampling/warp.h"

#include <cstddef>

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicMatteEnd {
    using Vec = Imath::Vec3<T>;

    Vec position;          ///< metres
    Vec origin;            ///< of rays to where light is scattered to: as `position`, clear of the surface
    Vec normal;            ///< of shading, unit, on the side of the vertex before
    Vec geometric_normal;  ///< unit, on the same side
    /// What `importance` or `radiance` is times: the throughput that arrives, the albedo and, of importance, what the
    /// adjoint factor (OrientedSurface) has of the vertex before. Black where the leak rule lets nothing scatter.
    BasicRgb<T> weight;
    /// SubpathDensities::fewer. A matte surface turns back to the vertex before with the same density wherever light
    /// comes from, so that nothing of it is left open.
    T fewer;

    [[nodiscard]] MaskOf<T> scatters(const Vec& w) const {
        return dot(w, geometric_normal) > T(0.0f) && dot(w, normal) > T(0.0f);
    }
    /// Density, 1/sr, with which the subpath goes on along `w`, if it `scatters` that way at all.
    [[nodiscard]] T pdf(const Vec& w) const { return dot(w, normal) * kInvPi; }
    /// Cosine between such a direction and the geometric normal.
    [[nodiscard]] T cosine(const Vec& w) const { return dot(w, geometric_normal); }
    /// Throughput times f |cos| towards such a direction, of a subpath from the eye.
    [[nodiscard]] BasicRgb<T> radiance(const Vec& w) const { return weight * pdf(w); }
    /// The same of one from a light: in the adjoint factor the cosine to the normal of shading gives way to that of the
    /// geometric normal.
    [[nodiscard]] BasicRgb<T> importance(const Vec& w) const { return weight * (cosine(w) * kInvPi); }
};

/// Of one vertex.
struct alignas(64) MatteEnd : BasicMatteEnd<float> {
    /// In place of `fewer`, which is never negative, where there is no such end.
    static constexpr float kNone = -1.0f;

    MatteEnd()
        : BasicMatteEnd<float>{.position{}, .origin{}, .normal{}, .geometric_normal{}, .weight{}, .fewer = kNone} {}

    [[nodiscard]] bool exists() const { return fewer >= 0.0f; }
};

/// Ends of connections of a block.
struct MatteEndColumns {
    Vec3Columns position, origin, normal, geometric_normal;
    RgbColumns weight;
    Column fewer;

    void set(std::size_t lane, const MatteEnd& end) {
        position.set(lane, end.position);
        origin.set(lane, end.origin);
        normal.set(lane, end.normal);
        geometric_normal.set(lane, end.geometric_normal);
        weight.set(lane, end.weight);
        fewer.set(lane, end.fewer);
    }
    [[nodiscard]] BasicMatteEnd<Wide> load(std::size_t first) const {
        return {position.load(first),         origin.load(first), normal.load(first),
                geometric_normal.load(first), weight.load(first), fewer.load(first)};
    }
};

}  // namespace etendue
