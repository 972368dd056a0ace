#include "world/scene_geometry.h"

#include "core/vector_bytes.h"
#include "world/accelerated_scene.h"
#include "world/cone_section.h"
#include "world/contacts.h"
#include "world/embree_scene.h"
#include "world/material_evaluation.h"
#include "world/materials.h"
#include "world/scattering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

namespace etendue {

namespace {

float opacity_callback(const void* data, std::uint32_t geometry, std::uint32_t triangle, Vec2f barycentric) {
    return evaluate_opacity(*static_cast<const WorldData*>(data), geometry, triangle, barycentric);
}

/// Most bytes of geometry and of the BVH over it that are expected to stay in a second-level cache. Less is not fetched
/// ahead.
constexpr std::size_t kCachedGeometry = std::size_t{2} << 20;

/// Puts the surfaces that rays meet in place of those that they hit, where several touch.
template <typename Batch>
void settle_contacts(const WorldData& data, const Materials& materials, const Batch& rays, std::span<Hit> hits,
                     RayEnds ends) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const std::size_t slot = slot_of(data, hits[i]);
        if (data.contacts->reach(slot) == 0.0f) continue;
        const Ray& ray = rays[i];
        if (!data.contacts->may_touch(slot, ray, hits[i].t)) continue;
        const Contact contact = data.contacts->at(data, ray, hits[i]);
        if (contact.count < 2) continue;
        // What is hidden from the camera is not what was hit, and lies in front of nothing.
        const Hit& front = foremost(data, contact, ray.direction, ends).hit;
        if (!has_end_at_camera(ends) || !materials.is_hidden_from_camera(front)) hits[i] = front;
        hits[i].in_contact = 1;
    }
}

}  // namespace

SceneGeometry::SceneGeometry(const WorldData& data, const Materials& materials) : data_(data), materials_(materials) {
    data_.bvh->set_opacity(opacity_callback, &data_);
    if (data_.clear_surfaces) data_.clear_surfaces->set_opacity(opacity_callback, &data_);
    if (data_.contacts) data_.contacts->set_opacity(opacity_callback, &data_);
    if (data_.accelerator != AcceleratorKind::Embree) accelerated_ = accelerate(data_.accelerator);
    has_far_triangles_ = triangle_bytes() + data_.bvh->bytes() > kCachedGeometry;
}

SceneGeometry::~SceneGeometry() = default;

std::unique_ptr<const AcceleratedScene> SceneGeometry::accelerate(AcceleratorKind kind) const {
    return std::make_unique<const AcceleratedScene>(data_, kind);
}

void SceneGeometry::intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                              RayEnds ends) const {
    intersect_batch(rays, hits, coherence, form, ends);
}

void SceneGeometry::intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                              RayEnds ends) const {
    intersect_batch(rays, hits, coherence, form, ends);
}

template <typename Batch>
void SceneGeometry::intersect_batch(const Batch& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                                    RayEnds ends) const {
    if (accelerated_)
        for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = accelerated_->closest(rays[i], ends);
    else
        data_.bvh->intersect(rays, hits, coherence, form, ends);
    if (data_.contacts) settle_contacts(data_, materials_, rays, hits, ends);
}

void SceneGeometry::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form,
                             RayEnds ends) const {
    occluded_batch(rays, occluded, form, ends);
}

void SceneGeometry::occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form,
                             RayEnds ends) const {
    occluded_batch(rays, occluded, form, ends);
}

template <typename Batch>
void SceneGeometry::occluded_batch(const Batch& rays, std::span<std::uint8_t> occluded, QueryForm form,
                                   RayEnds ends) const {
    if (accelerated_)
        for (std::size_t i = 0; i < rays.size(); ++i) occluded[i] = accelerated_->occlusion(rays[i], ends);
    else
        data_.bvh->occluded(rays, occluded, form, ends);
}

double SceneGeometry::replay(std::span<const Ray> rays, bool occlusion, Coherence coherence, QueryForm form) const {
    return data_.bvh->replay(rays, occlusion, coherence, form);
}

SurfacePoint SceneGeometry::surface_point(const Hit& hit) const {
    return make_surface_point(data_, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time, ConeSection{});
}

SurfacePoint SceneGeometry::surface_point(const Hit& hit, const Ray& ray, const RayCone& cone) const {
    if (hit.in_contact) {
        const Contact contact = data_.contacts->at(data_, ray, hit);
        return contact_point(data_, contact, contact.faces[0], ray, cone);
    }
    return make_surface_point(data_, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time,
                              ConeSection{ray.direction, std::abs(cone.width_at(hit.t))});
}

void SceneGeometry::for_each_clear(const Ray& ray, RayEnds ends,
                                   const std::function<void(const Hit&, const SurfacePoint&)>& visit) const {
    std::array<Hit, 16> few;
    std::vector<Hit> many;
    std::span<Hit> hits = few;
    std::size_t count = data_.clear_surfaces->collect(ray, 0.0f, hits);
    while (count == hits.size()) {
        many.resize(2 * hits.size());
        hits = many;
        count = data_.clear_surfaces->collect(ray, 0.0f, hits);
    }
    hits = hits.first(count);
    // In one order, whatever Embree's is, so that rounding is always the same.
    std::ranges::sort(hits, {},
                      [](const Hit& hit) { return std::tuple(hit.t, hit.instance, hit.geometry, hit.triangle); });
    for (const Hit& hit : hits) {
        if (has_end_at_camera(ends) && materials_.is_hidden_from_camera(hit)) continue;
        const SurfacePoint point = surface_point(hit);
        if (point.material->culls_back && passes_culled(ends, dot(ray.direction, point.geometric_normal))) continue;
        visit(hit, point);
    }
}

Rgb SceneGeometry::straight_share(const SurfacePoint& point, const Vec3f& wo) const {
    Bsdf storage;
    Rgb passed;
    for (const BsdfSample& delta :
         Scattering(materials_.bsdf(point, wo, 0.0f, storage), point.shading, point.geometric_normal, wo).deltas())
        if (delta.is_transmission) passed += delta.weight;
    return passed;
}

Rgb SceneGeometry::clear_transmittance(const Ray& ray, RayEnds ends) const {
    Rgb transmittance(1.0f);
    for_each_clear(ray, ends, [&](const Hit&, const SurfacePoint& point) {
        if (point.material->filling == kNone) transmittance *= straight_share(point, -ray.direction);
    });
    return transmittance;
}

float SceneGeometry::opacity(const Hit& hit) const {
    return evaluate_opacity(data_, hit.geometry, hit.triangle, {hit.u, hit.v});
}

HitCoordinates SceneGeometry::hit_coordinates(const Hit& hit, const PlainSurface& surface) const {
    const Geometry& geometry = data_.geometries[hit.geometry];
    const std::vector<Vec2f>& uv = surface.texcoord == 0 ? geometry.uv0 : geometry.uv1;
    if (uv.empty()) return {};
    const auto& triangle = geometry.triangles[hit.triangle];
    const Vec2f uv0 = uv[triangle[0]];
    return {uv0, uv[triangle[1]] - uv0, uv[triangle[2]] - uv0};
}

void SceneGeometry::fetch_far_triangles(std::span<const Hit> hits) const {
    // First all that say where the vertices are, so that these, too, arrive together.
    for (const Hit& hit : hits)
        if (hit.valid() && !data_.geometries[hit.geometry].shape)
            __builtin_prefetch(&data_.geometries[hit.geometry].triangles[hit.triangle]);
    for (const Hit& hit : hits) {
        if (!hit.valid()) continue;
        const Geometry& geometry = data_.geometries[hit.geometry];
        if (geometry.shape) continue;
        for (const std::uint32_t vertex : geometry.triangles[hit.triangle]) {
            __builtin_prefetch(&geometry.positions[vertex]);
            if (!geometry.normals.empty()) __builtin_prefetch(&geometry.normals[vertex]);
        }
    }
}

float SceneGeometry::mean_curvature(const Hit& hit) const {
    return etendue::mean_curvature(data_, hit);
}

std::size_t SceneGeometry::triangle_bytes() const {
    std::size_t bytes = 0;
    for (const Geometry& g : data_.geometries) {
        bytes += vector_bytes(g.positions, g.normals, g.tangents, g.uv0, g.uv1, g.colors, g.triangles);
        for (const VertexStep& step : g.motion) bytes += vector_bytes(step.positions, step.normals);
    }
    return bytes;
}

}  // namespace etendue
