#include "sampling/alias_table.h"

#include "support/chi2.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<std::vector<double>> weight_lists() {
    std::vector<double> many(1000);
    Random random(1);
    for (double& weight : many) weight = std::pow(static_cast<double>(random.next()), 4.0);
    return {{1.0}, {1.0, 1.0, 1.0}, {0.0, 1.0, 0.0, 3.0, 0.0}, {1e-8, 1.0, 1e8}, {5.0, 4.0, 3.0, 2.0, 1.0}, many};
}

TEST(AliasTable, ProbabilitiesAreTheNormalisedWeights) {
    for (const std::vector<double>& weights : weight_lists()) {
        const AliasTable table(weights);
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        ASSERT_EQ(table.size(), weights.size());
        for (std::size_t i = 0; i < weights.size(); ++i)
            EXPECT_NEAR(static_cast<double>(table.probability(i)), weights[i] / total, 1e-6 * weights[i] / total);
    }
}

TEST(AliasTable, ChoicesFollowTheProbabilities) {
    constexpr int kSamples = 100'000;
    const auto lists = weight_lists();
    for (const std::vector<double>& weights : lists) {
        const AliasTable table(weights);
        std::vector<double> observed(weights.size());
        std::vector<double> expected(weights.size());
        Random random(2);
        for (int i = 0; i < kSamples; ++i) {
            const AliasTable::Choice choice = table.sample(random.next_2d());
            ASSERT_LT(choice.index, weights.size());
            ASSERT_EQ(choice.probability, table.probability(choice.index));
            ASSERT_GT(choice.probability, 0.0f);
            observed[choice.index] += 1.0;
        }
        for (std::size_t i = 0; i < weights.size(); ++i)
            expected[i] = static_cast<double>(table.probability(i)) * kSamples;
        const Chi2Result result = chi2_counts(observed, expected);
        EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, lists.size())) << result.str();
    }
}

// Exactly, without chance: the share of u that leads to an entry is its probability.
TEST(AliasTable, EvenNumbersGiveTheProbabilitiesExactly) {
    const std::vector<double> weights{1.0, 0.0, 2.5, 0.5, 4.0};
    const AliasTable table(weights);
    constexpr int kSteps = 16'000;
    std::vector<double> share(weights.size());
    for (int bin = 0; bin < 5; ++bin)
        for (int i = 0; i < kSteps; ++i)
            share[table.sample({(static_cast<float>(bin) + 0.5f) / 5.0f, (static_cast<float>(i) + 0.5f) / kSteps})
                      .index] += 0.2 / kSteps;
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(share[i], weights[i] / 8.0, 1e-4);
}

TEST(AliasTable, NeverChoosesAZeroWeight) {
    Random random(3);
    for (int list = 0; list < 500; ++list) {
        std::vector<double> weights(1 + static_cast<std::size_t>(random.next() * 40.0f));
        for (double& weight : weights) weight = random.next() < 0.5f ? 0.0 : static_cast<double>(random.next()) / 3.0;
        weights[weights.size() / 2] = 0.1;
        const AliasTable table(weights);
        for (int i = 0; i < 400; ++i) {
            const AliasTable::Choice choice =
                table.sample(i == 0 ? Vec2f(0x1.fffffep-1f, 0x1.fffffep-1f) : random.next_2d());
            ASSERT_GT(weights[choice.index], 0.0);
        }
    }
}

// Half of a million entries have a hundredth of the others' weight. One number for bin and decision would choose them
// six times too often.
TEST(AliasTable, LargeTablesKeepTheirProbabilities) {
    std::vector<double> weights(std::size_t{1} << 20, 1.0);
    for (std::size_t i = 0; i < weights.size(); i += 2) weights[i] = 0.01;
    const AliasTable table(weights);
    Random random(5);
    constexpr int kSamples = 400'000;
    int light = 0;
    for (int i = 0; i < kSamples; ++i) light += table.sample(random.next_2d()).index % 2 == 0 ? 1 : 0;
    const double expected = kSamples * 0.01 / 1.01;
    // Five standard deviations: a false alarm once in 1.7 million seeds.
    EXPECT_NEAR(light, expected, 5.0 * std::sqrt(expected));
}

TEST(AliasTable, AllZeroWeightsAreEquallyLikely) {
    const AliasTable table(std::vector<double>(4, 0.0));
    for (std::uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(table.probability(i), 0.25f);
        EXPECT_EQ(table.sample({(static_cast<float>(i) + 0.5f) / 4.0f, 0.5f}).index, i);
    }
    EXPECT_TRUE(AliasTable().empty());
}

}  // namespace

}  // namespace etendue::test
