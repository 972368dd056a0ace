// Surfaces that lie within rounding of each other are met as one: glass that stands on a table, a drink in its glass, a
// lamp that is flush with the ceiling (docs/derivations.md, equation 23). build_bvh() finds out where there are any,
// since asking everywhere would take a third of a render's time. Rays that hit there ask for all surfaces in that place
// when they arrive, since what they do depends on the bodies they are in, and meet the first of:
//
//   1. an emitter that stops light, on a side that emits,
//   2. what stops light,
//   3. the boundary of bodies: all that are left are left, and all that are entered are entered,
//   4. thin sheets, where build_bvh() could not move them apart.
//
// Of several of one kind the first in the scene counts; a back that is culled comes last. Rays go on from beyond all of
// them, on either side.
#pragma once

#include "core/bounds.h"
#include "core/position_error.h"
#include "core/ray.h"
#include "core/ray_cone.h"
#include "core/vec.h"
#include "world/embree_scene.h"
#include "world/interior.h"
#include "world/surface_point.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace etendue {

struct Material;
struct WorldData;

/// A surface among those that a ray meets in one place.
struct ContactFace {
    Hit hit;
    Vec3f position{0.0f};    ///< metres
    Vec3f normal{0.0f};      ///< unit, geometric, on the front
    float clearance = 0.0f;  ///< metres, as in SurfacePoint
    float rounding = 0.0f;   ///< metres, as in TrianglePlane
    float depth = 0.0f;      ///< metres that it lies beyond the first face, along that one's normal
};

/// All surfaces that a ray meets in one place; the first is the one that it was said to hit.
struct Contact {
    static constexpr std::size_t kCapacity = 16;

    std::array<ContactFace, kCapacity> faces;
    std::size_t count = 0;

    [[nodiscard]] std::span<const ContactFace> all() const { return {faces.data(), count}; }
};

/// The bodies that a ray is in before a contact, and those behind it.
struct ContactInteriors {
    Interior before;
    Interior behind;
};

/// Returns the distance, metres, within which a point and a surface with these two clearances count as touching.
template <typename T>
[[nodiscard]] constexpr T point_contact_distance(T clearance, T other) {
    return T(2) * (clearance + other);
}
/// Returns the distance, metres, within which two surfaces with a clearance and a rounding count as one: rays cannot
/// tell nearer surfaces apart, neither where the rays start nor where they arrive.
template <typename Surface>
[[nodiscard]] constexpr auto contact_distance(const Surface& a, const Surface& b) {
    const auto rounding = std::min(a.rounding, b.rounding);
    return std::max(point_contact_distance(a.clearance, b.clearance), point_contact_distance(rounding, rounding));
}

/// Holds the plane of a triangle of an instance.
struct TrianglePlane {
    Vec3f normal{0.0f};      ///< unit, on the front; zero if the triangle has no area
    float clearance = 0.0f;  ///< distance from the plane that clears it, metres
    float rounding = 0.0f;   ///< error of the distance of a hit from several times the mesh's size away, metres
};
[[nodiscard]] TrianglePlane triangle_plane(const WorldData& data, std::uint32_t instance, std::uint32_t geometry,
                                           std::uint32_t triangle);

/// True if no light passes such a surface, but for what its opacity lets through.
[[nodiscard]] bool stops_light(const Material& material);
/// True if `material` is that of a thin sheet that light passes.
[[nodiscard]] bool is_sheet(const Material& material);

/// Where a surface touches others.
struct ContactSlot {
    static constexpr std::size_t kMostRegions = 16;

    float reach = 0.0f;           ///< metres within which others lie; 0 if none do
    std::vector<Bounds> regions;  ///< boxes in which what the surface touches lies
    bool is_anywhere = false;     ///< whether touching surfaces may lie in any place, as where things move

    /// Adds a place; boxes that are more than there may be become one.
    void add(const Bounds& place);
};

class Contacts {
  public:
    /// `slots` are those of every (instance, geometry).
    Contacts(const WorldData& data, std::vector<ContactSlot> slots, std::span<const HitFilter> filters,
             const ThreadPool& threads);

    /// Called once the World has its final address.
    void set_opacity(OpacityFunction function, const void* world) { bvh_->set_opacity(function, world); }
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] float reach(std::size_t slot) const { return slots_[slot].reach; }
    /// False if nothing touches the surface where `ray` hits it.
    [[nodiscard]] bool may_touch(std::size_t slot, const Ray& ray, float t) const {
        const Vec3f point = ray.origin + ray.direction * t;
        const Vec3f terms = abs_components(ray.origin);
        const float rounding = kPositionError * (t + terms.x + terms.y + terms.z);
        const auto is_within = [=](float value, float low, float high) {
            return value >= low - rounding && value <= high + rounding;
        };
        return slots_[slot].is_anywhere || std::ranges::any_of(slots_[slot].regions, [&](const Bounds& region) {
                   return is_within(point.x, region.min.x, region.max.x) &&
                          is_within(point.y, region.min.y, region.max.y) &&
                          is_within(point.z, region.min.z, region.max.z);
               });
    }
    /// All surfaces that `ray` meets where it hits `hit` (valid).
    [[nodiscard]] Contact at(const WorldData& data, const Ray& ray, const Hit& hit) const;

  private:
    std::vector<ContactSlot> slots_;
    std::unique_ptr<EmbreeScene> bvh_;  ///< hierarchy of the surfaces that have a reach
};

/// The surface of a contact that a ray along `direction` with these `ends` meets; the first if it passes all.
[[nodiscard]] const ContactFace& foremost(const WorldData& data, const Contact& contact, const Vec3f& direction,
                                          RayEnds ends = RayEnds::InScene);

/// Finds the bodies on both sides of a contact for a ray along `direction` that comes from within `current`.
[[nodiscard]] ContactInteriors interiors(const WorldData& data, const Contact& contact, const Interior& current,
                                         const Vec3f& direction);

/// Returns the surface of `face`, which `ray` with `cone` around it has hit, in the middle of all that touch there.
[[nodiscard]] SurfacePoint contact_point(const WorldData& data, const Contact& contact, const ContactFace& face,
                                         const Ray& ray, const RayCone& cone);

/// The face of the body with this number that a ray crosses for good: it is not entered and left again. Null if there
/// is none.
[[nodiscard]] const ContactFace* face_of_body(const WorldData& data, const Contact& contact, std::uint32_t body);

/// The bodies whose boundaries are among the faces, each once.
[[nodiscard]] std::vector<std::uint32_t> bodies_of(const WorldData& data, const Contact& contact);

/// Whether a ray crosses the boundary of a body in a contact inwards, outwards, or both.
struct BodyPassage {
    bool is_entered = false;
    bool is_left = false;
};
[[nodiscard]] BodyPassage passes(const WorldData& data, const Contact& contact, std::uint32_t body,
                                 const Vec3f& direction);

/// Index of (instance, geometry) in the tables of the World.
[[nodiscard]] std::size_t slot_of(const WorldData& data, std::uint32_t instance, std::uint32_t geometry);
[[nodiscard]] inline std::size_t slot_of(const WorldData& data, const Hit& hit) {
    return slot_of(data, hit.instance, hit.geometry);
}

/// Body of the surface, or kNone.
[[nodiscard]] std::uint32_t body_of(const WorldData& data, const Hit& hit);

}  // namespace etendue
