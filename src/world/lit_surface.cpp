#include "world/lit_surface.h"

#include "core/position_error.h"
#include "sampling/hash.h"
#include "world/contacts.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace etendue {

namespace {

Hit nearest(const World& world, const Ray& ray, RayEnds ends) {
    Hit hit;
    world.geometry().intersect(std::span(&ray, 1), std::span(&hit, 1), Coherence::Incoherent, QueryForm::Single, ends);
    return hit;
}

/// Takes one of the surfaces that it is told of, each with the same chance.
class SurfaceChoice {
  public:
    explicit SurfaceChoice(std::uint32_t alpha_key) : bits_(hash_combine(alpha_key, kOther)) {}

    void add(const Hit& hit) {
        ++count_;
        if (to_unit_float(hash_combine(bits_, count_)) * static_cast<float>(count_) < 1.0f) taken_ = hit;
    }
    [[nodiscard]] LitSurface taken() const { return {taken_, static_cast<float>(std::max(count_, 1u))}; }

  private:
    /// Has the choice depend on other bits than whether surfaces are transparent.
    static constexpr std::uint32_t kOther = 0x6c697420u;

    std::uint32_t bits_;
    std::uint32_t count_ = 0;
    Hit taken_;
};

}  // namespace

LitSurface find_lit_surface(const World& world, const Ray& ray) {
    // What stops light is what an eye on the other side would see.
    const Hit last = nearest(world, ray, RayEnds::FromLight);
    SurfaceChoice choice(ray.alpha_key);
    Ray rest = ray;
    // What lies in one place with the last is met there, whatever rounding says of their order.
    const Vec3f terms = abs_components(ray.origin);
    const float reach = last.valid() ? last.t + kPositionError * (last.t + terms.x + terms.y + terms.z) : ray.t_max;
    rest.t_max = reach;
    float passed = 0.0f;
    while (rest.t_max > 0.0f) {
        Hit front = nearest(world, rest, RayEnds::InScene);
        if (!front.valid() || !world.materials().at(front)->culls_back) break;
        const SurfacePoint point = world.geometry().surface_point(front, rest, RayCone{});
        rest.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
        passed = dot(rest.origin - ray.origin, ray.direction);
        rest.t_max = reach - passed;
        front.t = dot(point.position - ray.origin, ray.direction);
        if (is_lit(world, front, ray.direction)) choice.add(front);
    }
    if (last.valid() && last.t > passed && (world.traits().has_scattering_bodies || is_lit(world, last, ray.direction)))
        choice.add(last);
    return choice.taken();
}

bool is_lit(const World& world, const Hit& hit, const Vec3f& direction) {
    const Material& material = *world.materials().at(hit);
    if (!material.culls_back) return true;
    if (material.unlit) return false;
    return is_sheet(material) || dot(world.geometry().surface_point(hit).geometric_normal, direction) < 0.0f;
}

float chance_beyond(const World& world, const Ray& ray, const Vec3f& position) {
    Ray rest = ray;
    rest.origin = position;
    return 1.0f / find_lit_surface(world, rest).count;
}

}  // namespace etendue
