// One interface for all that finds where rays meet triangles. Read this file first, then one structure after the other.
#pragma once

#include "core/bounds.h"
#include "core/ray.h"
#include "scene/accelerator_kind.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

namespace etendue {

/// Holds the corners of a triangle, metres, in the space of the rays.
struct Triangle {
    Vec3f a, b, c;
};

/// Returns the box around `triangle`.
[[nodiscard]] inline Bounds bounds_of(const Triangle& triangle) {
    Bounds bounds;
    for (const Vec3f& corner : {triangle.a, triangle.b, triangle.c}) bounds.extend(corner);
    return bounds;
}

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// Holds where a ray meets a triangle.
struct TriangleHit {
    float t = std::numeric_limits<float>::infinity();  ///< metres along the ray
    float u = 0.0f, v = 0.0f;                          ///< barycentric coordinates of the second and third corner
    std::uint32_t triangle = kNoTriangle;              ///< index; kNoTriangle if nothing was met

    [[nodiscard]] bool valid() const { return triangle != kNoTriangle; }
    friend bool operator==(const TriangleHit&, const TriangleHit&) = default;
};

/// Counts what rays have made a structure do.
struct RayWork {
    std::uint64_t nodes = 0;      ///< boxes of a tree, or cells of a grid, that rays went into
    std::uint64_t triangles = 0;  ///< tests of a ray against a triangle, or against a shape without triangles

    void add(const RayWork& other) {
        nodes += other.nodes;
        triangles += other.triangles;
    }
};

/// Decides which of the triangles that a ray meets stop it, and must decide the same however often it is asked.
class TriangleFilter {
  public:
    virtual ~TriangleFilter() = default;
    [[nodiscard]] virtual bool stops(const TriangleHit& hit) = 0;
};

/// Measures a structure that is built.
struct AcceleratorStatistics {
    double build_seconds = 0.0;
    std::size_t bytes = 0;       ///< bytes of the structure, without the triangles
    std::size_t nodes = 0;       ///< nodes of a tree, or cells of a grid
    std::size_t references = 0;  ///< how often leaves and cells name a triangle; more than there are if space is split
    int depth = 0;               ///< levels from the root to the deepest leaf
};

class RaySearch;

/// Finds where rays meet triangles. All structures have the same triangle test and prefer the first of triangles that
/// are equally far away, so that they find the same hits, bit by bit.
class Accelerator {
  public:
    virtual ~Accelerator() = default;

    /// Builds the structure over `triangles`, which have to stay where they are.
    void build(std::span<const Triangle> triangles);
    /// Returns the nearest hit within (0, ray.t_max], of the triangles that `filter` (or null) lets stop the ray.
    [[nodiscard]] TriangleHit closest_hit(const Ray& ray, TriangleFilter* filter, RayWork& work) const;
    /// Returns true if there is any such hit; which triangles are asked until then depends on the structure.
    [[nodiscard]] bool any_hit(const Ray& ray, TriangleFilter* filter, RayWork& work) const;
    /// Returns what building has taken and made.
    [[nodiscard]] AcceleratorStatistics statistics() const;

  protected:
    // What a structure is: three functions in a file of its own.

    /// Makes the structure over `triangles`.
    virtual void make(std::span<const Triangle> triangles) = 0;
    /// Hands `search` all triangles that its ray may still meet, those of nearer places first, until it is over.
    virtual void trace(RaySearch& search) const = 0;
    /// Returns what was made, without the time.
    [[nodiscard]] virtual AcceleratorStatistics measure() const = 0;

  private:
    double build_seconds_ = 0.0;
};

/// Builds the structure `kind`, any but Embree, over `triangles`, which have to stay where they are.
[[nodiscard]] std::unique_ptr<const Accelerator> build_accelerator(AcceleratorKind kind,
                                                                   std::span<const Triangle> triangles);

}  // namespace etendue
