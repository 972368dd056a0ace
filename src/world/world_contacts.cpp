// Rays of the World where surfaces touch, and through panes.
#include "world/cone_section.h"
#include "world/contacts.h"
#include "world/embree_scene.h"
#include "world/scattering.h"
#include "world/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

namespace etendue {

void SceneGeometry::intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                              QueryForm form) const {
    data_->bvh->intersect(rays, hits, coherence, form);
    if (data_->contacts) settle_contacts(rays, hits);
}

void SceneGeometry::intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence, QueryForm form) const {
    data_->bvh->intersect(rays, hits, coherence, form);
    if (data_->contacts) settle_contacts(rays, hits);
}

template <typename Batch>
void World::settle_contacts(const Batch& rays, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const std::size_t slot = slot_of(*data_, hits[i]);
        if (data_->contacts->reach(slot) == 0.0f) continue;
        const Ray& ray = rays[i];
        if (!data_->contacts->may_touch(slot, ray, hits[i].t)) continue;
        const Contact contact = data_->contacts->at(*data_, ray, hits[i]);
        if (contact.count < 2) continue;
        hits[i] = foremost(*data_, contact, ray.direction).hit;
        hits[i].in_contact = 1;
    }
}

Rgb SceneGeometry::pane_transmittance(const Ray& ray) const {
    std::array<Hit, 16> few;
    std::vector<Hit> many;
    std::span<Hit> hits = few;
    std::size_t count = data_->panes->collect(ray, 0.0f, hits);
    while (count == hits.size()) {
        many.resize(2 * hits.size());
        hits = many;
        count = data_->panes->collect(ray, 0.0f, hits);
    }
    hits = hits.first(count);
    // In one order, whatever Embree's is, so that rounding is always the same.
    std::ranges::sort(hits, {},
                      [](const Hit& hit) { return std::tuple(hit.t, hit.instance, hit.geometry, hit.triangle); });
    Rgb transmittance(1.0f);
    for (const Hit& hit : hits) {
        const SurfacePoint point = surface_point(hit);
        Bsdf storage;
        const Vec3f wo = -ray.direction;
        Rgb passed;
        for (const BsdfSample& delta :
             Scattering(bsdf(point, wo, 0.0f, storage), point.shading, point.geometric_normal, wo).deltas())
            if (delta.is_transmission) passed += delta.weight;
        transmittance *= passed;
    }
    return transmittance;
}

SurfacePoint World::contact_point(const Contact& contact, const ContactFace& face, const Ray& ray,
                                  const RayCone& cone) const {
    const Hit& hit = face.hit;
    SurfacePoint point = make_surface_point(*data_, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time,
                                            ConeSection{ray.direction, std::abs(cone.width_at(hit.t))});
    // In the middle of all of them, so that both sides are clear.
    float first = face.depth - face.clearance;
    float last = face.depth + face.clearance;
    for (const ContactFace& other : contact.all()) {
        first = std::min(first, other.depth - other.clearance);
        last = std::max(last, other.depth + other.clearance);
    }
    const Vec3f along =
        dot(ray.direction, point.geometric_normal) > 0.0f ? point.geometric_normal : -point.geometric_normal;
    point.position += along * (0.5f * (first + last) - face.depth);
    point.clearance = 0.5f * (last - first);
    return point;
}

Crossing Media::contact_crossing(SurfacePoint& point, const Interior& current, const Hit& hit, const Ray& ray,
                                 const RayCone& cone) const {
    const Contact contact = data_->contacts->at(*data_, ray, hit);
    const ContactInteriors around = interiors(*data_, contact, current, ray.direction);
    const std::uint32_t before = around.before.filling();
    const std::uint32_t behind = around.behind.filling();
    // The one of precedence bounds what fills the space.
    const std::uint32_t body = std::min(before, behind);
    const ContactFace* const face = before == behind ? nullptr : face_of_body(*data_, contact, body);
    if (face != nullptr) point = contact_point(contact, *face, ray, cone);
    const bool from_front = dot(ray.direction, point.geometric_normal) < 0.0f;
    Crossing crossing{.outside = from_front ? around.before : around.behind,
                      .inside = from_front ? around.behind : around.before,
                      .is_hidden = face == nullptr};
    if (!crossing.is_hidden) set_indices(body, crossing);
    return crossing;
}

bool World::is_foremost_emitter(const SurfacePoint& point, Vec2f barycentric, const Vec3f& direction) const {
    const std::size_t slot = slot_of(*data_, point.instance, point.geometry);
    if (data_->shares_place_of_slot.empty() || data_->shares_place_of_slot[slot] == 0) return true;
    const float height = 4.0f * data_->contacts->reach(slot);
    const Vec3f side = dot(direction, point.geometric_normal) > 0.0f ? point.geometric_normal : -point.geometric_normal;
    Ray ray;
    ray.origin = point.position + side * height;
    ray.direction = -side;
    const Hit hit{height, barycentric.x, barycentric.y, point.triangle, point.geometry & 0x7fffffffu,
                  0,      point.instance};
    const Hit& seen = foremost(*data_, data_->contacts->at(*data_, ray, hit), ray.direction).hit;
    return seen.instance == hit.instance && seen.geometry == hit.geometry && seen.triangle == hit.triangle;
}

}  // namespace etendue
