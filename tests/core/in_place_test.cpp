#include "core/in_place.h"

#include <optional>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Knows where it was made, and counts how often one was copied.
struct Located {
    Located() = default;
    Located(const Located& other) : value(other.value), copies(other.copies + 1) {}
    Located& operator=(const Located&) = delete;

    int value = 0;
    int copies = 0;
    const Located* made_at = this;
};

Located make(int value) {
    Located located;
    located.value = value;
    return located;
}

TEST(InPlace, MakesNoCopy) {
    Located object = make(1);
    make_in_place(object, [] { return make(7); });
    EXPECT_EQ(object.value, 7);
    EXPECT_EQ(object.copies, 0);
    EXPECT_EQ(object.made_at, &object);
}

TEST(InPlace, MakesWhatAnOptionalHolds) {
    std::optional<Located> object;
    object.emplace(InPlace{[] { return make(7); }});
    EXPECT_EQ(object->value, 7);
    EXPECT_EQ(object->copies, 0);
    EXPECT_EQ(object->made_at, &*object);
}

}  // namespace

}  // namespace etendue::test
