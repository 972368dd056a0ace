// The accelerators of accelerator/ over the surfaces of a World, asked as Embree is.
#pragma once

#include "accelerator/accelerator.h"
#include "core/ray.h"
#include "world/hit.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace etendue {

/// Says how the hits of an accelerator and of Embree compare.
struct HitAgreement {
    std::uint64_t rays = 0;
    std::uint64_t ties = 0;      ///< rays that met different triangles, as far away but for rounding
    std::uint64_t differ = 0;    ///< rays that differ more than that
    double largest_error = 0.0;  ///< largest difference of two distances to one triangle, relative to the scene
};

/// Holds all triangles of a World in world space, instances as often as they are placed, with an accelerator over them.
/// Rays try exact shapes one after the other besides.
/// Partly transparent surfaces, clear ones, and what is hidden from the camera let the same rays pass as in Embree.
class AcceleratedScene {
  public:
    /// Limits the triangles, which take 48 bytes each here.
    static constexpr std::size_t kMostTriangles = std::size_t{1} << 24;

    /// Builds `kind`, any but Embree, over `data`, which has to stay where it is. Throws SceneError if something moves
    /// while the shutter is open, or if there are more than `kMostTriangles`.
    AcceleratedScene(const WorldData& data, AcceleratorKind kind);

    /// Returns the nearest hit of a ray.
    [[nodiscard]] Hit closest(const Ray& ray, RayEnds ends, RayWork& work) const;
    [[nodiscard]] Hit closest(const Ray& ray, RayEnds ends) const {
        RayWork ignored;
        return closest(ray, ends, ignored);
    }
    /// Answers as `SceneGeometry::occluded` does.
    [[nodiscard]] std::uint8_t occlusion(const Ray& ray, RayEnds ends, RayWork& work) const;
    [[nodiscard]] std::uint8_t occlusion(const Ray& ray, RayEnds ends) const {
        RayWork ignored;
        return occlusion(ray, ends, ignored);
    }

    /// Returns the seconds that the accelerator takes to trace `rays`, and adds what they have it do to `work`;
    /// `occlusion`: whether they only ask if something is in the way.
    [[nodiscard]] double replay(std::span<const Ray> rays, bool occlusion, RayWork& work) const;
    /// Compares the answers to `rays` with Embree's.
    [[nodiscard]] HitAgreement compare_with_embree(std::span<const Ray> rays, bool occlusion) const;

    [[nodiscard]] AcceleratorStatistics statistics() const { return accelerator_->statistics(); }

  private:
    /// Says which triangle of the World one is.
    struct Identity {
        std::uint32_t instance;
        std::uint32_t geometry;
        std::uint32_t triangle;
    };
    /// Holds a shape in world space.
    struct PlacedShape {
        ExactShape shape;
        std::uint32_t instance;
        std::uint32_t geometry;
    };
    class Filter;

    [[nodiscard]] Hit make_hit(const TriangleHit& hit, float time) const;
    /// Returns the nearest hit of a shape within (0, t_max] that `filter` accepts; `work` counts a test of each shape.
    [[nodiscard]] Hit closest_shape(const Ray& ray, float t_max, Filter& filter, RayWork& work) const;

    const WorldData& data_;
    std::vector<Triangle> triangles_;
    std::vector<Identity> identities_;  ///< identity of each triangle
    std::vector<PlacedShape> shapes_;
    bool has_filters_ = false;  ///< some surface lets some rays pass
    std::unique_ptr<const Accelerator> accelerator_;
};

}  // namespace etendue
