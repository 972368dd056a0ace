#include "sampling/hash.h"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(Hash, FlipsHalfOfTheBitsForOneThatChanges) {
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
        double flipped = 0.0;
        constexpr std::uint32_t kKeys = 2000;
        for (std::uint32_t i = 0; i < kKeys; ++i) {
            const std::uint32_t key = i * 2654435761u;
            flipped += std::popcount(hash_u32(key) ^ hash_u32(key ^ (1u << bit)));
        }
        // 32 fair bits: mean 16, standard error sqrt(8 / n) = 0.06.
        EXPECT_NEAR(flipped / kKeys, 16.0, 0.5) << bit;
    }
}

TEST(Hash, CombineDependsOnOrder) {
    EXPECT_NE(hash_combine(hash_combine(1u, 2), 3), hash_combine(hash_combine(1u, 3), 2));
    EXPECT_NE(hash_combine(1u, 2), hash_combine(2u, 1));
}

TEST(ToUnitFloat, StaysBelowOne) {
    EXPECT_EQ(to_unit_float(0u), 0.0f);
    EXPECT_LT(to_unit_float(0xffffffffu), 1.0f);
    EXPECT_EQ(to_unit_float(0x80000000u), 0.5f);
}

}  // namespace

}  // namespace etendue
