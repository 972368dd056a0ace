#include "world/tangent_space.h"

#include "core/frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace etendue {

namespace {

constexpr std::uint32_t kUnset = 0xffffffffu;

using TriangleIndices = std::array<std::uint32_t, 3>;

/// A number from 0 for all vertices that are equal.
std::vector<std::uint32_t> weld(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                std::span<const Vec2f> uv) {
    const auto key = [&](std::uint32_t v) {
        const Vec3f& p = positions[v];
        const Vec3f& n = normals[v];
        return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z, uv[v].x, uv[v].y);
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> welded(positions.size());
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && key(order[i - 1]) < key(order[i])) ++next;
        welded[order[i]] = next;
    }
    return welded;
}

/// For every edge of every triangle, edge e going from corner e to the next, the triangle on its other side. Of edges
/// with more than two sides, pairs that run in opposite directions are neighbours, first come first served.
std::vector<std::uint32_t> find_neighbours(std::span<const TriangleIndices> triangles,
                                           std::span<const std::uint32_t> welded) {
    struct Edge {
        std::uint32_t low, high;
        std::uint32_t side;  ///< 3 * triangle + edge
        bool is_forward;
    };
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t side = 0; side < 3 * triangles.size(); ++side) {
        const TriangleIndices& t = triangles[side / 3];
        const std::uint32_t a = welded[t[side % 3]];
        const std::uint32_t b = welded[t[(side + 1) % 3]];
        edges.push_back({std::min(a, b), std::max(a, b), side, a < b});
    }
    std::ranges::sort(edges, {}, [](const Edge& e) { return std::tuple(e.low, e.high, e.side); });
    std::vector<std::uint32_t> neighbours(edges.size(), kUnset);
    std::size_t waiting = 0;  // first edge of the run that has no neighbour yet; all that wait run in one direction
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& edge = edges[i];
        if (edges[waiting].low != edge.low || edges[waiting].high != edge.high) waiting = i;
        if (edges[waiting].is_forward == edge.is_forward) continue;
        neighbours[edge.side] = edges[waiting].side / 3;
        neighbours[edges[waiting].side] = edge.side / 3;
        do {
            ++waiting;
        } while (waiting <= i && neighbours[edges[waiting].side] != kUnset);
    }
    return neighbours;
}

/// How the texture lies on one triangle.
struct TriangleFrame {
    Vec3f along_u{0.0f};  ///< unit, in the triangle's plane
    bool is_mirrored = false;
    bool is_known = false;  ///< false if the triangle or its image has no area
};

TriangleFrame triangle_frame(const TriangleIndices& t, std::span<const Vec3f> positions, std::span<const Vec2f> uv) {
    const Vec3f e1 = positions[t[1]] - positions[t[0]];
    const Vec3f e2 = positions[t[2]] - positions[t[0]];
    const Vec2f d1 = uv[t[1]] - uv[t[0]];
    const Vec2f d2 = uv[t[2]] - uv[t[0]];
    const float area = d1.x * d2.y - d1.y * d2.x;
    TriangleFrame frame;
    frame.is_mirrored = !(area > 0.0f);
    const Vec3f u = e1 * d2.y - e2 * d1.y;
    const Vec3f v = e2 * d1.x - e1 * d2.x;
    if (!std::isnormal(area) || !std::isnormal(length_squared(u)) || !std::isnormal(length_squared(v))) return frame;
    frame.along_u = normalize(u) * (area > 0.0f ? 1.0f : -1.0f);
    frame.is_known = true;
    return frame;
}

Vec3f project(const Vec3f& v, const Vec3f& normal) {
    const Vec3f flat = v - normal * dot(normal, v);
    const float squared = length_squared(flat);
    return std::isnormal(squared) ? flat * (1.0f / std::sqrt(squared)) : Vec3f(0.0f);
}

class TangentGenerator {
  public:
    TangentGenerator(std::span<const Vec3f> positions, std::span<const Vec3f> normals, std::span<const Vec2f> uv,
                     std::span<const TriangleIndices> triangles)
        : positions_(positions),
          normals_(normals),
          triangles_(triangles),
          welded_(weld(positions, normals, uv)),
          neighbours_(find_neighbours(triangles, welded_)),
          group_of_corner_(3 * triangles.size(), kUnset),
          group_of_vertex_(positions.size(), kUnset) {
        frames_.reserve(triangles.size());
        for (const TriangleIndices& t : triangles) frames_.push_back(triangle_frame(t, positions, uv));
    }

    TangentVertices generate() {
        for (std::uint32_t corner = 0; corner < group_of_corner_.size(); ++corner)
            if (group_of_corner_[corner] == kUnset && frames_[corner / 3].is_known) grow_group(corner);
        // What no edge leads to takes any frame at its vertex.
        for (std::uint32_t corner = 0; corner < group_of_corner_.size(); ++corner)
            if (group_of_corner_[corner] == kUnset)
                group_of_corner_[corner] = group_of_vertex_[welded_[vertex_of(corner)]];
        return divide_vertices();
    }

  private:
    /// Makes a group of everything around the vertex at `corner` that shares its frame.
    void grow_group(std::uint32_t corner) {
        const std::uint32_t vertex = welded_[vertex_of(corner)];
        const bool is_mirrored = frames_[corner / 3].is_mirrored;
        const auto group = static_cast<std::uint32_t>(sums_.size());
        sums_.emplace_back(0.0f);
        is_mirrored_.push_back(is_mirrored);
        group_of_vertex_[vertex] = group;
        pending_.assign(1, corner / 3);
        while (!pending_.empty()) {
            const std::uint32_t triangle = pending_.back();
            pending_.pop_back();
            const std::uint32_t here = 3 * triangle + corner_at(triangle, vertex);
            if (group_of_corner_[here] != kUnset) continue;
            TriangleFrame& frame = frames_[triangle];
            // What has no direction of its own joins the first that comes, and is bound by that from then on.
            if (!frame.is_known && is_free(triangle)) frame.is_mirrored = is_mirrored;
            if (frame.is_mirrored != is_mirrored) continue;
            group_of_corner_[here] = group;
            add(here, sums_[group]);
            for (const std::uint32_t edge : {(here + 2) % 3 + 3 * triangle, here})
                if (neighbours_[edge] != kUnset) pending_.push_back(neighbours_[edge]);
        }
    }

    /// Adds the direction of u at a corner, weighted by the corner's angle in the plane of the vertex.
    void add(std::uint32_t corner, Vec3f& sum) const {
        if (!frames_[corner / 3].is_known) return;
        const TriangleIndices& t = triangles_[corner / 3];
        const std::uint32_t i = corner % 3;
        const Vec3f& n = normals_[t[i]];
        const Vec3f to_next = project(positions_[t[(i + 1) % 3]] - positions_[t[i]], n);
        const Vec3f to_previous = project(positions_[t[(i + 2) % 3]] - positions_[t[i]], n);
        const float angle = std::acos(std::clamp(dot(to_next, to_previous), -1.0f, 1.0f));
        sum += project(frames_[corner / 3].along_u, n) * angle;
    }

    [[nodiscard]] std::uint32_t vertex_of(std::uint32_t corner) const { return triangles_[corner / 3][corner % 3]; }
    [[nodiscard]] std::uint32_t corner_at(std::uint32_t triangle, std::uint32_t vertex) const {
        const TriangleIndices& t = triangles_[triangle];
        return welded_[t[0]] == vertex ? 0 : welded_[t[1]] == vertex ? 1 : 2;
    }
    [[nodiscard]] bool is_free(std::uint32_t triangle) const {
        return group_of_corner_[3 * triangle] == kUnset && group_of_corner_[3 * triangle + 1] == kUnset &&
               group_of_corner_[3 * triangle + 2] == kUnset;
    }

    [[nodiscard]] Vec4f tangent(std::uint32_t corner) const {
        const Vec3f& n = normals_[vertex_of(corner)];
        const std::uint32_t group = group_of_corner_[corner];
        Vec3f along_u = group == kUnset ? Vec3f(0.0f) : project(sums_[group], n);
        if (length_squared(along_u) == 0.0f) along_u = Frame::from_normal(n).tangent;
        // v grows downwards in glTF's images.
        return {along_u.x, along_u.y, along_u.z, group == kUnset || is_mirrored_[group] ? 1.0f : -1.0f};
    }

    [[nodiscard]] TangentVertices divide_vertices() const {
        constexpr std::uint32_t kUnused = 0xfffffffeu;
        TangentVertices result;
        result.tangents.resize(positions_.size(), Vec4f(1.0f, 0.0f, 0.0f, 1.0f));
        result.source.resize(positions_.size());
        std::iota(result.source.begin(), result.source.end(), 0u);
        result.triangles.assign(triangles_.begin(), triangles_.end());
        std::vector<std::uint32_t> first_group(positions_.size(), kUnused);
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;  // by vertex and group
        for (std::uint32_t corner = 0; corner < group_of_corner_.size(); ++corner) {
            const std::uint32_t vertex = vertex_of(corner);
            const std::uint32_t group = group_of_corner_[corner];
            if (first_group[vertex] == kUnused) {
                first_group[vertex] = group;
                result.tangents[vertex] = tangent(corner);
            }
            if (first_group[vertex] == group) continue;
            const auto [copy, is_new] =
                copies.try_emplace({vertex, group}, static_cast<std::uint32_t>(result.tangents.size()));
            if (is_new) {
                result.tangents.push_back(tangent(corner));
                result.source.push_back(vertex);
            }
            result.triangles[corner / 3][corner % 3] = copy->second;
        }
        return result;
    }

    std::span<const Vec3f> positions_;
    std::span<const Vec3f> normals_;
    std::span<const TriangleIndices> triangles_;
    std::vector<std::uint32_t> welded_;
    std::vector<std::uint32_t> neighbours_;
    std::vector<TriangleFrame> frames_;
    std::vector<std::uint32_t> group_of_corner_;
    std::vector<std::uint32_t> group_of_vertex_;  ///< by welded vertex, one of its groups
    std::vector<Vec3f> sums_;                     ///< sum for each group
    std::vector<bool> is_mirrored_;               ///< sum for each group
    std::vector<std::uint32_t> pending_;          ///< triangles to look at while a group grows
};

}  // namespace

TangentVertices generate_tangents(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                  std::span<const Vec2f> uv, std::span<const TriangleIndices> triangles) {
    return TangentGenerator(positions, normals, uv, triangles).generate();
}

}  // namespace etendue
