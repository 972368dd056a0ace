// A sample of rays: what is kept, and that every segment has the same chance.
#include "wave/profile/ray_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Rays that tell their number.
std::vector<Ray> numbered(std::size_t first, std::size_t count) {
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) rays[i].t_max = static_cast<float>(first + i);
    return rays;
}

TEST(RayRecorder, KeepsAllWhileThereIsRoomAndNeighboursTogether) {
    RayRecorder recorder(2048);
    recorder.offer(numbered(0, 300));
    recorder.offer(numbered(300, 10));
    ASSERT_EQ(recorder.segments().size(), 3u);
    EXPECT_EQ(recorder.segments()[0].size(), RayRecorder::kSegment);
    EXPECT_EQ(recorder.segments()[1].size(), 300 - RayRecorder::kSegment);
    EXPECT_EQ(recorder.segments()[2].size(), 10u);
    EXPECT_EQ(recorder.ray_count(), 310u);
    std::size_t next = 0;
    for (const std::vector<Ray>& segment : recorder.segments())
        for (const Ray& ray : segment) EXPECT_EQ(ray.t_max, static_cast<float>(next++));
}

TEST(RayRecorder, EverySegmentIsKeptWithTheSameChance) {
    // 8 of 64 segments, by 4,000 recorders that have seen other numbers of segments before.
    constexpr std::size_t kSegments = 64;
    constexpr std::size_t kKept = 8;
    constexpr int kTrials = 4000;
    std::vector<int> kept(kSegments, 0);
    for (int trial = 0; trial < kTrials; ++trial) {
        RayRecorder recorder(kKept * RayRecorder::kSegment);
        // The choice is a hash of the numbers of segments: what was offered before shifts them.
        for (int before = 0; before < trial; ++before) recorder.offer(numbered(1000000, 1));
        for (std::size_t s = 0; s < kSegments; ++s) recorder.offer(numbered(s, 1));
        for (const std::vector<Ray>& segment : recorder.segments())
            if (segment.front().t_max < 1000.0f) ++kept[static_cast<std::size_t>(segment.front().t_max)];
    }
    double expected = 0.0;
    double variance = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const double chance = std::min(
            1.0, static_cast<double>(kKept) / static_cast<double>(static_cast<std::size_t>(trial) + kSegments));
        expected += chance;
        variance += chance * (1.0 - chance);
    }
    // Whether two of them are kept is correlated negatively: their sum varies less than that of independent ones.
    const double all = std::accumulate(kept.begin(), kept.end(), 0.0);
    EXPECT_NEAR(all, kSegments * expected, 4.5 * std::sqrt(kSegments * variance));
    // 4.5 standard deviations, 65 times: false alarms below 5e-4.
    for (std::size_t s = 0; s < kSegments; ++s) EXPECT_NEAR(kept[s], expected, 4.5 * std::sqrt(variance)) << s;
}

// Three threads of which one was offered ten times as much as another: 40 segments of each are kept, and after the
// merge the same share of what each was offered, from anywhere among the 40.
TEST(RayRecorder, EverySegmentOfAllThreadsIsKeptWithTheSameChance) {
    constexpr std::size_t kThreads = 3;
    constexpr std::size_t kKept = 40;
    constexpr std::size_t kQuarters = 4;
    constexpr int kTrials = 1500;
    std::array<std::array<double, kQuarters>, kThreads> kept{};
    std::array<double, kThreads> expected{};
    std::mt19937 random(1);
    for (int trial = 0; trial < kTrials; ++trial) {
        // What is left out follows from the counts: each trial has others.
        std::vector<RayRecorder> threads(kThreads, RayRecorder(kKept * RayRecorder::kSegment));
        std::array<std::size_t, kThreads> counts{60, 600, 200};
        for (std::size_t& count : counts) count += random() % count;
        const double chance = static_cast<double>(kKept) / static_cast<double>(std::ranges::max(counts));
        RayRecorder all(0);
        for (std::size_t t = 0; t < kThreads; ++t) {
            for (std::size_t s = 0; s < counts[t]; ++s) threads[t].offer(numbered(10000 * t + s, 1));
            all.add(threads[t]);
            expected[t] += chance * static_cast<double>(counts[t]) / kQuarters;
        }
        EXPECT_NEAR(all.chance(), chance, 1e-12);
        std::set<float> numbers;
        for (const std::vector<Ray>& segment : all.segments()) numbers.insert(segment.front().t_max);
        EXPECT_EQ(numbers.size(), all.segments().size());
        for (std::size_t t = 0; t < kThreads; ++t)
            for (std::size_t place = 0; place < kKept; ++place)
                if (numbers.contains(threads[t].segments()[place].front().t_max)) ++kept[t][kQuarters * place / kKept];
    }
    // Variances are smaller than those of independent choices. 4.5 standard deviations, 12 times: false alarms below
    // 1e-4.
    for (std::size_t t = 0; t < kThreads; ++t)
        for (const double count : kept[t]) EXPECT_NEAR(count, expected[t], 4.5 * std::sqrt(expected[t])) << t;
}

TEST(RayRecorder, KeepsOfColumnsWhatItKeepsOfRays) {
    constexpr std::size_t kRays = 300;
    std::vector<float> numbers(kRays + RayColumns::kPacket);
    std::vector<std::uint32_t> keys(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<float>(i);
        keys[i] = static_cast<std::uint32_t>(i);
    }
    const float* column = numbers.data();
    const RayColumns batch{column, column, column, column, column, column, column, column, keys.data(), kRays};
    RayRecorder of_columns(512);
    RayRecorder of_rays(512);
    for (int round = 0; round < 20; ++round) {
        of_columns.offer(batch);
        of_rays.offer(numbered(0, kRays));
    }
    ASSERT_EQ(of_columns.segments().size(), of_rays.segments().size());
    EXPECT_EQ(of_columns.chance(), of_rays.chance());
    for (std::size_t s = 0; s < of_rays.segments().size(); ++s) {
        ASSERT_EQ(of_columns.segments()[s].size(), of_rays.segments()[s].size());
        for (std::size_t i = 0; i < of_rays.segments()[s].size(); ++i) {
            const Ray& ray = of_columns.segments()[s][i];
            EXPECT_EQ(ray.t_max, of_rays.segments()[s][i].t_max);
            EXPECT_EQ(ray.direction.z, ray.t_max);
            EXPECT_EQ(static_cast<float>(ray.alpha_key), ray.t_max);
        }
    }
}

TEST(RayRecorder, NothingIsKeptWithoutRoom) {
    RayRecorder recorder(0);
    recorder.offer(numbered(0, 1000));
    EXPECT_EQ(recorder.ray_count(), 0u);
}

}  // namespace

}  // namespace etendue::test
