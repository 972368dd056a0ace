#include "shape/shape.h"

#include "core/position_error.h"
#include "core/trigonometry.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace etendue {

namespace {

constexpr std::uint32_t kSide = 0, kTop = 1, kBottom = 2;
constexpr float kTurn = 2.0f * kPi;

/// Holds a place of a unit shape; derivatives are those of the position by the texture coordinates.
struct UnitPoint {
    Vec3f position;
    Vec3f normal;  ///< unit
    Vec2f uv;
    Vec3f along_u;
    Vec3f along_v;
};

Vec3d in_double(const Vec3f& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Returns a vector through the transform without its translation.
Vec3d turned(const Imath::M44d& m, const Vec3d& v) {
    return {v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
            v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]};
}

/// Returns the normal of the image whose normal before the transform with the inverse `to_unit` is `n`, not normalised.
Vec3f normal_of(const Imath::M44d& to_unit, const Vec3d& n) {
    return Vec3f(Vec3d(n.x * to_unit[0][0] + n.y * to_unit[0][1] + n.z * to_unit[0][2],
                       n.x * to_unit[1][0] + n.y * to_unit[1][1] + n.z * to_unit[1][2],
                       n.x * to_unit[2][0] + n.y * to_unit[2][1] + n.z * to_unit[2][2])
                     .normalized());
}

// Directions are kept as places on an octahedron (Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010), those
// in a plane as places on a square.

Vec2f to_octahedron(const Vec3d& n) {
    const double size = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const double x = n.x / size;
    const double y = n.y / size;
    if (n.z >= 0.0) return {static_cast<float>(x), static_cast<float>(y)};
    return {static_cast<float>(std::copysign(1.0 - std::abs(y), x)),
            static_cast<float>(std::copysign(1.0 - std::abs(x), y))};
}

Vec3f from_octahedron(Vec2f at) {
    const float z = 1.0f - std::abs(at.x) - std::abs(at.y);
    if (z >= 0.0f) return normalize(Vec3f(at.x, at.y, z));
    return normalize(Vec3f(std::copysign(1.0f - std::abs(at.y), at.x), std::copysign(1.0f - std::abs(at.x), at.y), z));
}

float to_square(double x, double z) {
    const double part = x / (std::abs(x) + std::abs(z));
    return static_cast<float>(z >= 0.0 ? 1.0 - part : part - 1.0);
}

/// Returns the direction in the plane y = 0.
Vec3f from_square(float at) {
    const float part = at >= 0.0f ? 1.0f - at : 1.0f + at;
    return normalize(Vec3f(part, 0.0f, std::copysign(1.0f - std::abs(part), at)));
}

/// Returns the part of a turn from +z towards +x, its middle at +z.
float turn_of(float x, float z) {
    return 0.5f + std::atan2(x, z) / kTurn;
}

UnitPoint sphere_point(const Vec3f& p) {
    const float sine = std::sqrt(p.x * p.x + p.z * p.z);
    // At the poles any meridian will do.
    const float x = sine > 0.0f ? p.x / sine : 0.0f;
    const float z = sine > 0.0f ? p.z / sine : 1.0f;
    return {.position = p,
            .normal = p,
            .uv = {turn_of(p.x, p.z), std::atan2(sine, p.y) * kInvPi},
            .along_u = Vec3f(z, 0.0f, -x) * (kTurn * sine),
            .along_v = Vec3f(p.y * x, -sine, p.y * z) * kPi};
}

/// Returns a place of what lies in a plane with these directions of its texture.
UnitPoint flat_point(const Vec3f& p, const Vec3f& normal, const Vec3f& right, const Vec3f& down) {
    return {.position = p,
            .normal = normal,
            .uv = {0.5f + 0.5f * dot(p, right), 0.5f + 0.5f * dot(p, down)},
            .along_u = right * 2.0f,
            .along_v = down * 2.0f};
}

UnitPoint cylinder_point(const ShapePlace& place) {
    if (place.face == kTop)
        return flat_point({place.at.x, 1.0f, place.at.y}, {0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f});
    if (place.face == kBottom)
        return flat_point({place.at.x, -1.0f, place.at.y}, {0.0f, -1.0f, 0.0f}, {1.0f, 0.0f, 0.0f},
                          {0.0f, 0.0f, -1.0f});
    const Vec3f n = from_square(place.at.x);
    return {.position = {n.x, place.at.y, n.z},
            .normal = n,
            .uv = {turn_of(n.x, n.z), 0.5f - 0.5f * place.at.y},
            .along_u = Vec3f(n.z, 0.0f, -n.x) * kTurn,
            .along_v = {0.0f, -2.0f, 0.0f}};
}

UnitPoint unit_point(ShapeKind kind, const ShapePlace& place) {
    if (kind == ShapeKind::Sphere) return sphere_point(from_octahedron(place.at));
    if (kind == ShapeKind::Cylinder) return cylinder_point(place);
    return flat_point({place.at.x, place.at.y, 0.0f}, {0.0f, 0.0f, -1.0f}, {-1.0f, 0.0f, 0.0f}, {0.0f, -1.0f, 0.0f});
}

/// Holds where a line meets a unit shape.
struct UnitCrossing {
    double t = 0.0;
    ShapePlace place;
    Vec3d normal{0.0};
};

/// Finds the two solutions of a t² + 2 b t + c = 0, the smaller first, without cancellation; false if there are none.
bool solve(double a, double b, double c, double discriminant, double& first, double& second) {
    if (!(discriminant >= 0.0) || a == 0.0) return false;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    first = q / a;
    second = q == 0.0 ? first : c / q;
    if (first > second) std::swap(first, second);
    return true;
}

/// Solves for a circle or a sphere of radius 1 around zero. The discriminant is taken at the middle of the chord, where
/// nothing cancels for lines from afar (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray
/// Tracing Gems, chapter 7).
bool solve_round(const Vec3d& o, const Vec3d& d, double& first, double& second) {
    const double a = d.dot(d);
    const double b = o.dot(d);
    if (a == 0.0) return false;
    const Vec3d middle = o - d * (b / a);
    return solve(a, b, o.dot(o) - 1.0, a * (1.0 - middle.dot(middle)), first, second);
}

std::size_t cross_sphere(const Vec3d& o, const Vec3d& d, std::array<UnitCrossing, 2>& found) {
    double t[2];
    if (!solve_round(o, d, t[0], t[1])) return 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3d p = (o + d * t[i]).normalized();
        found[i] = {t[i], {0, to_octahedron(p)}, p};
    }
    return 2;
}

std::size_t cross_disk(const Vec3d& o, const Vec3d& d, std::array<UnitCrossing, 2>& found) {
    if (d.z == 0.0) return 0;
    const double t = -o.z / d.z;
    const double x = o.x + d.x * t;
    const double y = o.y + d.y * t;
    if (!(x * x + y * y <= 1.0)) return 0;
    found[0] = {t, {0, {static_cast<float>(x), static_cast<float>(y)}}, {0.0, 0.0, -1.0}};
    return 1;
}

std::size_t cross_cylinder(const Vec3d& o, const Vec3d& d, std::array<UnitCrossing, 2>& found) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    // The part of the line within the infinite cylinder, and that between the planes of its ends.
    const Vec3d o_across(o.x, 0.0, o.z);
    const Vec3d d_across(d.x, 0.0, d.z);
    double side[2] = {-kInfinity, kInfinity};
    if (!solve_round(o_across, d_across, side[0], side[1]) &&
        (d_across.dot(d_across) > 0.0 || o_across.dot(o_across) > 1.0))
        return 0;
    double ends[2] = {-kInfinity, kInfinity};
    if (d.y != 0.0) {
        ends[0] = (-std::copysign(1.0, d.y) - o.y) / d.y;
        ends[1] = (std::copysign(1.0, d.y) - o.y) / d.y;
    } else if (std::abs(o.y) > 1.0) {
        return 0;
    }
    const double t[2] = {std::max(side[0], ends[0]), std::min(side[1], ends[1])};
    if (!(t[0] <= t[1])) return 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3d p = o + d * t[i];
        if (t[i] == side[i]) {
            const Vec3d n = Vec3d(p.x, 0.0, p.z).normalized();
            found[i] = {t[i], {kSide, {to_square(n.x, n.z), static_cast<float>(std::clamp(p.y, -1.0, 1.0))}}, n};
        } else {
            const double up = (i == 0) == (d.y < 0.0) ? 1.0 : -1.0;
            found[i] = {
                t[i], {up > 0.0 ? kTop : kBottom, {static_cast<float>(p.x), static_cast<float>(p.z)}}, {0.0, up, 0.0}};
        }
    }
    return 2;
}

double determinant(const Imath::M44d& m) {
    return turned(m, {1.0, 0.0, 0.0}).dot(turned(m, {0.0, 1.0, 0.0}).cross(turned(m, {0.0, 0.0, 1.0})));
}

/// Returns the squares of the semi-axes of the ellipsoid that these vectors span, by size: the eigenvalues of their
/// Gram matrix (Smith, "Eigenvalues of a Symmetric 3 × 3 Matrix", CACM 4(4), 1961).
std::array<double, 3> squared_semi_axes(const std::array<Vec3d, 3>& v) {
    const double mean = (v[0].length2() + v[1].length2() + v[2].length2()) / 3.0;
    Vec3d rows[3];
    double spread = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            rows[i][j] = v[static_cast<std::size_t>(i)].dot(v[static_cast<std::size_t>(j)]) - (i == j ? mean : 0.0);
            spread += rows[i][j] * rows[i][j] / 6.0;
        }
    if (!(spread > 0.0)) return {mean, mean, mean};
    const double p = std::sqrt(spread);
    const double half = 0.5 * (rows[0] / p).dot((rows[1] / p).cross(rows[2] / p));
    const double angle = std::acos(std::clamp(half, -1.0, 1.0)) / 3.0;
    const double most = mean + 2.0 * p * std::cos(angle);
    const double least = std::max(0.0, mean + 2.0 * p * std::cos(angle + 2.0 / 3.0 * std::numbers::pi));
    return {least, 3.0 * mean - most - least, most};
}

/// Returns Carlson's symmetric integral R_G, the mean over all unit vectors n of √(Σ xᵢ nᵢ²), of x by size. Those of
/// the first and second kind, of which it is made, come by duplication (Carlson, "Computing Elliptic Integrals by
/// Duplication", Numerische Mathematik 33, 1979).
double carlson_g(const std::array<double, 3>& by_size) {
    // The middle one has a part of its own, so that nothing cancels.
    const double x = by_size[0];
    const double y = by_size[2];
    const double z = by_size[1];
    if (!(z > 0.0)) return 0.5 * std::sqrt(y);
    constexpr int kDoublings = 30;  // each takes what is left of differences by four
    double a = x;
    double b = y;
    double c = z;
    double sum = 0.0;
    double scale = 1.0;
    for (int i = 0; i < kDoublings; ++i) {
        const double lambda = std::sqrt(a * b) + std::sqrt(b * c) + std::sqrt(c * a);
        sum += scale / (std::sqrt(c) * (c + lambda));
        scale *= 0.25;
        a = 0.25 * (a + lambda);
        b = 0.25 * (b + lambda);
        c = 0.25 * (c + lambda);
    }
    const double first = 1.0 / std::sqrt(c);
    const double second = 3.0 * sum + scale * first / c;
    return 0.5 * (z * first - (x - z) * (y - z) * second / 3.0 + std::sqrt(x * y / z));
}

}  // namespace

ExactShape::ExactShape(ShapeKind kind, const Mat4f& from_unit)
    : kind_(kind), from_unit_(from_unit), to_unit_(Imath::M44d(from_unit).inverse()) {}

Bounds ExactShape::bounds() const {
    Vec3f half(0.0f);
    for (int i = 0; i < 3; ++i) {
        const float x = std::abs(from_unit_[0][i]);
        const float y = std::abs(from_unit_[1][i]);
        const float z = std::abs(from_unit_[2][i]);
        half[i] = kind_ == ShapeKind::Sphere ? std::hypot(x, y, z)
                  : kind_ == ShapeKind::Disk ? std::hypot(x, y)
                                             : std::hypot(x, z) + y;
    }
    const Vec3f centre(from_unit_[3][0], from_unit_[3][1], from_unit_[3][2]);
    const Vec3f error = position_error(abs_components(centre) + half);
    return {centre - half - error, centre + half + error};
}

double ExactShape::volume() const {
    const Vec3d x = turned(Imath::M44d(from_unit_), {1.0, 0.0, 0.0});
    const Vec3d y = turned(Imath::M44d(from_unit_), {0.0, 1.0, 0.0});
    const Vec3d z = turned(Imath::M44d(from_unit_), {0.0, 0.0, 1.0});
    const double of_unit = kind_ == ShapeKind::Sphere     ? 4.0 / 3.0 * std::numbers::pi
                           : kind_ == ShapeKind::Cylinder ? 2.0 * std::numbers::pi
                                                          : 0.0;
    return of_unit * std::abs(x.dot(y.cross(z)));
}

double ExactShape::area(std::uint32_t face) const {
    const Vec3d x = turned(Imath::M44d(from_unit_), {1.0, 0.0, 0.0});
    const Vec3d y = turned(Imath::M44d(from_unit_), {0.0, 1.0, 0.0});
    const Vec3d z = turned(Imath::M44d(from_unit_), {0.0, 0.0, 1.0});
    if (kind_ == ShapeKind::Disk) return std::numbers::pi * x.cross(y).length();
    if (kind_ == ShapeKind::Cylinder)
        return std::numbers::pi * (face == kSide ? 4.0 * x.cross(y).length() : x.cross(z).length());
    // The mean of `stretch`, whose square is a quadratic form of the normal.
    return 4.0 * std::numbers::pi * carlson_g(squared_semi_axes({y.cross(z), z.cross(x), x.cross(y)}));
}

double ExactShape::stretch(const Vec3d& unit_normal) const {
    const Imath::M44d m(from_unit_);
    const Vec3d x = turned(m, {1.0, 0.0, 0.0});
    const Vec3d y = turned(m, {0.0, 1.0, 0.0});
    const Vec3d z = turned(m, {0.0, 0.0, 1.0});
    return (y.cross(z) * unit_normal.x + z.cross(x) * unit_normal.y + x.cross(y) * unit_normal.z).length();
}

double ExactShape::direction_stretch(const Vec3d& direction) const {
    const double along = turned(to_unit_, direction).length();
    return std::abs(determinant(to_unit_)) / (along * along * along);
}

bool ExactShape::is_round() const {
    constexpr double kTolerance = 1e-5;
    const Vec3d x = turned(Imath::M44d(from_unit_), {1.0, 0.0, 0.0});
    const Vec3d y = turned(Imath::M44d(from_unit_), {0.0, 1.0, 0.0});
    const Vec3d z = turned(Imath::M44d(from_unit_), {0.0, 0.0, 1.0});
    const auto are_square = [](const Vec3d& a, const Vec3d& b) {
        return std::abs(a.dot(b)) <= kTolerance * a.length() * b.length();
    };
    const auto are_alike = [](const Vec3d& a, const Vec3d& b) {
        return std::abs(a.length() - b.length()) <= kTolerance * a.length();
    };
    if (is_flat(kind_)) return true;
    return are_square(x, y) && are_square(y, z) && are_square(z, x) && are_alike(x, z) &&
           (kind_ == ShapeKind::Cylinder || are_alike(x, y));
}

ShapeCrossings ExactShape::crossings(const Vec3f& origin, const Vec3f& direction) const {
    const Vec3d o = to_unit(origin);
    const Vec3d d = turned(to_unit_, in_double(direction));
    std::array<UnitCrossing, 2> found;
    ShapeCrossings result;
    if (kind_ == ShapeKind::Sphere)
        result.count = cross_sphere(o, d, found);
    else if (kind_ == ShapeKind::Cylinder)
        result.count = cross_cylinder(o, d, found);
    else
        result.count = cross_disk(o, d, found);
    for (std::size_t i = 0; i < result.count; ++i)
        result.all[i] = {found[i].t, found[i].place, normal_of(to_unit_, found[i].normal),
                         is_flat(kind_) ? d.z < 0.0 : i == 1};
    return result;
}

ShapePoint ExactShape::point(const ShapePlace& place) const {
    const UnitPoint unit = unit_point(kind_, place);
    return {.position = transform_point(from_unit_, unit.position),
            .normal = normal_of(to_unit_, in_double(unit.normal)),
            .uv = unit.uv,
            .along_u = transform_vector(from_unit_, unit.along_u),
            .along_v = transform_vector(from_unit_, unit.along_v)};
}

Vec2f ExactShape::uv(const ShapePlace& place) const {
    return unit_point(kind_, place).uv;
}

float ExactShape::mean_curvature(const ShapePlace& place, const Mat4f& to_world) const {
    if (is_flat(kind_) || place.face != kSide) return 0.0f;
    // Of the surface on which a quadratic form of the place is constant (Goldman, "Curvature Formulas for Implicit
    // Curves and Surfaces", CAGD 22(7), 2005).
    const Imath::M44d to_unit = Imath::M44d(from_unit_ * to_world).inverse();
    Vec3d columns[3];
    for (int i = 0; i < 3; ++i) columns[i] = {to_unit[0][i], to_unit[1][i], to_unit[2][i]};
    Vec3d unit = in_double(unit_point(kind_, place).normal);
    double trace = columns[0].length2() + columns[2].length2();
    if (kind_ == ShapeKind::Sphere) trace += columns[1].length2();
    const Vec3d half_gradient = columns[0] * unit.x + columns[1] * unit.y + columns[2] * unit.z;
    double form = 0.0;  // the Hessian along the gradient, by 8
    for (int i = 0; i < 3; ++i) {
        const double along = kind_ == ShapeKind::Cylinder && i == 1 ? 0.0 : columns[i].dot(half_gradient);
        form += along * along;
    }
    const double length = half_gradient.length();
    return static_cast<float>((length * length * trace - form) / (2.0 * length * length * length));
}

Vec3d ExactShape::to_unit(const Vec3f& point) const {
    return turned(to_unit_, in_double(point)) + Vec3d(to_unit_[3][0], to_unit_[3][1], to_unit_[3][2]);
}

ShapePlace ExactShape::sphere_place(const Vec3d& direction) {
    return {0, to_octahedron(direction)};
}

ShapePlace ExactShape::sample(std::uint32_t face, Vec2f u) const {
    if (kind_ == ShapeKind::Sphere) return sphere_place(in_double(square_to_sphere(u)));
    if (kind_ == ShapeKind::Disk || face != kSide) return {face, square_to_disk(u)};
    const SinCos turn = sin_cos_turns(u.x);
    return {face, {to_square(static_cast<double>(turn.sin), static_cast<double>(turn.cos)), 2.0f * u.y - 1.0f}};
}

}  // namespace etendue
