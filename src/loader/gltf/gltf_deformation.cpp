#include "loader/gltf/gltf_deformation.h"

#include "loader/gltf/vertex_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

void add_scaled(std::vector<Vec3f>& values, const std::vector<Vec3f>& displacements, float weight) {
    if (values.size() != displacements.size()) return;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += displacements[i] * weight;
}

/// The mean of a vertex' joint matrices. Weights need not add up to 1; a vertex without any stays where it is.
Mat4d blend(const PrimitiveDeformation& deformation, std::size_t vertex, std::span<const Mat4d> joints) {
    Mat4d sum(0.0);
    double total = 0.0;
    for (std::size_t i = vertex * deformation.influences; i < (vertex + 1) * deformation.influences; ++i) {
        const auto weight = static_cast<double>(deformation.weights[i]);
        if (weight == 0.0) continue;
        sum += joints[deformation.joints[i]] * weight;
        total += weight;
    }
    return total > 0.0 ? sum * (1.0 / total) : Mat4d();
}

/// Triangles may lose their area in passing; vertices without a normal then have that of the primitive.
void finish_step(VertexStep& step, const PrimitiveDesc& primitive) {
    for (std::size_t i = 0; i < step.normals.size(); ++i) {
        const float squared = length_squared(step.normals[i]);
        step.normals[i] = std::isnormal(squared) ? step.normals[i] * (1.0f / std::sqrt(squared)) : primitive.normals[i];
    }
}

}  // namespace

bool MeshDeformation::is_skinned() const {
    return std::ranges::any_of(primitives, [](const PrimitiveDeformation& p) { return p.influences > 0; });
}

bool MeshDeformation::has_flat_triangles() const {
    return std::ranges::any_of(primitives, &PrimitiveDeformation::has_flat_triangles);
}

std::uint32_t PrimitiveDeformation::largest_joint() const {
    std::uint32_t largest = 0;
    for (std::size_t i = 0; i < joints.size(); ++i)
        if (weights[i] > 0.0f) largest = std::max(largest, joints[i]);
    return largest;
}

std::uint32_t MeshDeformation::largest_joint() const {
    std::uint32_t largest = 0;
    for (const PrimitiveDeformation& p : primitives) largest = std::max(largest, p.largest_joint());
    return largest;
}

void morph(PrimitiveDesc& primitive, const PrimitiveDeformation& deformation, std::span<const double> weights) {
    for (std::size_t i = 0; i < std::min(weights.size(), deformation.targets.size()); ++i) {
        const auto weight = static_cast<float>(weights[i]);
        if (weight == 0.0f) continue;
        const MorphTarget& target = deformation.targets[i];
        add_scaled(primitive.positions, target.positions, weight);
        add_scaled(primitive.normals, target.normals, weight);
        if (primitive.tangents.size() != target.tangents.size()) continue;
        for (std::size_t v = 0; v < target.tangents.size(); ++v) {
            const Vec3f d = target.tangents[v] * weight;
            Vec4f& t = primitive.tangents[v];
            t = {t.x + d.x, t.y + d.y, t.z + d.z, t.w};
        }
    }
}

void skin(PrimitiveDesc& primitive, const PrimitiveDeformation& deformation, std::span<const Mat4d> joints) {
    if (deformation.influences == 0) return;
    std::vector<bool> is_mirrored(primitive.positions.size());
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
        const Mat4d blended = blend(deformation, v, joints);
        const Mat4f matrix = to_float(blended);
        is_mirrored[v] = blended.determinant() < 0.0;
        primitive.positions[v] = transform_point(matrix, primitive.positions[v]);
        if (!primitive.normals.empty())
            primitive.normals[v] = transform_normal(to_float(blended.inverse()), primitive.normals[v]);
        if (primitive.tangents.empty()) continue;
        Vec4f& t = primitive.tangents[v];
        const Vec3f moved = transform_vector(matrix, {t.x, t.y, t.z});
        t = {moved.x, moved.y, moved.z, is_mirrored[v] ? -t.w : t.w};
    }
    // Joints that mirror turn the winding around; the front stays the front (glTF 2.0, section 3.7.4).
    for (auto& triangle : primitive.triangles)
        if (std::ranges::count_if(triangle, [&](std::uint32_t v) { return is_mirrored[v]; }) > 1)
            std::swap(triangle[1], triangle[2]);
}

bool finish_deformation(PrimitiveDesc& primitive) {
    const auto all_finite = [](const std::vector<Vec3f>& positions) {
        return std::ranges::all_of(positions, [](const Vec3f& p) { return is_finite(p); });
    };
    if (!all_finite(primitive.positions) ||
        !std::ranges::all_of(primitive.motion, [&](const VertexStep& step) { return all_finite(step.positions); }))
        return false;
    const std::size_t removed = remove_degenerate_triangles(primitive.triangles, primitive.positions);
    if (primitive.triangles.empty()) return false;
    // The generator wants every vertex to be used.
    if (removed > 0) {
        const std::vector<std::uint32_t> kept = compact_vertices(primitive.triangles, primitive.positions.size());
        const auto gather = [&kept](auto& values) {
            if (values.empty()) return;
            for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
            values.resize(kept.size());
        };
        gather(primitive.positions);
        gather(primitive.normals);
        gather(primitive.tangents);
        gather(primitive.uv0);
        gather(primitive.uv1);
        gather(primitive.colors);
        for (VertexStep& step : primitive.motion) {
            gather(step.positions);
            gather(step.normals);
        }
    }
    normalize_normals(primitive.normals, primitive.triangles, primitive.positions);
    if (!normalize_tangents(primitive.tangents)) primitive.tangents.clear();
    for (VertexStep& step : primitive.motion) finish_step(step, primitive);
    return true;
}

}  // namespace etendue
