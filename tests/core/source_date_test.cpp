#include "core/source_date.h"

#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(SourceDate, IsThatOfTheEnvironment) {
    ::unsetenv("SOURCE_DATE_EPOCH");
    EXPECT_FALSE(source_date());
    EXPECT_NEAR(static_cast<double>(creation_time()), static_cast<double>(std::time(nullptr)), 5.0);
    ::setenv("SOURCE_DATE_EPOCH", "86400", 1);
    EXPECT_EQ(source_date(), 86400);
    EXPECT_EQ(creation_time(), 86400);
    for (const char* wrong : {"-1", "1.5", "now", " 1", "99999999999999999999"}) {
        ::setenv("SOURCE_DATE_EPOCH", wrong, 1);
        EXPECT_THROW((void)source_date(), std::invalid_argument) << wrong;
    }
    ::unsetenv("SOURCE_DATE_EPOCH");
}

}  // namespace

}  // namespace etendue
