// What `etendue profile --accelerators` has measured: the structures of accelerator/ beside Embree, on the same rays.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace etendue {

/// Holds what a structure did with rays. Embree does not tell what it visits, which then is NaN.
struct TracedRays {
    std::uint64_t rays = 0;
    double rays_per_second = 0.0;                             ///< rays that one thread traces in a second, one by one
    double nodes = std::numeric_limits<double>::quiet_NaN();  ///< boxes or cells that a ray goes into, the mean
    double triangles = std::numeric_limits<double>::quiet_NaN();  ///< triangles that a ray is tested against, the mean
};

/// Adds a kind of rays, and how what they met compares with Embree's.
struct TracedKind {
    std::string kind{};
    TracedRays traced{};
    std::uint64_t ties = 0;    ///< rays that met another triangle, as far away but for rounding
    std::uint64_t differ = 0;  ///< rays that differ more than that
};

/// Measures one structure that was built over the scene.
struct AcceleratorMeasure {
    std::string name{};
    std::uint64_t triangles = 0;
    double build_seconds = 0.0;
    std::uint64_t bytes = 0;       ///< bytes without the triangles
    std::uint64_t nodes = 0;       ///< nodes of a tree, or cells of a grid; 0 where it is not told
    std::uint64_t references = 0;  ///< how often leaves or cells name a triangle; 0 where it is not told
    int depth = 0;
    std::vector<TracedKind> kinds{};
    std::string picture{};  ///< name of the EXR with nodes and triangles of a camera ray through each pixel; or empty
    /// Nodes that the last colour of its picture stands for; the first is 0.
    double picture_high = std::numeric_limits<double>::quiet_NaN();
};

/// Measures one structure over a surface of so many triangles.
struct GrowthPoint {
    std::string name{};
    std::uint64_t triangles = 0;
    double build_seconds = 0.0;
    std::uint64_t bytes = 0;
    TracedRays traced{};
};

struct AcceleratorReport {
    std::vector<AcceleratorMeasure> measures{};
    std::vector<GrowthPoint> growth{};  ///< by triangles, then in the order of `measures`
};

/// Tables for a terminal, of at most 100 columns.
[[nodiscard]] std::string to_table(const AcceleratorReport& report);

}  // namespace etendue
