// The sides of a surface with a shading normal, and what directions mean on it: the geometry of `Scattering`.
#pragma once

#include "bsdf/leaning_normal.h"
#include "core/frame.h"
#include "core/lane.h"

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct OrientedSurface {
    using Vec = Imath::Vec3<T>;

    BasicFrame<T> frame;
    Vec geometric_normal;
    Vec wo;
    Vec wo_local;
    LeaningNormal<T> leaning;  ///< how the geometric normal lies in the frame

    /// Places `front` and `front_normal`, which are on the front side, for light seen along `towards`. `turns`: what
    /// faces away from `towards` is turned to it.
    OrientedSurface(const BasicFrame<T>& front, const Vec& front_normal, const Vec& towards, bool turns)
        : frame(front), geometric_normal(front_normal), wo(towards) {
        if (turns) {
            const T side = select(dot(wo, geometric_normal) < T(0.0f), T(-1.0f), T(1.0f));
            geometric_normal *= side;
            frame.normal *= side;
            frame.tangent *= side;  // keeps the frame right-handed
        }
        wo_local = frame.to_local(wo);
        leaning.geometric = frame.to_local(geometric_normal);
    }

    /// Returns the direction from which the eye sees the lobe, in the frame.
    [[nodiscard]] Vec seen_from() const { return leaning.seen_from(wo_local); }

    /// Returns |wo·n_s| / |wo·n_g|, the part of importance's adjoint factor that depends on where light comes from
    /// (Veach 1997, equation 5.19); 0 where a lobe that only reflects receives none.
    [[nodiscard]] T received() const {
        const T side = leaning.side(wo_local);
        return select(side > T(0.0f) && wo_local.z > T(0.0f), wo_local.z / side, T(0.0f));
    }
};

}  // namespace etendue
