#include "texture/cube_map.h"

#include <cmath>
#include <utility>

namespace etendue {

namespace {

/// A face, and where on it: u to its right, v down, both in [-1, 1] times `axis`.
struct FacePoint {
    std::size_t face;
    float axis;
    float u, v;
};

FacePoint to_face(const Vec3f& d) {
    const Vec3f a(std::abs(d.x), std::abs(d.y), std::abs(d.z));
    if (a.x >= a.y && a.x >= a.z) return d.x > 0.0f ? FacePoint{0, a.x, d.z, -d.y} : FacePoint{1, a.x, -d.z, -d.y};
    if (a.y >= a.z) return d.y > 0.0f ? FacePoint{2, a.y, -d.x, d.z} : FacePoint{3, a.y, -d.x, -d.z};
    return d.z > 0.0f ? FacePoint{4, a.z, -d.x, -d.y} : FacePoint{5, a.z, d.x, -d.y};
}

Texture to_texture(ImageF& image) {
    return {std::move(image), {.wrap_u = Wrap::Clamp, .wrap_v = Wrap::Clamp}};
}

}  // namespace

CubeMap::CubeMap(std::array<ImageF, 6> faces)
    : faces_{to_texture(faces[0]), to_texture(faces[1]), to_texture(faces[2]),
             to_texture(faces[3]), to_texture(faces[4]), to_texture(faces[5])} {}

Rgb CubeMap::lookup(const Vec3f& direction) const {
    const FacePoint p = to_face(direction);
    return faces_[p.face].lookup({0.5f + 0.5f * p.u / p.axis, 0.5f + 0.5f * p.v / p.axis}).rgb;
}

}  // namespace etendue
