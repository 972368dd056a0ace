#include "scene/transform.h"
#include "scene/validate_parts.h"

#include <algorithm>

namespace etendue {

namespace {

// Loaders normalise in single precision; this leaves room for their rounding.
constexpr float kUnitTolerance = 1e-3f;

bool is_unit(const Vec3f& v) {
    return std::abs(length_squared(v) - 1.0f) <= 2.0f * kUnitTolerance;
}

bool is_finite_uv(const Vec2f& uv) {
    return std::isfinite(uv.x) && std::isfinite(uv.y);
}

bool is_good_tangent(const Vec4f& t) {
    return is_unit({t.x, t.y, t.z}) && (t.w == 1.0f || t.w == -1.0f);
}

bool is_good_color(const Vec4f& c) {
    const float parts[] = {c.x, c.y, c.z, c.w};
    return std::ranges::all_of(parts, [](float v) { return std::isfinite(v) && v >= 0.0f; });
}

/// One error if the array has the wrong length, one if any element is bad.
template <typename T, typename IsGood>
void validate_attribute(const std::vector<T>& values, std::size_t vertices, bool may_be_empty, std::string_view name,
                        std::string_view rule, const IsGood& is_good, const SourceLocation& where,
                        ProblemList& problems) {
    if (values.empty() && may_be_empty) return;
    if (values.size() != vertices) {
        problems.error(where, fmt::format("{} {} for {} vertices", values.size(), name, vertices));
    }
    const auto bad = std::ranges::find_if_not(values, is_good);
    if (bad != values.end()) {
        problems.error(where, fmt::format("{} {} {}", name, bad - values.begin(), rule));
    }
}

void validate_vertex_motion(const PrimitiveDesc& p, ProblemList& problems) {
    if (p.motion.empty()) return;
    if (p.motion.size() < 2 || p.motion.size() > kMaxMotionSteps)
        problems.error(p.location,
                       fmt::format("{} steps of motion, but there must be 2 to {}", p.motion.size(), kMaxMotionSteps));
    const auto finite = [](const Vec3f& v) { return is_finite(v); };
    for (const VertexStep& step : p.motion) {
        validate_attribute(step.positions, p.positions.size(), false, "moving positions", "is not finite", finite,
                           p.location, problems);
        validate_attribute(step.normals, p.positions.size(), p.normals.empty(), "moving normals",
                           "is not of unit length", is_unit, p.location, problems);
    }
}

void validate_shape(const PrimitiveDesc& p, ProblemList& problems) {
    const Vec3f& half = p.shape->half_size;
    if (!is_finite(half) || !(half.x > 0.0f) || !(half.y > 0.0f) || !(is_flat(p.shape->kind) || half.z > 0.0f))
        problems.error(p.location, fmt::format("the size of a {} is not above 0", shape_name(p.shape->kind)));
    if (!p.triangles.empty() || !p.normals.empty() || !p.tangents.empty() || !p.uv0.empty() || !p.uv1.empty() ||
        !p.colors.empty() || !p.motion.empty() || p.positions != p.shape->corners())
        problems.error(p.location, "a shape has other vertices than the corners of its box");
}

void validate_primitive(const PrimitiveDesc& p, const SceneDesc& scene, ProblemList& problems) {
    const std::size_t n = p.positions.size();
    const auto finite = [](const Vec3f& v) { return is_finite(v); };
    validate_attribute(p.positions, n, true, "positions", "is not finite", finite, p.location, problems);
    validate_attribute(p.normals, n, true, "normals", "is not of unit length", is_unit, p.location, problems);
    validate_attribute(p.tangents, n, true, "tangents", "is not of unit length with w = 1 or -1", is_good_tangent,
                       p.location, problems);
    validate_attribute(p.uv0, n, true, "texture coordinates 0", "is not finite", is_finite_uv, p.location, problems);
    validate_attribute(p.uv1, n, true, "texture coordinates 1", "is not finite", is_finite_uv, p.location, problems);
    validate_attribute(p.colors, n, true, "vertex colours", "is negative or not finite", is_good_color, p.location,
                       problems);

    validate_vertex_motion(p, problems);
    if (p.shape)
        validate_shape(p, problems);
    else if (p.triangles.empty())
        problems.error(p.location, "a primitive without triangles");
    const auto in_range = [n](const std::array<std::uint32_t, 3>& t) { return t[0] < n && t[1] < n && t[2] < n; };
    const auto bad = std::ranges::find_if_not(p.triangles, in_range);
    if (bad != p.triangles.end()) {
        problems.error(p.location, fmt::format("triangle {} ({}, {}, {}) refers to a vertex beyond the {} there are",
                                               bad - p.triangles.begin(), (*bad)[0], (*bad)[1], (*bad)[2], n));
    }
    check_handle(p.material, scene.materials, "material", p.location, problems);
    for (const VariantMaterial& v : p.variants)
        check_handle(v.material, scene.materials, "material of a variant", p.location, problems);
}

}  // namespace

void check_motion(const TransformMotion& motion, const SourceLocation& where, ProblemList& problems) {
    if (motion.empty()) return;
    if (motion.size() < 2 || motion.size() > kMaxMotionSteps)
        problems.error(where,
                       fmt::format("{} steps of motion, but there must be 2 to {}", motion.size(), kMaxMotionSteps));
    if (!std::ranges::all_of(motion, is_invertible))
        problems.error(where, "a transform of the motion is singular, not affine or not finite");
}

void validate_meshes(const SceneDesc& scene, ProblemList& problems) {
    for (const MeshDesc& mesh : scene.meshes) {
        for (const PrimitiveDesc& primitive : mesh.primitives) validate_primitive(primitive, scene, problems);
    }
}

void validate_instances(const SceneDesc& scene, ProblemList& problems) {
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        if (scene.nodes[n].parent != NodeDesc::kNone && scene.nodes[n].parent >= n)
            problems.error({scene.file.string(), {}}, fmt::format("node {} stands before its parent", n));
    for (const InstanceDesc& instance : scene.instances) {
        check_handle(instance.mesh, scene.meshes, "mesh", instance.location, problems);
        if (!is_invertible(instance.to_world)) {
            problems.error(instance.location, "the transform is singular, not affine or not finite");
        }
        check_motion(instance.motion, instance.location, problems);
        if (instance.node != NodeDesc::kNone && instance.node >= scene.nodes.size())
            problems.error(instance.location, fmt::format("node {} does not exist", instance.node));
    }
}

}  // namespace etendue
