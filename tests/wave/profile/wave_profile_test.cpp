// What is counted of waves.
#include "wave/profile/wave_profile.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(WaveProfile, PathsEndWithTheirLengths) {
    WaveProfile profile(0);
    profile.count_eye_path_end(PathEnding::Roulette, {.x = 1, .y = 2, .sample = 3, .rays = 4});
    profile.count_eye_path_end(PathEnding::Roulette, {.rays = 1});
    profile.count_eye_path_end(PathEnding::Escaped, {.rays = 4});
    EXPECT_EQ(profile.eye_paths().paths(PathEnding::Roulette), 2u);
    EXPECT_EQ(profile.eye_paths().paths(PathEnding::Escaped), 1u);
    EXPECT_EQ(profile.eye_paths().lengths(), (std::vector<std::uint64_t>{0, 1, 0, 0, 2}));
    ASSERT_EQ(profile.longest().size(), 3u);
    EXPECT_EQ(profile.longest()[2].rays, 1);
    profile.count_eye_path_end(PathEnding::Unlit, {.rays = 1000000});
    EXPECT_EQ(profile.eye_paths().lengths().size(), static_cast<std::size_t>(PathTally::kMostRays) + 1);
    EXPECT_EQ(profile.longest().front().rays, 1000000);
}

TEST(WaveProfile, TheLongestPathsDoNotDependOnWhoTracedThem) {
    WaveProfile whole(0);
    WaveProfile parts[2] = {WaveProfile(0), WaveProfile(0)};
    for (int i = 0; i < 100; ++i) {
        const LongPath path{.x = 100 - i, .y = i % 7, .sample = 0, .rays = (i * 37) % 10};
        whole.count_eye_path_end(PathEnding::TooLong, path);
        parts[i % 3 == 0 ? 1 : 0].count_eye_path_end(PathEnding::TooLong, path);
    }
    parts[0].add(parts[1]);
    ASSERT_EQ(parts[0].longest().size(), WaveProfile::kLongPaths);
    ASSERT_EQ(whole.longest().size(), WaveProfile::kLongPaths);
    for (std::size_t i = 0; i < WaveProfile::kLongPaths; ++i) {
        EXPECT_EQ(parts[0].longest()[i].x, whole.longest()[i].x);
        EXPECT_EQ(parts[0].longest()[i].rays, whole.longest()[i].rays);
    }
    EXPECT_EQ(parts[0].eye_paths().paths(PathEnding::TooLong), 100u);
}

TEST(WaveProfile, SumsAreOfAllThreads) {
    WaveProfile a(1024);
    WaveProfile b(1024);
    const std::vector<Ray> rays(10);
    a.record(RayKind::Bounce, rays);
    b.record(RayKind::Bounce, rays);
    a.count_hits(RayKind::Bounce, 3);
    b.count_hits(RayKind::Bounce, 4);
    b.use().light_samples = 5;
    a.end_light_path(PathEnding::Roulette, 1);
    b.end_light_path(PathEnding::Escaped, 3);
    a.add(b);
    EXPECT_EQ(a.recorder(RayKind::Bounce).ray_count(), 20u);
    EXPECT_EQ(a.recorder(RayKind::Shadow).ray_count(), 0u);
    EXPECT_EQ(a.hits(RayKind::Bounce), 7u);
    EXPECT_EQ(a.use().light_samples, 5u);
    EXPECT_EQ(a.light_paths().lengths(), (std::vector<std::uint64_t>{0, 1, 0, 1}));
    EXPECT_EQ(a.light_paths().paths(PathEnding::Escaped), 1u);
    EXPECT_TRUE(a.eye_paths().lengths().empty());
}

}  // namespace

}  // namespace etendue::test
