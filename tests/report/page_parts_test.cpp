#include "report/page_parts.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

std::string base64_of(const std::string& text) {
    return to_base64(std::vector<unsigned char>(text.begin(), text.end()));
}

// RFC 4648, section 10.
TEST(Base64, IsAsPublished) {
    EXPECT_EQ(base64_of(""), "");
    EXPECT_EQ(base64_of("f"), "Zg==");
    EXPECT_EQ(base64_of("fo"), "Zm8=");
    EXPECT_EQ(base64_of("foo"), "Zm9v");
    EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(to_base64(std::vector<unsigned char>{0xfb, 0xff}), "+/8=");
}

TEST(ForScript, EndsNoElement) {
    EXPECT_EQ(for_script("\"</script><!--\""), "\"\\u003c/script>\\u003c!--\"");
}

TEST(FillPage, PutsDataAtTheirPlaces) {
    EXPECT_EQ(fill_page("a @REPORT@ b @IMAGES@ c", "\"@IMAGES@\"", "<"), "a \"@IMAGES@\" b \\u003c c");
    EXPECT_THROW((void)fill_page("a @REPORT@", "", ""), std::logic_error);
}

}  // namespace

}  // namespace etendue
