// The acceleration structure, and how batches of rays go through it.
#pragma once

#include "core/bounds.h"
#include "core/parallel.h"
#include "core/ray.h"
#include "core/ray_columns.h"
#include "world/embree.h"
#include "world/embree_entries.h"
#include "world/geometry.h"
#include "world/hit.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace etendue {

/// Which hits of a geometry Embree has to ask about.
struct HitFilter {
    bool by_opacity = false;      ///< hits on its partly transparent places
    bool passes_shadows = false;  ///< shadow rays pass it, and say that they did
    bool is_hidden = false;       ///< rays with an end at the camera pass it, and say nothing
    bool culls_back = false;      ///< rays pass it from behind, as `passes_culled` says, and say nothing
};

/// Opacity of a triangle at a point, [0, 1].
using OpacityFunction = float (*)(const void* world, std::uint32_t geometry, std::uint32_t triangle, Vec2f barycentric);

struct EmbreeGeometryMaker;
struct EmbreeShape;

/// Owns the Embree device and scenes. Baked geometry sits in the top-level scene; a shared mesh has a scene of its own,
/// built once, and instances in the top-level one.
class EmbreeScene {
  public:
    /// Builds all BVHs with the threads of `threads`. The geometries' vectors must stay where they are: Embree reads
    /// them. `filters` are those of the geometries. If there are `collected` slots, the scene holds no more than these,
    /// and is for `collect` alone; of meshes that several instances share it holds all.
    EmbreeScene(std::span<const Geometry> geometries, std::span<const Instance> instances,
                std::span<const TransformMotion> motions, std::span<const HitFilter> filters, const ThreadPool& threads,
                std::vector<CollectedSlot> collected = {});
    ~EmbreeScene();

    /// Called once the World has its final address.
    void set_opacity(OpacityFunction function, const void* world);

    void intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                   RayEnds ends = RayEnds::InScene) const;
    void intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                   RayEnds ends = RayEnds::InScene) const;
    /// See SceneGeometry::occluded.
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form,
                  RayEnds ends = RayEnds::InScene) const;
    void occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form,
                  RayEnds ends = RayEnds::InScene) const;

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
    /// True if anything moves while the shutter is open.
    [[nodiscard]] bool has_motion() const { return has_motion_; }

    /// Returns what Embree's numbers stand for.
    [[nodiscard]] const EmbreeEntries& entries() const { return entries_; }
    [[nodiscard]] float opacity(std::uint32_t geometry, std::uint32_t triangle, Vec2f barycentric) const {
        return opacity_(world_, geometry, triangle, barycentric);
    }

  private:
    /// Adds all instances to the top-level scene, and the meshes that some share.
    void add_instances(const EmbreeGeometryMaker& maker, std::span<const Instance> instances,
                       std::span<const TransformMotion> motions);
    /// Returns whether the scene holds anything of the instance's geometry with this number.
    [[nodiscard]] bool is_taken(const Instance& instance, std::uint32_t geometry) const;

    // A `Batch` is a span of rays or RayColumns.
    template <typename Batch>
    void intersect_batch(const Batch& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                         RayEnds ends) const;
    template <typename Batch>
    void intersect_single(const Batch& rays, std::span<Hit> hits, RayEnds ends) const;
    template <std::size_t Width, typename Batch>
    void intersect_packets(const Batch& rays, std::span<Hit> hits, bool coherent, RayEnds ends) const;
    template <typename Batch>
    void occluded_batch(const Batch& rays, std::span<std::uint8_t> occluded, QueryForm form, RayEnds ends) const;
    template <typename Batch>
    void occluded_single(const Batch& rays, std::span<std::uint8_t> occluded, RayEnds ends) const;
    template <std::size_t Width, typename Batch>
    void occluded_packets(const Batch& rays, std::span<std::uint8_t> occluded, RayEnds ends) const;
    /// Whether packets of such rays are traced with Embree's coherent traversal. It pays within one level (4 to 5 times
    /// a single ray against 1.8 on the Cornell box) and costs where packets meet instances (0.8 against 1.4 on ten
    /// thousand of them).
    [[nodiscard]] bool takes_as_coherent(Coherence coherence) const;

    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    template <typename Handle>
    using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

    EmbreeEntries entries_;
    OpacityFunction opacity_ = nullptr;
    const void* world_ = nullptr;
    std::atomic<std::size_t> bytes_ = 0;
    double build_seconds_ = 0.0;
    bool has_motion_ = false;
    bool collects_ = false;
    std::vector<CollectedSlot> collected_;
    std::deque<std::vector<std::array<std::uint32_t, 3>>> collected_indices_;
    std::vector<std::unique_ptr<const EmbreeShape>> shapes_;  ///< to which Embree points
    bool has_clear_surfaces_ = false;
    // Last, since they point to what is above until they are released.
    Owned<RTCDevice> device_;
    Owned<RTCScene> top_;
    std::vector<Owned<RTCScene>> shared_;
};

}  // namespace etendue
