#include "integrator/path/path_columns.h"

#include "support/random.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// What the bits of a history stand for, one by one.
struct History {
    int edges = 1;
    bool after_delta = true;
    bool only_deltas = true;
    bool is_direct = true;

    void scatter(bool is_delta, int more_edges) {
        edges += more_edges;
        after_delta = is_delta;
        is_direct = only_deltas;
        only_deltas = only_deltas && is_delta;
    }
    [[nodiscard]] std::uint32_t bits() const {
        return static_cast<std::uint32_t>(edges) * path_history::kOneEdge |
               (after_delta ? path_history::kUnsampled : 0u) | (only_deltas ? path_history::kOnlyDeltas : 0u) |
               (is_direct ? path_history::kIsDirect : 0u);
    }
};

TEST(PathHistory, FollowsEveryWayToScatter) {
    EXPECT_EQ(path_history::kAtEye, History{}.bits());
    // All sequences of eight: deltas, lobes and media.
    for (int sequence = 0; sequence < 6561; ++sequence) {
        History expected;
        std::uint32_t history = path_history::kAtEye;
        for (int step = 0, left = sequence; step < 8; ++step, left /= 3) {
            const int kind = left % 3;
            expected.scatter(kind == 0, kind < 2 ? 1 : 0);
            history =
                kind == 0 ? path_history::after_delta(history) : path_history::after_lobe(history, kind == 1 ? 1u : 0u);
            ASSERT_EQ(history, expected.bits()) << "sequence " << sequence << ", step " << step;
            ASSERT_EQ(path_history::edges(history), expected.edges);
        }
    }
}

TEST(PathHistory, IsTheSameInLanes) {
    std::array<std::uint32_t, Wide::kWidth> before;
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
        before[lane] = static_cast<std::uint32_t>(lane) + path_history::kOneEdge;
    std::array<std::uint32_t, Wide::kWidth> after;
    path_history::after_lobe(WideBits::load(before.data()), 1).store_unaligned(after.data());
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
        EXPECT_EQ(after[lane], path_history::after_lobe(before[lane], 1));
}

// A wave whose paths end at random, block by block: those that are left stand one after the other, in their order.
TEST(BlockSurvivors, AreMovedTogetherInTheirOrder) {
    Random random(1);
    for (const std::size_t paths : {std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{65},
                                    std::size_t{1000}, PathColumns::kCapacity}) {
        const auto columns = std::make_unique<PathColumns>();
        std::vector<std::uint32_t> expected;
        std::vector<std::uint32_t> one_by_one(paths);
        for (std::size_t i = 0; i < paths; ++i) {
            columns->slot.set(i, static_cast<std::uint32_t>(i));
            columns->time.set(i, static_cast<float>(i));
            one_by_one[i] = static_cast<std::uint32_t>(i);
        }
        std::size_t kept = 0;
        for (std::size_t first = 0; first < paths; first += kBlockLanes) {
            BlockSurvivors survivors(first, kept);
            const std::size_t end = std::min(first + kBlockLanes, paths);
            const float share = random.next();  // some blocks lose all, others none
            for (std::size_t i = first; i < end; i += Wide::kWidth) {
                Wide goes_on(0.0f);
                for (std::size_t lane = 0; lane < Wide::kWidth && i + lane < end; ++lane) {
                    if (random.next() * 1.2f - 0.1f > share) continue;
                    goes_on.set(lane, 1.0f);
                    expected.push_back(static_cast<std::uint32_t>(i + lane));
                }
                survivors.add(goes_on != Wide(0.0f));
            }
            survivors.move(columns->slot);
            survivors.move(columns->time);
            survivors.for_each([&](std::size_t from, std::size_t to) { one_by_one[to] = one_by_one[from]; });
            kept = survivors.kept();
        }
        ASSERT_EQ(kept, expected.size());
        for (std::size_t i = 0; i < kept; ++i) {
            ASSERT_EQ(columns->slot[i], expected[i]) << paths;
            ASSERT_EQ(columns->time[i], static_cast<float>(expected[i])) << paths;
            ASSERT_EQ(one_by_one[i], expected[i]) << paths;
        }
    }
}

TEST(PathColumns, HoldTheRaysThatBeginAtTheEye) {
    const auto columns = std::make_unique<PathColumns>();
    std::vector<Ray> rays(21);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto number = static_cast<float>(i);
        rays[i].origin = {number, number + 0.25f, number + 0.5f};
        rays[i].direction = {-number, 1.0f, number};
        rays[i].time = 0.01f * number;
        rays[i].alpha_key = static_cast<std::uint32_t>(i) * 7u;
    }
    std::vector<CameraSample> samples(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        samples[i].key = {static_cast<std::uint32_t>(i) + 100u, static_cast<std::uint32_t>(i) + 200u};
    columns->begin(rays, samples);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray ray = columns->ray(i);
        EXPECT_EQ(ray.origin, rays[i].origin);
        EXPECT_EQ(ray.direction, rays[i].direction);
        EXPECT_EQ(ray.time, rays[i].time);
        EXPECT_EQ(ray.alpha_key, rays[i].alpha_key);
        EXPECT_EQ(ray.t_max, rays[i].t_max);
        EXPECT_EQ(columns->slot[i], i);
        EXPECT_EQ(columns->key(i).pixel_seed, samples[i].key.pixel_seed);
        EXPECT_EQ(columns->key(i).index, samples[i].key.index);
        EXPECT_EQ(columns->throughput[i], Rgb(1.0f));
        EXPECT_EQ(columns->roulette_scale[i], 1.0f);
        EXPECT_TRUE(columns->is(path_history::kUnsampled, i));
        EXPECT_EQ(columns->edges(i), 1);
    }
}

}  // namespace

}  // namespace etendue::test
