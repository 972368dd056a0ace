#include "transport/connecting_ray.h"

#include "core/wide.h"
#include "support/lanes.h"

#include <array>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(WideConnectingRay, IsThatOfFloat) {
    EXPECT_LE((largest_lane_difference<6>(-1.0f, 1.0f,
                                          [](const auto& in) {
                                              const ConnectingRay connection(Imath::Vec3(in[0], in[1], in[2]),
                                                                             Imath::Vec3(in[3], in[4], in[5]));
                                              return std::array{connection.direction.x, connection.direction.y,
                                                                connection.direction.z, connection.t_max};
                                          })),
              2.0f);
    const Imath::Vec3<Wide> here(Wide(1.0f), Wide(2.0f), Wide(3.0f));
    const ConnectingRay<Wide> nowhere(here, here);
    EXPECT_EQ(Vec3f(nowhere.direction.x[0], nowhere.direction.y[0], nowhere.direction.z[0]), Vec3f(0.0f, 0.0f, 1.0f));
    EXPECT_EQ(nowhere.t_max[0], 0.0f);
}

}  // namespace

}  // namespace etendue::test
