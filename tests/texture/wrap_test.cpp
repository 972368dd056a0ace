#include "texture/wrap.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(Wrap, RepeatIsTheRemainderHoweverFarTheTexelIs) {
    for (const int size : {1, 2, 3, 8, 13}) {
        int expected = 0;
        for (int i = -4 * size; i < 5 * size; ++i) {
            EXPECT_EQ(wrap_index(i, size, Wrap::Repeat), expected) << i << " of " << size;
            expected = expected + 1 == size ? 0 : expected + 1;
        }
    }
}

}  // namespace

}  // namespace etendue::test
