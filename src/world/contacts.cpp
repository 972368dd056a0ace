#include "world/contacts.h"

#include "core/position_error.h"
#include "core/vector_bytes.h"
#include "world/cone_section.h"
#include "world/surface_point.h"
#include "world/triangle_point.h"
#include "world/world_data.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace etendue {

namespace {

const Material& material_of(const WorldData& data, const Hit& hit) {
    return data.materials[data.geometries[hit.geometry].material];
}

/// Returns TrianglePlane::rounding. Positions are less exact the farther a surface is from zero. Hit distances are less
/// exact the longer rays are, even where the surface lies in a plane through zero. Rays that come from several times
/// the size of a mesh away need not tell the mesh from what lies on it.
float rounding_of(const WorldData& data, std::uint32_t instance, std::uint32_t geometry) {
    constexpr float kLargestSize = 64.0f;  // metres; larger meshes, as of a whole town, are seen from within
    return 0.5f * kPositionError * std::min(kLargestSize, data.size_of_slot[slot_of(data, instance, geometry)]);
}

ContactFace face_at(const WorldData& data, const Hit& hit) {
    ContactFace face{.hit = hit};
    const Instance& instance = data.instances[hit.instance];
    const Geometry& geometry = data.geometries[hit.geometry];
    if (instance.motion != kNone || !geometry.motion.empty() || geometry.shape) {
        const SurfacePoint point =
            make_surface_point(data, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time, ConeSection{});
        face.position = point.position;
        face.normal = point.geometric_normal;
        face.clearance = point.clearance;
        face.rounding = rounding_of(data, hit.instance, hit.geometry);
        return face;
    }
    const TrianglePlane plane = triangle_plane(data, hit.instance, hit.geometry, hit.triangle);
    const auto& triangle = geometry.triangles[hit.triangle];
    const Vec3f& p0 = geometry.positions[triangle[0]];
    face.position =
        p0 + (geometry.positions[triangle[1]] - p0) * hit.u + (geometry.positions[triangle[2]] - p0) * hit.v;
    if (!instance.baked) face.position = transform_point(instance.to_world, face.position);
    face.normal = plane.normal;
    face.clearance = plane.clearance;
    face.rounding = plane.rounding;
    return face;
}

/// The lower, the more it is the surface that is met; see above.
int precedence(const Material& material, bool from_front) {
    if (stops_light(material)) return material.emits && (material.emits_both_sides || from_front) ? 0 : 1;
    return is_sheet(material) ? 3 : 2;
}

}  // namespace

TrianglePlane triangle_plane(const WorldData& data, std::uint32_t instance_index, std::uint32_t geometry_index,
                             std::uint32_t triangle_index) {
    const Instance& instance = data.instances[instance_index];
    const Geometry& geometry = data.geometries[geometry_index];
    if (geometry.shape) {
        const ExactShape shape = instance.baked ? *geometry.shape : geometry.shape->placed(instance.to_world);
        Vec3f extent(0.0f);
        for (const Vec3f& corner : geometry.positions) extent = max_components(extent, abs_components(corner));
        const Vec3f normal = shape.point(shape_place(triangle_index, {0.0f, 0.0f})).normal;
        return {normal,
                clearance(normal, instance.baked ? position_error(extent) : position_error(extent, instance.to_world)),
                rounding_of(data, instance_index, geometry_index)};
    }
    const auto& triangle = geometry.triangles[triangle_index];
    const Vec3f& p0 = geometry.positions[triangle[0]];
    const TrianglePoint<float> point(p0, geometry.positions[triangle[1]] - p0, geometry.positions[triangle[2]] - p0,
                                     {0.0f, 0.0f});
    Vec3f normal = point.normal;
    if (!instance.baked) {
        normal = transform_normal(instance.to_local, normal);
        const float normal_length = length(normal);
        if (normal_length > 0.0f) normal *= 1.0f / normal_length;
    }
    const Vec3f error = instance.baked ? position_error(point.extent) : position_error(point.extent, instance.to_world);
    return {normal, clearance(normal, error), rounding_of(data, instance_index, geometry_index)};
}

bool stops_light(const Material& material) {
    if (const auto* constant = std::get_if<Bsdf>(&material.model)) return only_reflects(*constant);
    const GltfModel& model = std::get<GltfModel>(material.model);
    return material.unlit ||
           (model.transmission == 0.0f && !(model.layers && model.layers->diffuse_transmission > 0.0f));
}

bool is_sheet(const Material& material) {
    return !stops_light(material) && material.filling == kNone;
}

std::size_t slot_of(const WorldData& data, std::uint32_t instance, std::uint32_t geometry) {
    const Instance& placed = data.instances[instance];
    return placed.first_light_slot + geometry - placed.first_geometry;
}

std::uint32_t body_of(const WorldData& data, const Hit& hit) {
    return data.body_of_slot.empty() ? kNone : data.body_of_slot[slot_of(data, hit)];
}

void ContactSlot::add(const Bounds& place) {
    const auto near = std::ranges::find_if(regions, [&](const Bounds& region) { return overlap(region, place); });
    if (near != regions.end()) return near->extend(place);
    regions.push_back(place);
    if (regions.size() <= kMostRegions) return;
    Bounds all;
    for (const Bounds& region : regions) all.extend(region);
    regions = {all};
}

Contacts::Contacts(const WorldData& data, std::vector<ContactSlot> slots, std::span<const HitFilter> filters,
                   const ThreadPool& threads)
    : slots_(std::move(slots)) {
    std::vector<CollectedSlot> collected(slots_.size());
    for (const Instance& instance : data.instances)
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const ContactSlot& slot = slots_[instance.first_light_slot + g];
            const Geometry& geometry = data.geometries[instance.first_geometry + g];
            CollectedSlot& those = collected[instance.first_light_slot + g];
            if (slot.reach == 0.0f) continue;
            those.is_whole = slot.is_anywhere || !instance.baked || geometry.shape;
            if (those.is_whole) continue;
            for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
                Bounds bounds;
                for (const std::uint32_t vertex : geometry.triangles[t]) bounds.extend(geometry.positions[vertex]);
                const auto meets = [&](const Bounds& region) { return overlap(bounds, region); };
                if (std::ranges::any_of(slot.regions, meets)) those.triangles.push_back(t);
            }
        }
    bvh_ = std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters, threads,
                                         std::move(collected));
}

std::size_t Contacts::bytes() const {
    std::size_t bytes = vector_bytes(slots_) + bvh_->bytes();
    for (const ContactSlot& slot : slots_) bytes += vector_bytes(slot.regions);
    return bytes;
}

Contact Contacts::at(const WorldData& data, const Ray& ray, const Hit& hit) const {
    // A ray in the plane of surfaces is not followed along them.
    constexpr float kLeastCosine = 1e-3f;
    constexpr float kParallel = 0.9f;
    Contact contact;
    const ContactFace& first = contact.faces[contact.count++] = face_at(data, hit);
    const float reach = slots_[slot_of(data, hit)].reach;
    const bool is_entered = dot(ray.direction, first.normal) < 0.0f;
    const Vec3f along = is_entered ? -first.normal : first.normal;
    // Distances along the ray are less exact than places on a surface.
    const Vec3f terms = max_components(abs_components(ray.origin), abs_components(first.position));
    const float rounding = kPositionError * (hit.t + terms.x + terms.y + terms.z);
    const float window = (3.0f * reach + rounding) / std::max(kLeastCosine, dot(ray.direction, along));

    std::array<Hit, 4 * Contact::kCapacity> met;
    Ray through = ray;
    through.t_max = hit.t + window;
    const std::size_t found = bvh_->collect(through, std::max(0.0f, hit.t - window), met);
    std::array<ContactFace, met.size()> candidates;
    std::size_t waiting = 0;
    for (const Hit& other : std::span(met).first(found)) {
        if (other.instance == hit.instance && other.geometry == hit.geometry && other.triangle == hit.triangle)
            continue;
        ContactFace face = face_at(data, other);
        face.depth = dot(face.position - first.position, along);
        if (std::abs(dot(face.normal, along)) >= kParallel) candidates[waiting++] = face;
    }
    // Whatever is next to one of them is one of them.
    for (std::size_t c = 0; c < waiting && contact.count < Contact::kCapacity;) {
        const ContactFace& candidate = candidates[c];
        const bool touches = std::ranges::any_of(contact.all(), [&](const ContactFace& face) {
            return std::abs(face.depth - candidate.depth) <= contact_distance(face, candidate);
        });
        if (!touches) {
            ++c;
            continue;
        }
        contact.faces[contact.count++] = candidate;
        candidates[c] = candidates[--waiting];
        c = 0;
    }
    return contact;
}

const ContactFace& foremost(const WorldData& data, const Contact& contact, const Vec3f& direction, RayEnds ends) {
    const auto key = [&](const ContactFace& face) {
        const Material& material = material_of(data, face.hit);
        const float cosine = dot(direction, face.normal);
        return std::tuple(material.culls_back && passes_culled(ends, cosine), precedence(material, cosine < 0.0f),
                          slot_of(data, face.hit), face.hit.triangle);
    };
    return *std::ranges::min_element(contact.all(), {}, key);
}

std::vector<std::uint32_t> bodies_of(const WorldData& data, const Contact& contact) {
    std::vector<std::uint32_t> bodies;
    for (const ContactFace& face : contact.all())
        if (const std::uint32_t body = body_of(data, face.hit); body != kNone && !std::ranges::count(bodies, body))
            bodies.push_back(body);
    return bodies;
}

BodyPassage passes(const WorldData& data, const Contact& contact, std::uint32_t body, const Vec3f& direction) {
    BodyPassage passage;
    for (const ContactFace& face : contact.all())
        if (body_of(data, face.hit) == body)
            (dot(direction, face.normal) < 0.0f ? passage.is_entered : passage.is_left) = true;
    return passage;
}

ContactInteriors interiors(const WorldData& data, const Contact& contact, const Interior& current,
                           const Vec3f& direction) {
    ContactInteriors result{current, current};
    for (const ContactFace& face : contact.all()) {
        const std::uint32_t body = body_of(data, face.hit);
        if (body == kNone) continue;
        const auto [is_entered, is_left] = passes(data, contact, body, direction);
        if (is_entered && is_left) continue;  // as if neither
        result.before.leave(body);
        result.behind.leave(body);
        (is_entered ? result.behind : result.before).enter(body);
    }
    return result;
}

const ContactFace* face_of_body(const WorldData& data, const Contact& contact, std::uint32_t body) {
    const auto found =
        std::ranges::find_if(contact.all(), [&](const ContactFace& face) { return body_of(data, face.hit) == body; });
    return found == contact.all().end() ? nullptr : &*found;
}

SurfacePoint contact_point(const WorldData& data, const Contact& contact, const ContactFace& face, const Ray& ray,
                           const RayCone& cone) {
    const Hit& hit = face.hit;
    SurfacePoint point = make_surface_point(data, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time,
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

}  // namespace etendue
