#include "world/compile_parts.h"
#include "world/lookup.h"
#include "world/tangent_space.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace etendue {

namespace {

Geometry take_geometry(PrimitiveDesc& primitive) {
    Geometry geometry;
    geometry.positions = std::move(primitive.positions);
    // Embree reads 16 bytes at each vertex, so one float beyond the last must be ours.
    geometry.positions.reserve(geometry.positions.size() + 1);
    geometry.normals = std::move(primitive.normals);
    geometry.tangents = std::move(primitive.tangents);
    geometry.uv0 = std::move(primitive.uv0);
    geometry.uv1 = std::move(primitive.uv1);
    // Colours that are all white multiply by one, so they are not stored.
    if (std::ranges::any_of(primitive.colors, [](const Vec4f& color) { return color != Vec4f(1.0f); }))
        geometry.colors = std::move(primitive.colors);
    geometry.triangles = std::move(primitive.triangles);
    geometry.motion = std::move(primitive.motion);
    for (VertexStep& step : geometry.motion) step.positions.reserve(step.positions.size() + 1);
    geometry.material = static_cast<std::uint32_t>(primitive.material.index);
    if (primitive.shape && primitive.shape->kind == ShapeKind::Rectangle) {
        // Seen from its front, which looks along -z, the image stands upright.
        geometry.triangles = {{0, 2, 1}, {1, 2, 3}};
        geometry.uv0 = geometry.uv1 = {{1.0f, 1.0f}, {0.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
    } else if (primitive.shape) {
        Mat4f size;
        size.setScale(primitive.shape->half_size);
        geometry.shape = ExactShape(primitive.shape->kind, size);
    }
    return geometry;
}

/// Copies of the elements of `values` that `source` names.
template <typename T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& source) {
    if (values.empty()) return;
    std::vector<T> gathered;
    gathered.reserve(source.size() + 1);  // one more, as for positions
    for (const std::uint32_t i : source) gathered.push_back(values[i]);
    values = std::move(gathered);
}

/// The vertices that `source` names, in its order, in place of those there are. Tangents are not among them.
void gather_vertices(Geometry& geometry, const std::vector<std::uint32_t>& source) {
    gather(geometry.positions, source);
    gather(geometry.normals, source);
    gather(geometry.uv0, source);
    gather(geometry.uv1, source);
    gather(geometry.colors, source);
    for (VertexStep& step : geometry.motion) {
        gather(step.positions, source);
        gather(step.normals, source);
    }
}

/// Gives every triangle three vertices of its own, with its normal: flat triangles have no common tangents.
void separate_triangles(Geometry& geometry) {
    std::vector<std::uint32_t> source;
    source.reserve(3 * geometry.triangles.size());
    for (auto& triangle : geometry.triangles) {
        for (std::uint32_t& vertex : triangle) {
            source.push_back(vertex);
            vertex = static_cast<std::uint32_t>(source.size() - 1);
        }
    }
    gather_vertices(geometry, source);
    geometry.normals.reserve(source.size());
    for (const auto& [a, b, c] : geometry.triangles) {
        const std::vector<Vec3f>& p = geometry.positions;
        const Vec3f normal = triangle_normal(p[b] - p[a], p[c] - p[a]);
        geometry.normals.insert(geometry.normals.end(), 3, normal);
    }
}

/// Tangents along the image of `slot` as it lies on the mesh, its transform included.
void add_tangents(Geometry& geometry, const TextureSlot& slot) {
    std::vector<Vec2f>& texcoords = slot.texcoord == 1 ? geometry.uv1 : geometry.uv0;
    if (texcoords.empty()) return;
    if (geometry.normals.empty()) separate_triangles(geometry);
    std::vector<Vec2f> uv = texcoords;
    for (Vec2f& c : uv) {
        c = transform_point(slot, c);
        // Both are finite, but not all that they make together; what is sorted by them must be.
        if (!std::isfinite(c.x) || !std::isfinite(c.y)) c = {0.0f, 0.0f};
    }
    TangentVertices vertices = generate_tangents(geometry.positions, geometry.normals, uv, geometry.triangles);
    geometry.tangents = std::move(vertices.tangents);
    geometry.triangles = std::move(vertices.triangles);
    if (vertices.source.size() == geometry.positions.size()) return;
    gather_vertices(geometry, vertices.source);
}

bool mirrors(const Mat4f& m) {
    const Vec3f x(m[0][0], m[0][1], m[0][2]);
    const Vec3f y(m[1][0], m[1][1], m[1][2]);
    const Vec3f z(m[2][0], m[2][1], m[2][2]);
    return dot(cross(x, y), z) < 0.0f;
}

Vec3f normalized_or_zero(const Vec3f& v) {
    const float l = length(v);
    return l > 0.0f ? v * (1.0f / l) : v;
}

/// Moves a mesh to world space. A mirroring transform turns the winding around, which is put right here, so that the
/// front stays the front (glTF 2.0, section 3.7.4).
void bake(Geometry& geometry, const Mat4f& to_world) {
    if (geometry.shape) {
        geometry.shape = geometry.shape->placed(to_world);
        const Bounds bounds = geometry.shape->bounds();
        geometry.positions.clear();
        for (const Vec3f& corner : {bounds.min, bounds.max}) geometry.positions.push_back(corner);
        return;
    }
    const Mat4f to_local = to_world.inverse();
    const bool mirrored = mirrors(to_world);
    const auto bake_vertices = [&](std::vector<Vec3f>& positions, std::vector<Vec3f>& normals) {
        for (Vec3f& p : positions) p = transform_point(to_world, p);
        for (Vec3f& n : normals) n = normalized_or_zero(transform_normal(to_local, n));
    };
    bake_vertices(geometry.positions, geometry.normals);
    for (VertexStep& step : geometry.motion) bake_vertices(step.positions, step.normals);
    for (Vec4f& t : geometry.tangents) {
        const Vec3f world = normalized_or_zero(transform_vector(to_world, {t.x, t.y, t.z}));
        t = {world.x, world.y, world.z, mirrored ? -t.w : t.w};
    }
    if (mirrored)
        for (auto& triangle : geometry.triangles) std::swap(triangle[1], triangle[2]);
}

/// A copy with what Embree reads beyond the last vertex.
Geometry copied(const Geometry& geometry) {
    Geometry copy = geometry;
    copy.positions.reserve(copy.positions.size() + 1);
    return copy;
}

/// Which meshes that stay where and as they are have copies at all of their places: those whose copies have the fewest
/// triangles, `most_copied` together. `uses` counts the places of each mesh.
std::vector<bool> meshes_to_copy(const SceneDesc& scene, std::span<const std::uint32_t> uses, std::size_t most_copied) {
    std::vector<bool> moves(scene.meshes.size(), false);
    for (const InstanceDesc& desc : scene.instances)
        if (!desc.motion.empty()) moves[static_cast<std::size_t>(desc.mesh.index)] = true;
    struct Candidate {
        std::size_t triangles;  ///< triangles of all copies together
        std::size_t mesh;
    };
    std::vector<Candidate> candidates;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        if (uses[m] < 2 || moves[m]) continue;
        // Steps of motion would count many times, and vertices that no triangle has do not count at all.
        std::size_t triangles = 0;
        bool can_be_copied = true;
        for (const PrimitiveDesc& primitive : scene.meshes[m].primitives) {
            triangles += primitive.triangles.size();
            can_be_copied = can_be_copied && primitive.motion.empty() &&
                            (primitive.shape || primitive.positions.size() <= 3 * primitive.triangles.size());
        }
        if (can_be_copied) candidates.push_back({triangles * (uses[m] - 1), m});
    }
    std::ranges::stable_sort(candidates, {}, &Candidate::triangles);
    std::vector<bool> is_copied(scene.meshes.size(), false);
    std::size_t sum = 0;
    for (const Candidate& candidate : candidates) {
        if (candidate.triangles > most_copied - sum) break;
        sum += candidate.triangles;
        is_copied[candidate.mesh] = true;
    }
    return is_copied;
}

Bounds bounds_of(const Geometry& geometry) {
    Bounds bounds;
    for (const Vec3f& p : geometry.positions) bounds.extend(p);
    for (const VertexStep& step : geometry.motion)
        for (const Vec3f& p : step.positions) bounds.extend(p);
    return bounds;
}

/// `local_bounds` are those of every geometry, in the space it is stored in.
void extend_bounds(const Instance& instance, std::span<const Mat4f> transforms, const std::vector<Bounds>& local_bounds,
                   Bounds& world) {
    for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
        const Bounds& local = local_bounds[instance.first_geometry + g];
        if (instance.baked || local.empty()) {
            world.extend(local);
            continue;
        }
        for (const Mat4f& to_world : transforms) world.extend(placed(local, to_world));
    }
}

/// Moves the meshes that have a place into `data`, with tangents. Returns the first geometry of each mesh.
std::vector<std::uint32_t> take_meshes(SceneDesc& scene, std::span<const std::uint32_t> uses, const ThreadPool& threads,
                                       WorldData& data) {
    std::vector<std::uint32_t> first_geometry(scene.meshes.size(), 0);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        first_geometry[m] = static_cast<std::uint32_t>(data.geometries.size());
        if (uses[m] == 0) continue;
        for (PrimitiveDesc& primitive : scene.meshes[m].primitives) data.geometries.push_back(take_geometry(primitive));
    }
    threads.parallel_for(data.geometries.size(), [&](std::size_t g, int) {
        Geometry& geometry = data.geometries[g];
        const TextureSlot* texture = data.materials[geometry.material].tangent_texture();
        if (texture != nullptr && geometry.tangents.empty()) add_tangents(geometry, *texture);
    });
    return first_geometry;
}

/// Makes the instances, and the copies of meshes that some of them have to themselves.
void place_meshes(const SceneDesc& scene, std::span<const std::uint32_t> uses, const std::vector<bool>& is_copied,
                  std::span<const std::uint32_t> first_geometry, WorldData& data) {
    std::vector<std::uint32_t> places_left(uses.begin(), uses.end());  // the last place takes the mesh itself
    std::uint32_t light_slots = 0;
    for (const InstanceDesc& desc : scene.instances) {
        const auto mesh = static_cast<std::size_t>(desc.mesh.index);
        Instance instance;
        instance.first_geometry = first_geometry[mesh];
        instance.geometry_count = static_cast<std::uint32_t>(scene.meshes[mesh].primitives.size());
        if (is_copied[mesh] && --places_left[mesh] > 0) {
            instance.first_geometry = static_cast<std::uint32_t>(data.geometries.size());
            for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
                data.geometries.push_back(copied(data.geometries[first_geometry[mesh] + g]));
        }
        instance.first_light_slot = light_slots;
        light_slots += instance.geometry_count;
        instance.baked = (uses[mesh] == 1 && desc.motion.empty()) || is_copied[mesh];
        if (!instance.baked) {
            instance.to_world = desc.to_world;
            instance.to_local = desc.to_world.inverse();
            instance.mirrors = mirrors(desc.to_world);
        }
        if (!desc.motion.empty()) {
            instance.motion = static_cast<std::uint32_t>(data.motions.size());
            data.motions.push_back(desc.motion);
        }
        data.instances.push_back(instance);
    }
    data.light_of_slot.assign(light_slots, kNone);
}

void bake_instances(const SceneDesc& scene, const ThreadPool& threads, WorldData& data) {
    threads.parallel_for(data.instances.size(), [&](std::size_t i, int) {
        const Instance& instance = data.instances[i];
        if (!instance.baked) return;
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            bake(data.geometries[instance.first_geometry + g], scene.instances[i].to_world);
    });
}

/// Returns the diagonal of `bounds` where `to_world` places it, metres.
float placed_size(const Bounds& bounds, const Mat4f& to_world) {
    const Vec3f size = bounds.size();
    return std::hypot(length(transform_vector(to_world, {size.x, 0.0f, 0.0f})),
                      length(transform_vector(to_world, {0.0f, size.y, 0.0f})),
                      length(transform_vector(to_world, {0.0f, 0.0f, size.z})));
}

void bound_instances(const ThreadPool& threads, WorldData& data) {
    std::vector<Bounds> local_bounds(data.geometries.size());
    threads.parallel_for(data.geometries.size(),
                         [&](std::size_t g, int) { local_bounds[g] = bounds_of(data.geometries[g]); });
    data.size_of_slot.reserve(data.light_of_slot.size());
    for (const Instance& instance : data.instances) {
        const std::span<const Mat4f> here(&instance.to_world, 1);
        extend_bounds(instance, instance.motion == kNone ? here : data.motions[instance.motion], local_bounds,
                      data.bounds);
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            data.size_of_slot.push_back(placed_size(local_bounds[instance.first_geometry + g], instance.to_world));
    }
}

}  // namespace

void compile_geometry(SceneDesc& scene, const ThreadPool& threads, std::size_t most_copied, WorldData& data) {
    std::vector<std::uint32_t> uses(scene.meshes.size(), 0);
    for (const InstanceDesc& desc : scene.instances) ++uses[static_cast<std::size_t>(desc.mesh.index)];
    const std::vector<bool> is_copied = meshes_to_copy(scene, uses, most_copied);
    const std::vector<std::uint32_t> first_geometry = take_meshes(scene, uses, threads, data);
    place_meshes(scene, uses, is_copied, first_geometry, data);
    bake_instances(scene, threads, data);
    bound_instances(threads, data);
}

}  // namespace etendue
