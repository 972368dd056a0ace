// The sides of a surface with a shading normal, and what directions mean on it: the geometry of `Scattering`.
#pragma once

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
    MaskOf<T> wo_agrees;  ///< false where nothing is scattered, by the leak rule

    /// Both normals on the front side. `turns`: what faces away from `wo` is turned to it.
    OrientedSurface(const BasicFrame<T>& front, const Vec& front_normal, const Vec& towards, bool turns)
        : frame(front), geometric_normal(front_normal), wo(towards), wo_agrees(turn(turns)) {}

    /// Of what another one has computed, lane by lane.
    OrientedSurface(const BasicFrame<T>& turned, const Vec& turned_normal, const Vec& towards, const Vec& towards_local,
                    MaskOf<T> agreeing)
        : frame(turned), geometric_normal(turned_normal), wo(towards), wo_local(towards_local), wo_agrees(agreeing) {}

    /// True if `w`, which is `local` in the frame, lies on the same side of both normals.
    [[nodiscard]] MaskOf<T> agrees(const Vec& w, const Vec& local) const {
        return dot(w, geometric_normal) * local.z > T(0.0f);
    }

    /// What importance that goes on along `w`, which is `local` in the frame, is multiplied by: |wo·n_s| |w·n_g| /
    /// (|wo·n_g| |w·n_s|) (Veach 1997, equation 5.19).
    [[nodiscard]] T adjoint_factor(const Vec& w, const Vec& local) const {
        const T above = abs(wo_local.z) * abs(dot(w, geometric_normal));
        const T below = abs(dot(wo, geometric_normal)) * abs(local.z);
        return select(below > T(0.0f), above / below, T(0.0f));
    }

    /// What of that does not depend on `w`: |wo·n_s| / |wo·n_g|.
    [[nodiscard]] T adjoint_factor_of_wo() const {
        const T below = abs(dot(wo, geometric_normal));
        return select(below > T(0.0f), abs(wo_local.z) / below, T(0.0f));
    }

  private:
    MaskOf<T> turn(bool turns) {
        if (turns) {
            const T side = select(dot(wo, geometric_normal) < T(0.0f), T(-1.0f), T(1.0f));
            geometric_normal *= side;
            frame.normal *= side;
            frame.tangent *= side;  // keeps the frame right-handed
        }
        wo_local = frame.to_local(wo);
        return agrees(wo, wo_local);
    }
};

}  // namespace etendue
