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
            const AliasTable::Choice choice = table.sample(random.next());
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
    constexpr int kSteps = 80'000;
    std::vector<double> share(weights.size());
    for (int i = 0; i < kSteps; ++i) share[table.sample((static_cast<float>(i) + 0.5f) / kSteps).index] += 1.0 / kSteps;
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
            const AliasTable::Choice choice = table.sample(i == 0 ? 0x1.fffffep-1f : random.next());
            ASSERT_GT(weights[choice.index], 0.0);
        }
    }
}

TEST(AliasTable, WhatIsLeftOfTheNumberIsUniform) {
    const std::vector<double> weights{1.0, 2.0, 3.0};
    const AliasTable table(weights);
    for (std::uint32_t entry = 0; entry < 3; ++entry) {
        std::vector<double> observed(16);
        double count = 0.0;
        Random random(4);
        for (int i = 0; i < 60'000; ++i) {
            const AliasTable::Choice choice = table.sample(random.next());
            ASSERT_GE(choice.u_remapped, 0.0f);
            ASSERT_LT(choice.u_remapped, 1.0f);
            if (choice.index != entry) continue;
            observed[static_cast<std::size_t>(choice.u_remapped * 16.0f)] += 1.0;
            count += 1.0;
        }
        const Chi2Result result = chi2_counts(observed, std::vector<double>(16, count / 16.0));
        EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, 3)) << result.str();
    }
}

TEST(AliasTable, AllZeroWeightsAreEquallyLikely) {
    const AliasTable table(std::vector<double>(4, 0.0));
    for (std::uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(table.probability(i), 0.25f);
        EXPECT_EQ(table.sample((static_cast<float>(i) + 0.5f) / 4.0f).index, i);
    }
    EXPECT_TRUE(AliasTable().empty());
}

}  // namespace

}  // namespace etendue::test
