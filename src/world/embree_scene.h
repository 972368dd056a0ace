// The acceleration structure, and how batches of rays go through it.
#pragma once

#include "core/bounds.h"
#include "core/parallel.h"
#include "core/ray.h"
#include "core/ray_columns.h"
#include "world/embree.h"
#include "world/geometry.h"
#include "world/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

struct QueryContext;

/// Which hits of a geometry Embree has to ask about.
struct HitFilter {
    bool by_opacity = false;      ///< hits on its partly transparent places
    bool passes_shadows = false;  ///< shadow rays pass it, and say that they did
};

/// Opacity of a triangle at a point, [0, 1].
using OpacityFunction = float (*)(const void* world, std::uint32_t geometry, std::uint32_t triangle, Vec2f barycentric);

/// Owns the Embree device and scenes. Baked geometry sits in the top-level scene; a shared mesh has a scene of its own,
/// built once, and instances in the top-level one.
class EmbreeScene {
  public:
    /// Which triangles of a slot, one of (instance, geometry), a scene for `collect` holds.
    struct CollectedSlot {
        bool is_whole = false;
        std::vector<std::uint32_t> triangles{};  ///< if it is not whole; none if there are none
    };

    /// Builds all BVHs with the threads of `threads`. The geometries' vectors must stay where they are: Embree reads
    /// them. `filters` are those of the geometries. If there are `collected` slots, the scene holds no more than these,
    /// and is for `collect` alone; of meshes that several instances share it holds all.
    EmbreeScene(std::span<const Geometry> geometries, std::span<const Instance> instances,
                std::span<const TransformMotion> motions, std::span<const HitFilter> filters, const ThreadPool& threads,
                std::vector<CollectedSlot> collected = {});
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Called once the World has its final address.
    void set_opacity(OpacityFunction function, const void* world);

    void intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, QueryForm form) const;
    void intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence, QueryForm form) const;
    /// See SceneGeometry::occluded.
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form) const;
    void occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form) const;

    /// Puts all surfaces that `ray` meets from `t_min` metres on into `hits`, in any order and as far as there is room;
    /// how many these are. The scene has to be one of `collected_slots`.
    std::size_t collect(const Ray& ray, float t_min, std::span<Hit> hits) const;
    /// Calls `visit(instance, geometry, triangle)` for all triangles whose bounds come within `radius` metres of
    /// `point` in the middle of the shutter, and perhaps for some others, until it returns false.
    void for_each_near(const Vec3f& point, float radius,
                       const std::function<bool(std::uint32_t, std::uint32_t, std::uint32_t)>& visit) const;

    /// See SceneGeometry::replay.
    [[nodiscard]] double replay(std::span<const Ray> rays, bool occlusion, Coherence coherence, QueryForm form) const;

    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// Seconds that all BVHs took to build.
    [[nodiscard]] double build_seconds() const { return build_seconds_; }
    [[nodiscard]] std::string instruction_set() const;
    /// How all BVHs are built, in words.
    [[nodiscard]] static std::string quality();
    /// True if anything moves while the shutter is open.
    [[nodiscard]] bool has_motion() const { return has_motion_; }

    /// Says what one top-level entry of Embree stands for.
    struct TopLevelEntry {
        std::uint32_t instance;
        std::uint32_t geometry;  ///< of baked geometry itself, or the first of an instanced mesh
    };
    /// How a hit on top-level entry `top`, geometry `inner` of its scene if it is an instance, reads in our numbers.
    [[nodiscard]] TopLevelEntry resolve(std::uint32_t top, std::uint32_t inner, bool is_instance) const {
        const TopLevelEntry entry = top_level_[top];
        return is_instance ? TopLevelEntry{entry.instance, entry.geometry + inner} : entry;
    }
    /// How a hit of Embree's reads in our numbers.
    [[nodiscard]] Hit make_hit(float t, float u, float v, unsigned int triangle, unsigned int inner,
                               unsigned int instance, float time) const;
    /// Number in its mesh of triangle `triangle` of entry `top`, in a scene for `collect`.
    [[nodiscard]] std::uint32_t collected_triangle(std::uint32_t top, std::uint32_t triangle) const {
        const CollectedSlot* slot = slot_of_entry_[top];
        return slot == nullptr || slot->is_whole ? triangle : slot->triangles[triangle];
    }
    [[nodiscard]] float opacity(std::uint32_t geometry, std::uint32_t triangle, Vec2f barycentric) const {
        return opacity_(world_, geometry, triangle, barycentric);
    }

  private:
    // A `Batch` is a span of rays or RayColumns.
    template <typename Batch>
    void intersect_batch(const Batch& rays, std::span<Hit> hits, Coherence coherence, QueryForm form) const;
    template <typename Batch>
    void intersect_single(const Batch& rays, std::span<Hit> hits) const;
    template <std::size_t Width, typename Batch>
    void intersect_packets(const Batch& rays, std::span<Hit> hits, bool coherent) const;
    template <typename Batch>
    void occluded_batch(const Batch& rays, std::span<std::uint8_t> occluded, QueryForm form) const;
    template <typename Batch>
    void occluded_single(const Batch& rays, std::span<std::uint8_t> occluded) const;
    template <std::size_t Width, typename Batch>
    void occluded_packets(const Batch& rays, std::span<std::uint8_t> occluded) const;
    template <std::size_t Width>
    [[nodiscard]] double replay_packets(std::span<const Ray> rays, QueryContext& context, bool occlusion,
                                        bool coherent) const;
    [[nodiscard]] double replay_single(std::span<const Ray> rays, QueryContext& context, bool occlusion) const;
    /// Whether packets of such rays are traced with Embree's coherent traversal. It pays within one level (4 to 5 times
    /// a single ray against 1.8 on the Cornell box) and costs where packets meet instances (0.8 against 1.4 on ten
    /// thousand of them).
    [[nodiscard]] bool takes_as_coherent(Coherence coherence) const;

    void add_triangles(RTCScene scene, const Geometry& geometry, const HitFilter& filter,
                       const CollectedSlot* collected);
    void add_instance(RTCScene shared, const Instance& instance, std::span<const TransformMotion> motions) const;
    RTCScene build_shared_scene(const Instance& instance, std::span<const Geometry> geometries,
                                std::span<const HitFilter> filters);

    RTCDevice device_ = nullptr;
    RTCScene top_ = nullptr;
    std::vector<RTCScene> shared_;
    std::vector<TopLevelEntry> top_level_;
    OpacityFunction opacity_ = nullptr;
    const void* world_ = nullptr;
    std::size_t bytes_ = 0;
    double build_seconds_ = 0.0;
    bool has_motion_ = false;
    bool collects_ = false;
    std::vector<CollectedSlot> collected_;
    std::vector<const CollectedSlot*> slot_of_entry_;  ///< null for instances
    std::deque<std::vector<std::array<std::uint32_t, 3>>> collected_indices_;
    bool has_panes_ = false;
};

}  // namespace etendue
