#include "transport/mis.h"

#include "support/random.h"
#include "wave/subpath/arrival_columns.h"

#include <array>
#include <cstddef>

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

TEST(SubpathDensities, OfABlockAreThoseOfOne) {
    struct Arrival {
        DepartingDensities departing;
        double squared_distance, cosine;
    };
    Random random(53);
    const auto number = [&] { return static_cast<double>(random.next()); };
    ArrivalColumns columns;
    for (const Heuristic heuristic : {Heuristic::Balance, Heuristic::Power})
        for (const std::size_t count : {kBlockLanes, kBlockLanes - 5, std::size_t{1}}) {
            const Raised raised{heuristic};
            std::array<Arrival, kBlockLanes> arrivals;
            for (std::size_t l = 0; l < count; ++l) {
                // Some depart by deltas, some cannot arrive, and some were scattered where they are.
                arrivals[l] = {.departing{.d = 5.0 * number(),
                                          .pdf_forward = 2.0 * number(),
                                          .cosine = number(),
                                          .is_connectible = l % 3 != 0},
                               .squared_distance = l % 5 == 0 ? 0.0 : 9.0 * number(),
                               .cosine = l % 7 == 0 ? 0.0 : number()};
                columns.set(l, arrivals[l].departing, arrivals[l].squared_distance, arrivals[l].cosine);
            }
            columns.arrive(count, raised);
            for (std::size_t l = 0; l < count; ++l) {
                const auto& [departing, squared_distance, cosine] = arrivals[l];
                const SubpathDensities expected = departing.arrive(raised, squared_distance, cosine);
                EXPECT_EQ(columns[l].a, expected.a);
                EXPECT_EQ(columns[l].b, expected.b);
            }
        }
}

}  // namespace

}  // namespace etendue::test
