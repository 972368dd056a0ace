#include "core/wide_rows.h"

#include <array>
#include <cstddef>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// As many rows as lanes.
struct Rows {
    alignas(kRowFloats * sizeof(float)) std::array<std::array<float, kRowFloats>, Wide::kWidth> values{};

    /// In an order that is not that of memory.
    template <typename T>
    [[nodiscard]] std::array<T*, Wide::kWidth> places() {
        std::array<T*, Wide::kWidth> places;
        for (std::size_t i = 0; i < places.size(); ++i) places[i] = values[(3 * i + 1) % Wide::kWidth].data();
        return places;
    }
};

float number(std::size_t row, std::size_t column) {
    return static_cast<float>(100 * row + column);
}

TEST(WideRows, AreReadColumnByColumn) {
    Rows rows;
    const auto places = rows.places<const float>();
    for (std::size_t i = 0; i < Wide::kWidth; ++i)
        for (std::size_t j = 0; j < kRowFloats; ++j) rows.values[(3 * i + 1) % Wide::kWidth][j] = number(i, j);
    const WideRow columns = load_rows(places);
    for (std::size_t i = 0; i < Wide::kWidth; ++i)
        for (std::size_t j = 0; j < kRowFloats; ++j) EXPECT_EQ(columns[j][i], number(i, j));
}

TEST(WideRows, AreWrittenAsTheyAreRead) {
    WideRow columns;
    for (std::size_t j = 0; j < kRowFloats; ++j) {
        alignas(Wide::kAlignment) std::array<float, Wide::kWidth> lanes;
        for (std::size_t i = 0; i < lanes.size(); ++i) lanes[i] = number(i, j);
        columns[j] = Wide::load(lanes.data());
    }
    Rows rows;
    store_rows(columns, rows.places<float>());
    for (std::size_t i = 0; i < Wide::kWidth; ++i)
        for (std::size_t j = 0; j < kRowFloats; ++j)
            EXPECT_EQ(rows.values[(3 * i + 1) % Wide::kWidth][j], number(i, j));
}

}  // namespace

}  // namespace etendue::test
