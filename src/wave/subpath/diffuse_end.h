// The data that connections need of a vertex on a plain diffuse surface: little enough for one cache line, and the same
// whatever the vertex is connected to, so that many connections are computed at once.
#pragma once

#include "core/columns.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "core/wide_rows.h"
#include "sampling/warp.h"
#include "transport/connecting_ray.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace etendue {

/// Holds what connections need of a vertex; a template of its lane type, see core/lane.h.
template <typename T>
struct BasicDiffuseEnd {
    using Vec = Imath::Vec3<T>;

    Vec position;          ///< metres
    Vec origin;            ///< origin of rays on the side that light is scattered to: `position`, clear of the surface
    Vec normal;            ///< shading normal, unit, on the side of the vertex before
    Vec geometric_normal;  ///< unit, on the same side
    /// Multiplies `radiance` and `importance`: the throughput that arrives, times the albedo and its gain where the
    /// normal leans (bsdf/leaning_normal.h), for importance also times OrientedSurface::received. Black where nothing
    /// scatters.
    BasicRgb<T> weight;
    /// SubpathDensities::fewer. A diffuse surface turns back to the vertex before with the same density wherever light
    /// comes from, so that nothing of it is left open.
    T fewer;

    /// Cosine between a direction and the geometric normal: nothing scatters where it is negative.
    [[nodiscard]] T cosine(const Vec& w) const { return dot(w, geometric_normal); }
    /// Throughput times f |cos| towards `w`, of a subpath from the eye.
    [[nodiscard]] BasicRgb<T> radiance(const Vec& w) const { return weight * (max(T(0.0f), dot(w, normal)) * kInvPi); }
    /// Returns the density, 1/sr, with which a subpath from the eye goes on along `w` (diffuse_pdf_for_eye).
    [[nodiscard]] T radiance_pdf(const Vec& w) const {
        const T direct = dot(w, normal);
        const T mirrored = direct - T(2.0f) * cosine(w) * dot(normal, geometric_normal);
        return (max(T(0.0f), direct) + max(T(0.0f), mirrored)) * kInvPi;
    }
    /// Throughput times f |cos| towards `w`, of a subpath from a light.
    [[nodiscard]] BasicRgb<T> importance(const Vec& w) const { return weight * importance_pdf(w); }
    /// Returns the density, 1/sr, with which a subpath from a light goes on along `w` (diffuse_pdf_for_light).
    [[nodiscard]] T importance_pdf(const Vec& w) const { return cosine(w) * kInvPi; }
};

/// Holds in one cache line what connections need of one vertex.
struct alignas(64) DiffuseEnd : BasicDiffuseEnd<float> {
    /// Stands in place of `fewer`, which is never negative, where there is no such end.
    static constexpr float kNone = -1.0f;

    DiffuseEnd()
        : BasicDiffuseEnd<float>{.position{}, .origin{}, .normal{}, .geometric_normal{}, .weight{}, .fewer = kNone} {}

    [[nodiscard]] bool exists() const { return fewer >= 0.0f; }
};

static_assert(sizeof(DiffuseEnd) == kRowFloats * sizeof(float));

/// Returns `ends` as one, each in a lane of its own.
[[nodiscard]] inline BasicDiffuseEnd<Wide> load_ends(const std::array<const DiffuseEnd*, Wide::kWidth>& ends) {
    std::array<const float*, Wide::kWidth> rows;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = &ends[i]->position.x;
    const WideRow row = load_rows(rows);
    return {.position{row[0], row[1], row[2]},
            .origin{row[3], row[4], row[5]},
            .normal{row[6], row[7], row[8]},
            .geometric_normal{row[9], row[10], row[11]},
            .weight{row[12], row[13], row[14]},
            .fewer = row[15]};
}

/// Stores each lane of `from` in its place of `ends`.
inline void store_ends(const BasicDiffuseEnd<Wide>& from, const std::array<DiffuseEnd*, Wide::kWidth>& ends) {
    const auto& [position, origin, normal, geometric_normal, weight, fewer] = from;
    std::array<float*, Wide::kWidth> rows;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = &ends[i]->position.x;
    store_rows({position.x, position.y, position.z, origin.x, origin.y, origin.z, normal.x, normal.y, normal.z,
                geometric_normal.x, geometric_normal.y, geometric_normal.z, weight.r, weight.g, weight.b, fewer},
               rows);
}

/// Ends of connections of a block, where they lie.
class DiffuseEndsOfBlock {
  public:
    void set(std::size_t lane, const DiffuseEnd& end) { ends_[lane] = &end; }
    /// Loads lanes from `first` on; those from `count` on repeat the last lane before, as they may have been set for a
    /// block whose ends are gone.
    [[nodiscard]] BasicDiffuseEnd<Wide> load(std::size_t first, std::size_t count) const {
        std::array<const DiffuseEnd*, Wide::kWidth> ends;
        for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = ends_[std::min(first + i, count - 1)];
        return load_ends(ends);
    }

  private:
    std::array<const DiffuseEnd*, kBlockLanes> ends_{};
};

}  // namespace etendue
