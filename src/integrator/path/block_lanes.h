// What lies between the stages of shading a block of paths, as columns that are computed with many paths at once.
//
// Which of its steps a path takes depends on the path alone, on its surface and on its light, never on how many others
// take them too: lanes without such a path are computed with the rest, and what comes of them is not looked at.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "core/wide.h"

#include <array>
#include <cstddef>

namespace etendue {

/// Paths of a block.
inline constexpr std::size_t kBlockLanes = 64;
static_assert(kBlockLanes % Wide::kWidth == 0);

/// A number of each path.
class Column {
  public:
    [[nodiscard]] float operator[](std::size_t lane) const { return values_[lane]; }
    void set(std::size_t lane, float value) { values_[lane] = value; }
    /// Of `Wide::kWidth` paths from `first` on.
    [[nodiscard]] Wide load(std::size_t first) const { return Wide::load(&values_[first]); }
    void store(std::size_t first, Wide values) { values.store(&values_[first]); }

  private:
    alignas(Wide::kAlignment) std::array<float, kBlockLanes> values_{};
};

struct Vec2Columns {
    Column x, y;

    void set(std::size_t lane, Vec2f v) {
        x.set(lane, v.x);
        y.set(lane, v.y);
    }
    [[nodiscard]] Imath::Vec2<Wide> load(std::size_t first) const { return {x.load(first), y.load(first)}; }
};

struct Vec3Columns {
    Column x, y, z;

    [[nodiscard]] Vec3f operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(std::size_t lane, const Vec3f& v) {
        x.set(lane, v.x);
        y.set(lane, v.y);
        z.set(lane, v.z);
    }
    [[nodiscard]] Imath::Vec3<Wide> load(std::size_t first) const {
        return {x.load(first), y.load(first), z.load(first)};
    }
    void store(std::size_t first, const Imath::Vec3<Wide>& v) {
        x.store(first, v.x);
        y.store(first, v.y);
        z.store(first, v.z);
    }
};

struct RgbColumns {
    Column r, g, b;

    [[nodiscard]] Rgb operator[](std::size_t lane) const { return {r[lane], g[lane], b[lane]}; }
    void set(std::size_t lane, const Rgb& c) {
        r.set(lane, c.r);
        g.set(lane, c.g);
        b.set(lane, c.b);
    }
    [[nodiscard]] BasicRgb<Wide> load(std::size_t first) const { return {r.load(first), g.load(first), b.load(first)}; }
    void store(std::size_t first, const BasicRgb<Wide>& c) {
        r.store(first, c.r);
        g.store(first, c.g);
        b.store(first, c.b);
    }
};

/// About 19 KiB, which stay in the first-level cache.
struct BlockLanes {
    /// A triangle: the one that a path has hit, and later the one on its light.
    Vec3Columns p0, edge1, edge2;
    Vec3Columns triangle_normal;  ///< of the hit, interpolated or zero; of the light, its front's
    Vec2Columns u;                ///< barycentric coordinates of the hit; numbers for points on lights, for directions

    // The surface, as in SurfacePoint.
    Vec3Columns position, geometric_normal;
    Column clearance;
    Vec3Columns tangent, bitangent, normal;
    Vec3Columns wo;
    RgbColumns albedo;
    RgbColumns throughput;

    // The sample of a light.
    Column light_clearance, light_area, light_back;  ///< see LightTriangleFront
    Column light_probability;                        ///< of the choice
    Vec3Columns light_wi, light_end;
    Column light_distance;
    Column light_pdf;        ///< the choice included; of a delta that alone; 0 if nothing arrives
    Column light_by_chance;  ///< 1 where the BSDF's samples may find the light too, 0 for a delta
    RgbColumns light_radiance;

    // Towards it.
    RgbColumns f_cos;
    Column pdf;
    RgbColumns contribution;
    Vec3Columns shadow_origin, shadow_direction;
    Column shadow_t_max;

    // Where the path goes on.
    Vec3Columns next_origin, next_direction;
    RgbColumns next_weight;
    Column next_pdf;

    // Each computes lanes [0, count), rounded up, from the columns that the one before and the caller have set.

    /// The points of plain surfaces from the triangles and `u`.
    void set_up_points(std::size_t count);
    /// Samples of mesh lights from `position`, the triangles and `u`.
    void sample_mesh_lights(std::size_t count);
    /// `f_cos` and `pdf` towards the light; `next_direction`, `next_weight` and `next_pdf` from `u`.
    void evaluate_matte(std::size_t count);
    /// `contribution` and its ray.
    void weigh_light(std::size_t count);
};

}  // namespace etendue
