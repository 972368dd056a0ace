#include "core/wide.h"
#include "light/mesh_light.h"
#include "support/lanes.h"

#include <array>
#include <type_traits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(WideMeshLight, PointsOnTrianglesAreThoseOfFloat) {
    EXPECT_LE((largest_lane_difference<16>(
                  -1.0f, 1.0f,
                  [](const auto& in) {
                      const auto vec = [&](std::size_t first) {
                          return Imath::Vec3(in[first], in[first + 1], in[first + 2]);
                      };
                      using Lane = std::decay_t<decltype(in[0])>;
                      // Somewhere above the point, so that distances stay away from zero.
                      auto p0 = vec(0);
                      p0.z += 4.0f;
                      const auto one_sided = in[15] * 0.0f;
                      const auto normal = normalize(vec(9));
                      const LightTriangleFront<Lane> front{
                          p0, vec(3), vec(6), normal, abs(in[12]) * 1e-3f, in[15] * 0.0f + 2.0f, one_sided};
                      const Imath::Vec2 u(abs(in[13]), abs(in[14]));
                      const auto sample = front.sample(vec(12), u);
                      // Near the edge between light and dark the density has no bound.
                      const auto faces = sample.cos_light > one_sided + 0.1f;
                      const auto both =
                          LightTriangleFront<Lane>{
                              p0, vec(3), vec(6), normal, abs(in[12]) * 1e-3f, in[15] * 0.0f + 2.0f, one_sided + 1.0f}
                              .sample(vec(12), u);
                      const auto faces_either = abs(both.cos_light) > one_sided + 0.1f;
                      return std::array{sample.wi.x,
                                        sample.wi.y,
                                        sample.wi.z,
                                        sample.distance,
                                        sample.cos_light,
                                        sample.end.x,
                                        sample.end.y,
                                        sample.end.z,
                                        sample.barycentric.x,
                                        select(faces, sample.pdf_solid_angle, one_sided),
                                        select(faces_either, both.pdf_solid_angle, one_sided),
                                        select(sample.cos_light < one_sided, sample.pdf_solid_angle, one_sided)};
                  })),
              32.0f);
}

}  // namespace

}  // namespace etendue::test
