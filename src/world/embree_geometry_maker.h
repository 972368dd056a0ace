// Embree's geometries of ours.
#pragma once

#include "world/embree.h"
#include "world/embree_scene.h"
#include "world/embree_shape.h"
#include "world/geometry.h"

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Makes Embree's geometries of ours, with the flags and the quality of all scenes.
struct EmbreeGeometryMaker {
    RTCDevice device;
    std::span<const Geometry> geometries;
    std::span<const HitFilter> filters;  ///< filters of the geometries
    bool collects;                       ///< for `EmbreeScene::collect`
    std::deque<std::vector<std::array<std::uint32_t, 3>>>& collected_indices;
    std::vector<std::unique_ptr<const EmbreeShape>>& shapes;

    /// Returns an empty scene.
    [[nodiscard]] RTCScene new_scene() const;

    /// Adds geometry `index` to `scene`, or those of its triangles that `collected` names, if it is not null.
    void add_geometry(RTCScene scene, std::uint32_t index, const CollectedSlot* collected) const;

    /// Returns a scene of the mesh that `instance` shares with others.
    [[nodiscard]] RTCScene build_shared_scene(const Instance& instance) const;

    /// Places `shared` in `scene` as `instance` stands there.
    void add_instance(RTCScene scene, RTCScene shared, const Instance& instance,
                      std::span<const TransformMotion> motions) const;
};

/// Says in words how all BVHs are built.
[[nodiscard]] std::string bvh_quality();

}  // namespace etendue
