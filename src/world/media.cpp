#include "world/media.h"

#include "bsdf/dielectric_body.h"
#include "bsdf/fresnel.h"
#include "core/bounds.h"
#include "core/position_error.h"
#include "light/light.h"
#include "sampling/sampler.h"
#include "world/contacts.h"
#include "world/light_pose.h"
#include "world/motion.h"
#include "world/scene_camera.h"
#include "world/scene_geometry.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <variant>

namespace etendue {

namespace {

void set_indices(const WorldData& data, std::uint32_t body, Crossing& crossing) {
    const Filling& inside = data.fillings[data.filling_of_body[body]];
    crossing.inside_ior = inside.ior;
    crossing.inside_dispersion = inside.dispersion;
    if (const std::uint32_t around = crossing.outside.filling(); around != kNone) {
        const Filling& outside = data.fillings[data.filling_of_body[around]];
        crossing.outside_ior = outside.ior;
        crossing.outside_dispersion = outside.dispersion;
    }
}

/// Counts how often a ray has left bodies more than entered them.
class ExitCounts {
  public:
    void add(std::uint32_t body, int exits) {
        Count* const end = counts_.data() + size_;
        Count* const found = std::find_if(counts_.data(), end, [&](const Count& c) { return c.body == body; });
        if (found != end) {
            found->exits += exits;
            if (found->exits == 0) *found = counts_[--size_];
        } else if (exits != 0 && size_ < counts_.size()) {
            counts_[size_++] = {body, exits};
        }
    }
    /// Returns the bodies that the ray has left more often than entered.
    [[nodiscard]] Interior interior() const {
        Interior interior;
        for (std::size_t i = 0; i < size_; ++i)
            if (counts_[i].exits > 0) interior.enter(counts_[i].body);
        return interior;
    }

  private:
    struct Count {
        std::uint32_t body = kNone;
        int exits = 0;
    };

    std::array<Count, 64> counts_{};  ///< more than an `Interior` keeps of bodies within bodies
    std::size_t size_ = 0;
};

/// Bounds where the surface of `geometry`, or one triangle of it, is while the shutter is open.
class SweptBounds {
  public:
    SweptBounds(const WorldData& data, const Instance& instance, const Geometry& geometry)
        : transforms_(instance.motion == kNone ? std::span(&instance.to_world, 1)
                                               : std::span(data.motions[instance.motion])),
          geometry_(geometry) {}

    [[nodiscard]] Bounds whole() const {
        Bounds bounds;
        for (std::uint32_t v = 0; v < geometry_.positions.size(); ++v) extend(bounds, v);
        return bounds;
    }
    [[nodiscard]] Bounds of(const std::array<std::uint32_t, 3>& triangle) const {
        Bounds bounds;
        for (const std::uint32_t v : triangle) extend(bounds, v);
        return bounds;
    }

  private:
    void extend(Bounds& bounds, std::uint32_t vertex) const {
        // Between two steps all goes in straight lines, so that the places at all steps bound it.
        const auto extend_by = [&](const Vec3f& position) {
            for (const Mat4f& transform : transforms_) bounds.extend(transform_point(transform, position));
        };
        if (geometry_.motion.empty()) extend_by(geometry_.positions[vertex]);
        for (const VertexStep& step : geometry_.motion) extend_by(step.positions[vertex]);
    }

    std::span<const Mat4f> transforms_;
    const Geometry& geometry_;
};

/// Calls `visit` with every boundary, and whether it moves while the shutter is open.
template <typename Visit>
void for_each_boundary(const WorldData& data, const Visit& visit) {
    for (const Instance& instance : data.instances)
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const Geometry& geometry = data.geometries[instance.first_geometry + g];
            if (data.body_of_slot[instance.first_light_slot + g] != kNone)
                visit(instance, geometry, instance.motion != kNone || !geometry.motion.empty());
        }
}

/// Returns boxes around the boundaries that move while the shutter is open.
std::vector<Bounds> moving_boundaries(const WorldData& data) {
    std::vector<Bounds> boxes;
    for_each_boundary(data, [&](const Instance& instance, const Geometry& geometry, bool moves) {
        if (moves) boxes.push_back(SweptBounds(data, instance, geometry).whole());
    });
    return boxes;
}

/// Returns whether a boundary may lie between places in `region` while the shutter is open: a box around one of its
/// triangles meets the region. Of a single place, only what moves can be on both sides.
bool is_divided(const WorldData& data, const Bounds& region) {
    bool found = false;
    for_each_boundary(data, [&](const Instance& instance, const Geometry& geometry, bool moves) {
        if (found || (region.min == region.max && !moves)) return;
        const SweptBounds swept(data, instance, geometry);
        if (!overlap(swept.whole(), region)) return;
        found = geometry.shape.has_value() || std::ranges::any_of(geometry.triangles, [&](const auto& triangle) {
                    return overlap(swept.of(triangle), region);
                });
    });
    return found;
}

/// Returns whether the bodies around the light of this index may change while the shutter is open; `moving` are boxes
/// around boundaries that move. Light from infinitely far away begins outside of all bodies.
bool has_changing_bodies(const WorldData& data, std::uint32_t light, const std::vector<Bounds>& moving) {
    if (moving.empty() && data.motion_of(light) == nullptr) return false;
    const std::optional<LightBounds> bounds = swept_bounds(data, light);
    if (!bounds) return false;
    return std::ranges::any_of(moving, [&](const Bounds& box) { return overlap(box, bounds->box); }) ||
           (data.motion_of(light) != nullptr && is_divided(data, bounds->box));
}

}  // namespace

float Crossing::relative_ior(float nm) const {
    return dispersed_ior(inside_ior, inside_dispersion, nm) / dispersed_ior(outside_ior, outside_dispersion, nm);
}

Media::Media(const WorldData& data, const SceneGeometry& geometry, const SceneCamera& camera)
    : data_(data), geometry_(geometry) {
    if (data_.filling_of_body.empty()) return;
    camera_interior_.reset();
    if (!is_divided(data_, camera.bounds_of_origins()))
        camera_interior_ =
            interior_at(camera.generate_ray({0.5f, 0.5f}, {0.5f, 0.5f}, kMidShutter).origin, kMidShutter);
    const std::vector<Bounds> moving = moving_boundaries(data_);
    for (std::uint32_t light = 0; light < data_.lights.size(); ++light)
        light_interiors_.push_back(has_changing_bodies(data_, light, moving) ? std::nullopt
                                                                             : find_light_interior(light));
}

std::optional<Interior> Media::find_light_interior(std::uint32_t light) const {
    // A part of the light that is in other bodies is missed with the chance (1 - its share of the emission)^32.
    constexpr std::uint32_t kRays = 32;
    if (!data_.planes_of(light).empty()) return {};
    std::optional<Interior> common;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const auto numbers = [&](std::uint32_t d) { return sample_2d(SampleSequence::Sobol, {.index = i}, d); };
        const EmissionNumbers u{.triangle = numbers(0), .position = numbers(1), .direction = numbers(2)};
        const EmissionSample ray = sample_emission(data_.lights[light], u, data_.bounding_sphere());
        const Interior interior = interior_at(ray.origin(ray.direction), kMidShutter);
        if (common && !(*common == interior)) return {};
        common = interior;
    }
    return common;
}

bool Media::has_camera_in_medium(const SceneCamera& camera) const {
    if (camera_interior_) return within(*camera_interior_) != nullptr;
    constexpr std::uint32_t kRays = 64;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const auto numbers = [&](std::uint32_t d) { return sample_2d(SampleSequence::Sobol, {.index = i}, d); };
        const Ray ray = camera.generate_ray(numbers(0), numbers(1), numbers(2).x);
        if (within(interior_at(ray.origin, ray.time)) != nullptr) return true;
    }
    return false;
}

Crossing Media::crossing(const SurfacePoint& point, const Interior& current) const {
    const std::uint32_t body = data_.body_of_slot[slot_of(data_, point.instance, point.geometry)];
    Crossing crossing{.outside = current, .inside = current};
    crossing.outside.leave(body);
    crossing.inside = crossing.outside;
    crossing.inside.enter(body);
    crossing.is_covered = crossing.inside.filling() != body;
    set_indices(data_, body, crossing);
    return crossing;
}

Crossing Media::contact_crossing(SurfacePoint& point, const Interior& current, const Hit& hit, const Ray& ray,
                                 const RayCone& cone) const {
    const Contact contact = data_.contacts->at(data_, ray, hit);
    const ContactInteriors around = interiors(data_, contact, current, ray.direction);
    const std::uint32_t before = around.before.filling();
    const std::uint32_t behind = around.behind.filling();
    // The one of precedence bounds what fills the space.
    const std::uint32_t body = std::min(before, behind);
    const ContactFace* const face = before == behind ? nullptr : face_of_body(data_, contact, body);
    if (face != nullptr) point = contact_point(data_, contact, *face, ray, cone);
    const bool from_front = dot(ray.direction, point.geometric_normal) < 0.0f;
    Crossing crossing{.outside = from_front ? around.before : around.behind,
                      .inside = from_front ? around.behind : around.before,
                      .is_covered = face == nullptr};
    if (!crossing.is_covered) set_indices(data_, body, crossing);
    return crossing;
}

Rgb Media::transmittance(const Interior& interior, const Ray& ray, RayEnds ends) const {
    Rgb passed(1.0f);
    Interior current = interior;
    float from = 0.0f;
    const auto go_to = [&](float t) {
        if (const HomogeneousMedium* medium = within(current)) passed *= medium->transmittance(t - from);
        from = t;
    };
    bool is_bent = false;
    geometry_.for_each_clear(ray, ends, [&](const Hit& hit, const SurfacePoint& point) {
        if (!is_boundary(point)) return;
        const Crossing crossing = this->crossing(point, current);
        is_bent = is_bent || (!crossing.is_covered && bends_light(crossing.relative_ior(0.0f)));
        go_to(hit.t);
        if (!crossing.is_covered && !is_bent) passed *= geometry_.straight_share(point, -ray.direction);
        current = dot(ray.direction, point.geometric_normal) > 0.0f ? crossing.outside : crossing.inside;
    });
    go_to(ray.t_max);
    return is_bent ? Rgb() : passed;
}

const HomogeneousMedium* Media::medium_of(std::uint32_t body) const {
    const HomogeneousMedium& medium = data_.fillings[data_.filling_of_body[body]].medium;
    return medium.is_empty() ? nullptr : &medium;
}

Interior Media::interior_at(const Vec3f& point, float time) const {
    // A body that the ray leaves more often than it enters is one that it began in.
    constexpr int kMostBoundaries = 4096;
    ExitCounts left;
    Ray ray;
    ray.origin = point;
    ray.direction = {0.0f, 1.0f, 0.0f};
    ray.time = time;
    for (int i = 0; i < kMostBoundaries; ++i) {
        Hit hit;
        geometry_.intersect({&ray, 1}, {&hit, 1}, Coherence::Incoherent, QueryForm::Single);
        if (!hit.valid()) break;
        const SurfacePoint surface = geometry_.surface_point(hit, ray, RayCone{});
        if (hit.in_contact) {
            const Contact contact = data_.contacts->at(data_, ray, hit);
            for (const std::uint32_t body : bodies_of(data_, contact)) {
                const auto [is_entered, is_left] = passes(data_, contact, body, ray.direction);
                left.add(body, (is_left ? 1 : 0) - (is_entered ? 1 : 0));
            }
        } else if (is_boundary(surface)) {
            left.add(body_of(data_, hit), dot(ray.direction, surface.geometric_normal) > 0.0f ? 1 : -1);
        }
        ray.origin = offset_origin(surface.position, surface.geometric_normal, surface.clearance, ray.direction);
    }
    return left.interior();
}

}  // namespace etendue
