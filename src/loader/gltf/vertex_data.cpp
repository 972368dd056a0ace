#include "loader/gltf/vertex_data.h"

#include <algorithm>
#include <limits>

namespace etendue {

namespace {

Vec3d to_double(const Vec3f& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Twice the area times the unit normal. In double precision the differences of floats and their products are all but
/// exact, so that collinear points give zero.
Vec3d area_vector(const Triangle& t, std::span<const Vec3f> positions) {
    const Vec3d a = to_double(positions[t[0]]);
    return (to_double(positions[t[1]]) - a).cross(to_double(positions[t[2]]) - a);
}

}  // namespace

std::vector<Triangle> assemble_triangles(std::span<const std::uint32_t> indices, TriangleMode mode) {
    std::vector<Triangle> triangles;
    if (mode == TriangleMode::List) {
        triangles.reserve(indices.size() / 3);
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
        }
        return triangles;
    }
    if (indices.size() >= 3) triangles.reserve(indices.size() - 2);
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        if (mode == TriangleMode::Fan) {
            triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
        } else {
            triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
        }
    }
    return triangles;
}

bool is_degenerate(const Triangle& t, std::span<const Vec3f> positions) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
    const Vec3d a = to_double(positions[t[0]]);
    const Vec3d b = to_double(positions[t[1]]);
    const Vec3d c = to_double(positions[t[2]]);
    const double longest = std::max({(b - a).length2(), (c - b).length2(), (a - c).length2()});
    constexpr double kLeastHeight = 1e-9;
    // Also what single precision could not take a normal of.
    constexpr double kLeastArea = 1e-30;
    const double area = area_vector(t, positions).length();
    return !(area > kLeastHeight * longest) || area < kLeastArea;
}

std::size_t remove_degenerate_triangles(std::vector<Triangle>& triangles, std::span<const Vec3f> positions) {
    return std::erase_if(triangles, [&](const Triangle& t) { return is_degenerate(t, positions); });
}

std::vector<std::uint32_t> compact_vertices(std::vector<Triangle>& triangles, std::size_t vertex_count) {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renumbered(vertex_count, kUnused);
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t) renumbered[v] = 0;
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        if (renumbered[v] == kUnused) continue;
        renumbered[v] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(static_cast<std::uint32_t>(v));
    }
    for (Triangle& t : triangles) {
        for (std::uint32_t& v : t) v = renumbered[v];
    }
    return kept;
}

std::vector<Vec3f> area_weighted_normals(std::span<const Triangle> triangles, std::span<const Vec3f> positions) {
    std::vector<Vec3d> sums(positions.size(), Vec3d(0.0));
    std::vector<Vec3d> largest(positions.size(), Vec3d(0.0));
    for (const Triangle& t : triangles) {
        const Vec3d area = area_vector(t, positions);
        for (const std::uint32_t v : t) {
            sums[v] += area;
            if (area.length2() > largest[v].length2()) largest[v] = area;
        }
    }
    std::vector<Vec3f> normals(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        // Two sides of a sheet that share their vertices cancel out up to rounding.
        const bool cancels = sums[v].length() < 1e-6 * largest[v].length();
        const Vec3d n = (cancels ? largest[v] : sums[v]).normalized();
        normals[v] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
    }
    return normals;
}

std::size_t normalize_normals(std::vector<Vec3f>& normals, std::span<const Triangle> triangles,
                              std::span<const Vec3f> positions) {
    std::vector<Vec3f> generated;
    std::size_t bad = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const float squared = length_squared(normals[i]);
        if (std::isnormal(squared)) {
            normals[i] *= 1.0f / std::sqrt(squared);
            continue;
        }
        if (generated.empty()) generated = area_weighted_normals(triangles, positions);
        normals[i] = generated[i];
        ++bad;
    }
    return bad;
}

bool normalize_tangents(std::vector<Vec4f>& tangents) {
    for (Vec4f& t : tangents) {
        const float squared = t.x * t.x + t.y * t.y + t.z * t.z;
        if (!std::isnormal(squared)) return false;
        const float scale = 1.0f / std::sqrt(squared);
        t = {t.x * scale, t.y * scale, t.z * scale, t.w < 0.0f ? -1.0f : 1.0f};
    }
    return true;
}

}  // namespace etendue
