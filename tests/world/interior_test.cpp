#include "world/interior.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Interior, TheFirstByPrecedenceFillsTheSpace) {
    Interior interior;
    EXPECT_TRUE(interior.is_empty());
    EXPECT_EQ(interior.filling(), kNone);
    interior.enter(5);
    EXPECT_EQ(interior.filling(), 5u);
    interior.enter(2);
    interior.enter(9);
    EXPECT_EQ(interior.filling(), 2u);
    interior.leave(2);
    EXPECT_EQ(interior.filling(), 5u);
    interior.leave(5);
    interior.leave(9);
    EXPECT_TRUE(interior.is_empty());
}

TEST(Interior, ABodyEnteredTwiceIsLeftTwice) {
    Interior interior;
    interior.enter(3);
    interior.enter(3);
    interior.leave(3);
    EXPECT_EQ(interior.filling(), 3u);
    interior.leave(3);
    EXPECT_EQ(interior.filling(), kNone);
}

TEST(Interior, LeavingWhatItIsNotInIsIgnored) {
    Interior interior;
    interior.leave(1);
    interior.enter(4);
    interior.leave(1);
    EXPECT_EQ(interior.filling(), 4u);
}

TEST(Interior, BeyondItsCapacityBodiesAreAsIfTheyWereNotThere) {
    Interior interior;
    for (std::uint32_t i = 0; i < Interior::kCapacity; ++i) interior.enter(10 + i);
    interior.enter(1);
    EXPECT_EQ(interior.filling(), 10u);
    interior.leave(1);
    for (std::uint32_t i = 0; i < Interior::kCapacity; ++i) interior.leave(10 + i);
    EXPECT_TRUE(interior.is_empty());
}

}  // namespace

}  // namespace etendue::test
