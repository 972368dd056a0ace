#include "core/wide.h"

#include "sampling/mis.h"
#include "sampling/warp.h"
#include "support/lanes.h"

#include <array>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(WideSampling, WarpsAreThoseOfFloat) {
    EXPECT_LE((largest_lane_difference<2>(0.0f, 1.0f,
                                          [](const auto& in) {
                                              const Imath::Vec2 u(in[0], in[1]);
                                              const auto disk = square_to_disk(u);
                                              const auto direction = square_to_cosine_hemisphere(u);
                                              const auto triangle = square_to_triangle(u);
                                              return std::array{
                                                  disk.x,
                                                  disk.y,
                                                  direction.x,
                                                  direction.y,
                                                  direction.z * direction.z,
                                                  cosine_hemisphere_pdf_solid_angle(direction) * direction.z,
                                                  triangle.x,
                                                  triangle.y};
                                          })),
              4.0f);
}

TEST(WideSampling, TheMiddleOfTheSquareIsThatOfTheDisk) {
    const Imath::Vec2<Wide> middle = square_to_disk(Imath::Vec2<Wide>(Wide(0.5f), Wide(0.5f)));
    EXPECT_EQ(middle.x[0], 0.0f);
    EXPECT_EQ(middle.y[0], 0.0f);
}

TEST(WideSampling, PowerHeuristicIsThatOfFloat) {
    EXPECT_LE((largest_lane_difference<2>(0.0f, 100.0f,
                                          [](const auto& in) { return std::array{power_heuristic(in[0], in[1])}; })),
              1.0f);
}

}  // namespace

}  // namespace etendue::test
