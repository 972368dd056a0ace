// Where surfaces are: ray queries, and what is known of a place that a ray hits.
#pragma once

#include "core/bounds.h"
#include "core/ray.h"
#include "core/ray_columns.h"
#include "core/ray_cone.h"
#include "scene/accelerator_kind.h"
#include "world/hit.h"
#include "world/interpolation.h"
#include "world/plain_surface.h"
#include "world/surface_point.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace etendue {

class AcceleratedScene;
class Materials;

/// Answers where rays hit surfaces, which ways are free, and how surfaces lie there. Ask for many rays at once, because
/// that is what makes queries fast (docs/optimisation.md).
class SceneGeometry {
  public:
    /// Tells Embree how opaque surfaces are; `data` and `materials` have to stay where they are. Builds the accelerator
    /// that `data` asks for in place of Embree, and throws as `accelerate` does.
    SceneGeometry(const WorldData& data, const Materials& materials);
    ~SceneGeometry();
    SceneGeometry(const SceneGeometry&) = delete;
    SceneGeometry& operator=(const SceneGeometry&) = delete;

    /// Finds the nearest hit of each ray; `hits` is as long as `rays`.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                   QueryForm form = QueryForm::Best, RayEnds ends = RayEnds::InScene) const;
    void intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence, QueryForm form = QueryForm::Best,
                   RayEnds ends = RayEnds::InScene) const;
    /// Answers kOccluded where something but clear surfaces lies within (0, t_max], else kPassesClear or kFree;
    /// `occluded` is as long as `rays`.
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form = QueryForm::Best,
                  RayEnds ends = RayEnds::InScene) const;
    void occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form = QueryForm::Best,
                  RayEnds ends = RayEnds::InScene) const;
    /// Calls `visit` for each clear surface between the ends of `ray`, one after the other.
    void for_each_clear(const Ray& ray, RayEnds ends,
                        const std::function<void(const Hit& hit, const SurfacePoint& point)>& visit) const;
    /// Returns the share of light, seen along `wo`, that goes straight through the clear surface at `point`.
    [[nodiscard]] Rgb straight_share(const SurfacePoint& point, const Vec3f& wo) const;
    /// Returns the share of light that passes the clear surfaces between the ends of `ray`, which may be anything along
    /// which nothing else lies; without boundaries of bodies, which `Media::transmittance` knows with what fills them.
    [[nodiscard]] Rgb clear_transmittance(const Ray& ray, RayEnds ends = RayEnds::InScene) const;
    /// Returns the seconds that bare Embree takes to trace `rays`, without what it takes to hand them over or to look
    /// at what they hit: the ceiling for any renderer. `occlusion`: whether they only ask if something is in the way.
    [[nodiscard]] double replay(std::span<const Ray> rays, bool occlusion, Coherence coherence, QueryForm form) const;

    /// Builds `kind` (not Embree) over all surfaces, for as long as this lives. Throws SceneError if something moves
    /// while the shutter is open, or if there are more triangles than `AcceleratedScene::kMostTriangles`.
    [[nodiscard]] std::unique_ptr<const AcceleratedScene> accelerate(AcceleratorKind kind) const;

    /// Returns the surface at `hit` (valid), whose textures are read at a point. Rays that go on from it may meet
    /// others that touch it.
    [[nodiscard]] SurfacePoint surface_point(const Hit& hit) const;
    /// Returns the surface at `hit`, whose textures are filtered for `ray`, which hit it, with `cone` around it. Rays
    /// that go on from it start beyond all surfaces that touch it.
    [[nodiscard]] SurfacePoint surface_point(const Hit& hit, const Ray& ray, const RayCone& cone) const;
    /// Returns the share of light, [0, 1], that the surface at `hit` (valid) stops.
    [[nodiscard]] float opacity(const Hit& hit) const;
    /// Returns the triangle at `hit` (valid) as it is where nothing moves.
    [[nodiscard]] HitTriangle hit_triangle(const Hit& hit) const {
        const Geometry& geometry = data_.geometries[hit.geometry];
        const auto& triangle = geometry.triangles[hit.triangle];
        const Vec3f& p0 = geometry.positions[triangle[0]];
        return {p0, geometry.positions[triangle[1]] - p0, geometry.positions[triangle[2]] - p0,
                geometry.normals.empty() ? Vec3f(0.0f) : interpolate(geometry.normals, triangle, {hit.u, hit.v})};
    }
    /// Returns the texture coordinates of the triangle that was hit, of the set that the textures of `surface` follow.
    [[nodiscard]] HitCoordinates hit_coordinates(const Hit& hit, const PlainSurface& surface) const;
    /// Has the triangles of a few `hits`, some of which may be no hits, fetched from memory at once, where there are so
    /// many in the scene that they are in no cache. Whoever looks at them next would else wait for each by itself.
    void fetch_triangles(std::span<const Hit> hits) const {
        if (has_far_triangles_) fetch_far_triangles(hits);
    }
    /// Returns the mean curvature of the surface at `hit` (valid), 1/m, positive where its front is convex; for
    /// `RayCone`s that are mirrored there.
    [[nodiscard]] float mean_curvature(const Hit& hit) const;

    /// Returns the box around all surfaces.
    [[nodiscard]] const Bounds& bounds() const { return data_.bounds; }
    /// Returns the radius of a sphere around all surfaces, metres; 1 for an empty world.
    [[nodiscard]] float bounding_radius() const { return data_.bounding_radius(); }
    /// Returns the bytes of triangles and what belongs to their vertices, without the BVH.
    [[nodiscard]] std::size_t triangle_bytes() const;

  private:
    // A `Batch` is a span of rays or RayColumns.
    template <typename Batch>
    void intersect_batch(const Batch& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                         RayEnds ends) const;
    template <typename Batch>
    void occluded_batch(const Batch& rays, std::span<std::uint8_t> occluded, QueryForm form, RayEnds ends) const;
    void fetch_far_triangles(std::span<const Hit> hits) const;

    const WorldData& data_;
    const Materials& materials_;
    std::unique_ptr<const AcceleratedScene> accelerated_;  ///< null where Embree is asked
    bool has_far_triangles_;
};

}  // namespace etendue
