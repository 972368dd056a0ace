#include "bsdf/diffuse.h"
#include "core/wide.h"
#include "support/lanes.h"

#include <array>
#include <type_traits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(WideDiffuse, IsThatOfFloat) {
    EXPECT_LE((largest_lane_difference<8>(-1.0f, 1.0f,
                                          [](const auto& in) {
                                              const BasicRgb albedo{in[0], in[1], in[2]};
                                              const BasicDiffuse<std::decay_t<decltype(in[0])>> lobe{albedo};
                                              const Imath::Vec3 wo(in[3], in[4], in[5]);
                                              const Imath::Vec3 wi(in[4], in[5], in[6]);
                                              const Imath::Vec2 u(abs(in[6]), abs(in[7]));
                                              const auto value = lobe.evaluate(wo, wi, TransportMode::Radiance);
                                              const auto sample = lobe.sample(wo, 0.0f, u, TransportMode::Radiance);
                                              return std::array{
                                                  value.f_cos.r,         value.f_cos.g,
                                                  value.f_cos.b,         sample.weight.r,
                                                  sample.weight.g,       sample.weight.b,
                                                  sample.wi.x,           sample.wi.y,
                                                  value.pdf_solid_angle, sample.pdf_solid_angle * sample.wi.z};
                                          })),
              4.0f);
}

}  // namespace

}  // namespace etendue::test
