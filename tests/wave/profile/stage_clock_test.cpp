// Whose time a clock counts.
#include "wave/profile/stage_clock.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

void wait() {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

TEST(StageClock, TimeBelongsToTheStageThatEnds) {
    StageClock clock;
    clock.skip();
    wait();
    clock.stamp(Stage::Textures);
    wait();
    clock.skip();
    wait();
    clock.stamp(Stage::Occluded, RayKind::Shadow);
    EXPECT_GE(clock.seconds(Stage::Textures), 0.0019);
    EXPECT_GE(clock.seconds(Stage::Occluded), 0.0019);
    EXPECT_NEAR(clock.seconds(Stage::Occluded), clock.seconds(RayKind::Shadow), 1e-4);
    EXPECT_EQ(clock.seconds(RayKind::Bounce), 0.0);
    EXPECT_EQ(clock.seconds(Stage::Film), 0.0);
    EXPECT_EQ(clock.stamps(), 2u) << "what is skipped is no stage";
}

TEST(StageClock, BlocksWhoseStagesAreNotToldApartHaveThoseOfOthers) {
    StageClock clock;
    clock.skip();
    EXPECT_TRUE(clock.start_block());
    wait();
    clock.stamp_in_block(Stage::Numbers);
    wait();
    wait();
    clock.stamp_in_block(Stage::Material);
    const double numbers = clock.seconds(Stage::Numbers);
    const double material = clock.seconds(Stage::Material);
    EXPECT_FALSE(clock.start_block());
    for (int i = 0; i < 6; ++i) wait();
    clock.stamp_block();
    const double of_both = clock.seconds(Stage::Numbers) + clock.seconds(Stage::Material);
    EXPECT_GE(of_both, numbers + material + 0.0119);
    // How long ticks are is measured anew each time.
    constexpr double kTolerance = 0.05;
    EXPECT_NEAR(clock.seconds(Stage::Numbers) / of_both, numbers / (numbers + material), kTolerance);
    EXPECT_EQ(clock.seconds(Stage::Film), 0.0);
    EXPECT_TRUE(clock.start_block());
    EXPECT_EQ(clock.stamps(), 3u);
    StageClock other;
    other.add(clock);
    EXPECT_NEAR(other.seconds(Stage::Numbers) / other.seconds(Stage::Material), numbers / material, kTolerance);
}

TEST(StageClock, AStampTakesLessThanAMicrosecond) {
    const double seconds = StageClock::seconds_per_stamp();
    EXPECT_GT(seconds, 0.0);
    EXPECT_LT(seconds, 1e-6);
}

}  // namespace

}  // namespace etendue::test
