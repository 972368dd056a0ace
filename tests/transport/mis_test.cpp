#include "transport/mis.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr DepartingDensities kDeparting{.d = 3.0, .pdf_forward = 0.25, .cosine = 0.8};

TEST(SubpathDensities, OfTheNextVertexAreThoseOfTheRecursion) {
    for (const Heuristic heuristic : {Heuristic::Balance, Heuristic::Power}) {
        const Raised raised{heuristic};
        constexpr double kSquared = 4.0;
        constexpr double kArriving = 0.5;
        const double next = raised(kDeparting.pdf_forward * kArriving / kSquared);
        const SubpathDensities arrived = kDeparting.arrive(raised, kSquared, kArriving);
        EXPECT_DOUBLE_EQ(arrived.a, 1.0 / next);
        EXPECT_DOUBLE_EQ(arrived.b, raised(kDeparting.cosine / kSquared) * kDeparting.d / next);
    }
}

// One draw in some ten million scatters light in a medium again where it has just been scattered.
TEST(SubpathDensities, AreFiniteAfterNoDistance) {
    for (const Heuristic heuristic : {Heuristic::Balance, Heuristic::Power}) {
        const Raised raised{heuristic};
        const SubpathDensities arrived = kDeparting.arrive(raised, 0.0, 0.5);
        EXPECT_EQ(arrived.a, 0.0);
        EXPECT_DOUBLE_EQ(arrived.b, kDeparting.arrive(raised, 1.0, 0.5).b);
    }
}

TEST(SubpathDensities, AreNoneWhereNothingArrives) {
    const SubpathDensities arrived = kDeparting.arrive(Raised{}, 1.0, 0.0);
    EXPECT_EQ(arrived.a, 0.0);
    EXPECT_EQ(arrived.b, 0.0);
}

}  // namespace

}  // namespace etendue::test
