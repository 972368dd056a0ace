// The ellipse that the cone around a ray cuts out of a surface, there and in texture coordinates.
#pragma once

#include "core/frame.h"
#include "core/lane.h"
#include "core/vec.h"

namespace etendue {

/// Two conjugate diameters of the ellipse in which a cone meets a plane, metres: along the ray and across it. A
/// template of its lane type, see core/lane.h.
template <typename T>
struct SectionEllipse {
    using Vec = Imath::Vec3<T>;

    Vec along;
    Vec across;

    /// Makes the section of a cone that is `width` metres wide where it meets a plane with the unit normal `normal`
    /// along `direction` (Akenine-Möller et al. 2021, section 3.2).
    SectionEllipse(const Vec& direction, T width, const Vec& normal) {
        // At smaller cosines the ellipse is longer than anything that is filtered well.
        constexpr float kMinCosine = 1e-3f;
        const T cosine = dot(direction, normal);
        const Vec in_plane = direction - normal * cosine;
        const T sine = length(in_plane);
        const Vec unit = choose(
            sine > T(kMinCosine), [&] { return Vec(in_plane * (T(1.0f) / sine)); },
            [&] { return BasicFrame<T>::from_normal(normal).tangent; });
        along = unit * (width / max(T(kMinCosine), abs(cosine)));
        across = cross(normal, unit) * width;
    }
};

/// Holds the section of a cone with a triangle's plane in texture coordinates.
template <typename T>
struct TextureEllipse {
    Imath::Vec2<T> along;
    Imath::Vec2<T> across;

    /// `ellipse` lies in the plane of a triangle with these edges from its first vertex and this normal, along which
    /// the coordinates change by `uv_edge1` and `uv_edge2`. A point where the triangle is degenerate.
    TextureEllipse(const SectionEllipse<T>& ellipse, const Imath::Vec3<T>& edge1, const Imath::Vec3<T>& edge2,
                   const Imath::Vec3<T>& normal, const Imath::Vec2<T>& uv_edge1, const Imath::Vec2<T>& uv_edge2) {
        const T area = dot(cross(edge1, edge2), normal);
        const T scale = select(area == T(0.0f), T(0.0f), T(1.0f) / area);
        const auto transformed = [&](const Imath::Vec3<T>& v) {
            const T first = dot(cross(v, edge2), normal) * scale;
            const T second = dot(cross(edge1, v), normal) * scale;
            return Imath::Vec2<T>(uv_edge1.x * first + uv_edge2.x * second, uv_edge1.y * first + uv_edge2.y * second);
        };
        along = transformed(ellipse.along);
        across = transformed(ellipse.across);
    }
};

}  // namespace etendue
