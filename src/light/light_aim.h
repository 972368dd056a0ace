// Aims light subpaths at what makes caustics: of the rays that leave a light, some go into the cones of directions in
// which spheres around mirrors and smooth glass lie, as their origin sees them. For a light at infinity, whose
// direction is given, they pass through the spheres' disks across it.
//
// Cones are chosen in proportion to their solid angle, and directions within them uniformly, so that the density of a
// direction is that of the light's own samples and of how many cones it lies in:
//
//   p(w) = (1 - s) p_own(w) + s #{cones around w} / (sum of all solid angles)
//
// The share s is a quarter where the cones are small. It falls to nothing where together they are a tenth of all
// directions into which the light shines: its own samples find them then, and paths through glass cost more than
// others.
#pragma once

#include "core/lane.h"
#include "core/vec.h"
#include "light/emission_sample.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Bounds a mirror or a body of glass, metres.
struct AimSphere {
    Vec3f center{0.0f};
    float radius = 0.0f;
};

/// Bounds the directions into which a point of a light shines. A template of its lane type, see core/lane.h.
template <typename T>
struct LightCone {
    Imath::Vec3<T> axis;  ///< unit
    T cos_half;           ///< cosine of the largest angle to the axis; -1 for all directions
};

/// Aims the rays of lights at spheres.
class LightAim {
  public:
    /// Bounds the number of spheres that rays are aimed at, since every density asks all of them.
    static constexpr std::size_t kMostSpheres = 8;

    LightAim() = default;
    /// Aims at `spheres`; neighbours share one where there are more than kMostSpheres.
    explicit LightAim(std::vector<AimSphere> spheres);

    [[nodiscard]] bool empty() const { return spheres_.empty(); }
    [[nodiscard]] std::span<const AimSphere> spheres() const { return spheres_; }

    /// Returns the density, 1/sr, of `direction` from `point`, which shines into `cone` and picks directions with the
    /// density `own`, 1/sr. A direction that `is_aimed` leads into a sphere, whatever rounding says. A template of its
    /// lane type, see core/lane.h.
    template <typename T>
    [[nodiscard]] T pdf_solid_angle(const Imath::Vec3<T>& point, const LightCone<T>& cone,
                                    const Imath::Vec3<T>& direction, T own, bool is_aimed = false) const;
    /// Returns the density, 1/m² across `direction`, of rays from infinity through `point`, which a light picks with
    /// the density `own`, 1/m². A point that `is_aimed` lies before a sphere, whatever rounding says.
    [[nodiscard]] float pdf_area(const Vec3f& point, const Vec3f& direction, float own, bool is_aimed = false) const;

    /// Returns a direction from `point`, which shines into `cone`, if `u`, in [0, 1)², says that it is to be aimed.
    /// Otherwise stretches `u` for the light's own choice.
    [[nodiscard]] std::optional<Vec3f> aim(const Vec3f& point, const LightCone<float>& cone, Vec2f& u) const;
    /// Returns a point that a ray along `direction` from infinity passes, if `u` says that it is to be aimed. Otherwise
    /// stretches `u` for the light's own choice, whose density is `own`, 1/m².
    [[nodiscard]] std::optional<Vec3f> aim_from_afar(const Vec3f& direction, float own, Vec2f& u) const;

  private:
    /// Bounds the share of rays that are aimed.
    static constexpr float kMostAimed = 0.25f;
    /// Bounds the part of a light's directions that spheres may take up for any ray to be aimed at them.
    static constexpr float kLargestPart = 0.1f;

    /// Describes a sphere as a point of a light sees it.
    template <typename T>
    struct View {
        Imath::Vec3<T> to;    ///< metres, to the centre
        T solid;              ///< solid angle over 2 pi, 0 if the light does not shine there
        MaskOf<T> is_around;  ///< the point lies inside the sphere
        T radius;             ///< metres

        /// Returns whether `direction` leads into the sphere.
        [[nodiscard]] MaskOf<T> holds(const Imath::Vec3<T>& direction) const {
            const T along = dot(to, direction);
            return is_around || (along > T(0.0f) && length_squared(to - direction * along) <= radius * radius);
        }
    };
    template <typename T>
    [[nodiscard]] static View<T> view(const AimSphere& sphere, const Imath::Vec3<T>& point, const LightCone<T>& cone);
    /// Returns the share of rays that are aimed at spheres of this solid angle, out of that of the cone, both over 2
    /// pi.
    template <typename T>
    [[nodiscard]] static T share(T solid, T of_cone) {
        const T left = max(T(0.0f), T(1.0f) - solid / (kLargestPart * of_cone));
        return kMostAimed * left * left;
    }

    std::vector<AimSphere> spheres_;
};

template <typename T>
LightAim::View<T> LightAim::view(const AimSphere& sphere, const Imath::Vec3<T>& point, const LightCone<T>& cone) {
    const Imath::Vec3<T> to = Imath::Vec3<T>(T(sphere.center.x), T(sphere.center.y), T(sphere.center.z)) - point;
    const T squared = length_squared(to);
    const T distance = sqrt(squared);
    const T radius(sphere.radius);
    const MaskOf<T> is_around = squared <= radius * radius;
    const T sin2 = min(radius * radius / max(squared, T(1e-30f)), T(1.0f));
    const T sine = sqrt(sin2);
    const T cosine = select(is_around, T(-1.0f), sqrt(T(1.0f) - sin2));
    const T sin_cone = sqrt(max(T(0.0f), T(1.0f) - cone.cos_half * cone.cos_half));
    // The angle to the axis is less than both half angles together.
    const MaskOf<T> is_lit = is_around || cone.cos_half <= -cosine ||
                             dot(to, cone.axis) > distance * (cone.cos_half * cosine - sin_cone * sine);
    // Of smaller spheres, single precision does not tell which directions lead there.
    const MaskOf<T> is_told = is_around || sin2 > T(1e-10f);
    // Without the difference of one and the cosine of a small angle.
    return {to, select(is_lit && is_told, select(is_around, T(2.0f), sin2 / (T(1.0f) + cosine)), T(0.0f)), is_around,
            radius};
}

template <typename T>
T LightAim::pdf_solid_angle(const Imath::Vec3<T>& point, const LightCone<T>& cone, const Imath::Vec3<T>& direction,
                            T own, bool is_aimed) const {
    T solid(0.0f);
    T around(0.0f);
    for (const AimSphere& sphere : spheres_) {
        const View<T> seen = view(sphere, point, cone);
        solid += seen.solid;
        around += select(seen.solid > T(0.0f) && seen.holds(direction), T(1.0f), T(0.0f));
    }
    around = max(around, T(is_aimed ? 1.0f : 0.0f));
    constexpr float kInvTwoPi = 0.15915494f;
    const T aimed = select(solid > T(0.0f), around * kInvTwoPi / solid, T(0.0f));
    const T part = select(solid > T(0.0f), share(solid, T(1.0f) - cone.cos_half), T(0.0f));
    return own + part * (aimed - own);
}

}  // namespace etendue
