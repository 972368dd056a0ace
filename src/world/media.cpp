#include "world/media.h"

#include "bsdf/dielectric_body.h"
#include "bsdf/fresnel.h"
#include "core/bounds.h"
#include "core/position_error.h"
#include "light/light.h"
#include "sampling/sampler.h"
#include "world/contacts.h"
#include "world/scene_camera.h"
#include "world/scene_geometry.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <variant>

namespace etendue {

namespace {

/// Is the middle of the time, [0, 1], in which the shutter is open.
constexpr float kMiddle = 0.5f;

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

enum class Boundaries { All, Moving };

/// Returns whether a boundary of these, or a box around one of its triangles, passes through `region` while the shutter
/// is open.
bool passes_through(const WorldData& data, const Bounds& region, Boundaries which) {
    const auto passes = [&](const Instance& instance, std::uint32_t g) {
        const Geometry& geometry = data.geometries[instance.first_geometry + g];
        const bool is_body = data.body_of_slot[instance.first_light_slot + g] != kNone;
        const bool moves = instance.motion != kNone || !geometry.motion.empty();
        if (!is_body || (which == Boundaries::Moving && !moves)) return false;
        // Between two steps all goes in straight lines, so that corners at all steps bound it.
        const std::span<const Mat4f> transforms =
            instance.motion == kNone ? std::span(&instance.to_world, 1) : std::span(data.motions[instance.motion]);
        const auto extend = [&](Bounds& bounds, const Vec3f& corner) {
            for (const Mat4f& transform : transforms) bounds.extend(transform_point(transform, corner));
        };
        if (geometry.shape) {
            Bounds bounds;
            for (const Vec3f& corner : geometry.positions) extend(bounds, corner);
            return overlap(bounds, region);
        }
        return std::ranges::any_of(geometry.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
            Bounds bounds;
            for (const std::uint32_t corner : triangle) {
                if (geometry.motion.empty()) extend(bounds, geometry.positions[corner]);
                for (const VertexStep& step : geometry.motion) extend(bounds, step.positions[corner]);
            }
            return overlap(bounds, region);
        });
    };
    return std::ranges::any_of(data.instances, [&](const Instance& instance) {
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            if (passes(instance, g)) return true;
        return false;
    });
}

}  // namespace

float Crossing::relative_ior(float nm) const {
    return dispersed_ior(inside_ior, inside_dispersion, nm) / dispersed_ior(outside_ior, outside_dispersion, nm);
}

Media::Media(const WorldData& data, const SceneGeometry& geometry, const SceneCamera& camera)
    : data_(data), geometry_(geometry) {
    if (data_.filling_of_body.empty()) return;
    const Bounds origins = camera.bounds_of_origins();
    // A point is in one place, whatever stands still.
    const Boundaries which = origins.min == origins.max ? Boundaries::Moving : Boundaries::All;
    camera_interior_.reset();
    if (!passes_through(data_, origins, which))
        camera_interior_ = interior_at(camera.generate_ray({0.5f, 0.5f}, {0.5f, 0.5f}, kMiddle).origin, kMiddle);
    for (std::uint32_t light = 0; light < data_.lights.size(); ++light)
        light_interiors_.push_back(find_light_interior(light));
}

std::optional<Interior> Media::find_light_interior(std::uint32_t light) const {
    // A part of the light that is in other bodies is missed with the chance (1 - its share of the emission)^32.
    constexpr std::uint32_t kRays = 32;
    if (!data_.planes_of(light).empty()) return {};
    const bool is_passed = std::visit(
        [&](const auto& kind) {
            if constexpr (requires { kind.bounds(); })
                return passes_through(data_, kind.bounds().box, Boundaries::Moving);
            else
                return false;
        },
        data_.lights[light]);
    if (is_passed) return {};
    std::optional<Interior> common;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const auto numbers = [&](std::uint32_t d) { return sample_2d(SampleSequence::Sobol, {.index = i}, d); };
        const EmissionNumbers u{.triangle = numbers(0), .position = numbers(1), .direction = numbers(2)};
        const EmissionSample ray = sample_emission(data_.lights[light], u, data_.bounding_sphere());
        const Interior interior = interior_at(ray.origin(ray.direction), kMiddle);
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
