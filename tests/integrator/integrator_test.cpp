#include "integrator/integrator.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(RenderCounters, AddUp) {
    RenderCounters a;
    a.rays[RayKind::Primary] = 1;
    a.rays[RayKind::Bounce] = 20;
    a.rays[RayKind::Shadow] = 300;
    a.samples = 5;
    RenderCounters b = a;
    b.rays[RayKind::Primary] = 7;
    a.add(b);
    EXPECT_EQ(a.rays[RayKind::Primary], 8u);
    EXPECT_EQ(a.rays.total(), 8u + 40u + 600u);
    EXPECT_EQ(a.samples, 10u);
}

TEST(RenderCounters, LocateTheFirstDroppedSamplesAndCountAll) {
    RenderCounters a;
    for (int i = 0; i < 5; ++i) a.drop({i, 0, 0});
    RenderCounters b;
    for (int i = 0; i < 20; ++i) b.drop({i, 1, 0});
    EXPECT_EQ(b.first_dropped.size(), RenderCounters::kMaxLocated);
    a.add(b);
    EXPECT_EQ(a.dropped, 25u);
    ASSERT_EQ(a.first_dropped.size(), RenderCounters::kMaxLocated);
    EXPECT_EQ(a.first_dropped[4].x, 4);
    EXPECT_EQ(a.first_dropped[5].x, 0);
    EXPECT_EQ(a.first_dropped[5].y, 1);
}

}  // namespace

}  // namespace etendue::test
