// How far a scene may reach.

#include "scene/validate_parts.h"

#include <algorithm>
#include <span>

namespace etendue {

namespace {

/// The farthest that any place of the scene may be from the origin of a mesh that has a transform of its own, in the
/// mesh's units: Embree takes rays there, and takes none from beyond 1.8e18.
constexpr double kFarthestInMesh = 1e18;

double largest_coordinate(const Vec3f& v) {
    return static_cast<double>(max_abs(v));
}

Vec3f place_of(const Mat4f& to_world) {
    return {to_world[3][0], to_world[3][1], to_world[3][2]};
}

/// Bounds of a mesh in its own space at all moments.
Bounds bounds_of(const MeshDesc& mesh) {
    Bounds bounds;
    const auto extend = [&](const std::vector<Vec3f>& positions) {
        for (const Vec3f& p : positions) bounds.extend(p);
    };
    for (const PrimitiveDesc& primitive : mesh.primitives) {
        extend(primitive.positions);
        for (const VertexStep& step : primitive.motion) extend(step.positions);
    }
    return bounds;
}

/// The largest coordinate, without its sign, that a place in `bounds` can have in the world.
double reach(const Bounds& bounds, const Mat4f& to_world) {
    const Vec3d size(std::max(std::abs(bounds.min.x), std::abs(bounds.max.x)),
                     std::max(std::abs(bounds.min.y), std::abs(bounds.max.y)),
                     std::max(std::abs(bounds.min.z), std::abs(bounds.max.z)));
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) {
        const auto element = [&](int row) { return std::abs(static_cast<double>(to_world[row][column])); };
        largest = std::max(largest, size.x * element(0) + size.y * element(1) + size.z * element(2) + element(3));
    }
    return largest;
}

/// Keeps the farthest that anything reaches, and reports what reaches too far.
class Extent {
  public:
    explicit Extent(ProblemList& problems) : problems_(problems) {}

    void extend(double reach, std::string_view what, const SourceLocation& where) {
        farthest_ = std::max(farthest_, std::min(reach, kFarthest));
        if (!(reach <= kFarthest))
            problems_.error(where, fmt::format("{} reaches {:.3g} m from the scene's origin, but must stay within "
                                               "{:.0e} m",
                                               what, reach, kFarthest));
    }

    /// Returns how far anything reaches, metres.
    [[nodiscard]] double farthest() const { return farthest_; }

  private:
    ProblemList& problems_;
    double farthest_ = 0.0;
};

/// Calls `use` with the transform of `thing` at each moment there is.
template <typename Thing, typename Use>
void for_each_transform(const Thing& thing, const Use& use) {
    use(thing.to_world);
    for (const Mat4f& step : thing.motion) use(step);
}

/// Bounds how far the scene's places are from the origin of the mesh's space: at most this times their largest
/// coordinate.
double growth_in_mesh(const Mat4f& to_world) {
    const Imath::M44d to_mesh = Imath::M44d(to_world).inverse();
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        largest = std::max(largest,
                           std::abs(to_mesh[0][column]) + std::abs(to_mesh[1][column]) + std::abs(to_mesh[2][column]));
    return largest;
}

}  // namespace

void validate_extent(const SceneDesc& scene, ProblemList& problems) {
    std::vector<Bounds> meshes;
    meshes.reserve(scene.meshes.size());
    for (const MeshDesc& mesh : scene.meshes) meshes.push_back(bounds_of(mesh));

    Extent extent(problems);
    for (const InstanceDesc& instance : scene.instances) {
        const Bounds& bounds = meshes[static_cast<std::size_t>(instance.mesh.index)];
        if (bounds.empty()) continue;
        double farthest = 0.0;
        for_each_transform(instance, [&](const Mat4f& m) { farthest = std::max(farthest, reach(bounds, m)); });
        extent.extend(farthest, "the mesh", instance.location);
    }
    const double aspect = static_cast<double>(scene.settings.film.aspect());
    for (const CameraDesc& camera : scene.cameras) {
        const double widest = std::max(1.0, 1.0 / static_cast<double>(camera.aperture.ratio));
        double size = static_cast<double>(camera.lens_radius) * widest;
        if (camera.type == CameraType::Orthographic)
            size = static_cast<double>(camera.ymag) * std::max(1.0, aspect) *
                   (1.0 + 2.0 * static_cast<double>(std::max(std::abs(camera.shift.x), std::abs(camera.shift.y))));
        double place = 0.0;
        for_each_transform(camera, [&](const Mat4f& m) { place = std::max(place, largest_coordinate(place_of(m))); });
        extent.extend(place + size, "the camera's view", camera.location);
        if (camera.lens_radius > 0.0f)
            extent.extend(static_cast<double>(camera.focus_distance), "the camera's focus", camera.location);
        extent.extend(static_cast<double>(camera.clip.start), "the camera's clipping", camera.location);
    }
    for (const LightDesc& light : scene.lights)
        for_each_transform(light, [&](const Mat4f& m) {
            extent.extend(largest_coordinate(place_of(m)), "the light", light.location);
        });

    for (const InstanceDesc& instance : scene.instances) {
        double growth = 0.0;
        for_each_transform(instance, [&](const Mat4f& m) { growth = std::max(growth, growth_in_mesh(m)); });
        if (growth * std::max(extent.farthest(), 1.0) > kFarthestInMesh)
            problems.error(instance.location,
                           fmt::format("the transform shrinks the mesh so much that a scene of {:.3g} m is too large "
                                       "in the mesh's own space",
                                       extent.farthest()));
    }
}

}  // namespace etendue
