#include "lightpath/expression.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// Message and offset of what is wrong with `text`; an empty message if nothing is.
std::pair<std::string, std::size_t> error_of(const std::string& text) {
    try {
        (void)parse_expression(text);
    } catch (const ExpressionError& error) {
        return {error.what(), error.offset()};
    }
    return {"", 0};
}

TEST(ParseExpression, TakesWhatIsWellFormed) {
    for (const char* text : {"C L", "CDL", "C D S+ L", "L S+ D E", "C (D|G)* <L'key'>", "C [^S]* [OB]", "!C S* L",
                             "C <RD'gold'> .{1,3} <L.'lamp_*'>", "C<T.>L", "C V{2} L", "C D{2,} B", "C<..'a b'>L"})
        EXPECT_EQ(error_of(text).first, "") << text;
}

TEST(ParseExpression, SaysWhatIsWrongAndWhere) {
    EXPECT_EQ(error_of(""), (std::pair<std::string, std::size_t>{"nothing where an event should be", 0}));
    EXPECT_EQ(error_of("C D X L").second, 4u);
    EXPECT_NE(error_of("C D X L").first.find("'X' is no event"), std::string::npos);
    EXPECT_EQ(error_of("C (D L").first, "'(' without its ')'");
    EXPECT_EQ(error_of("C (D L").second, 2u);
    EXPECT_EQ(error_of("C D) L").first, "')' without its beginning");
    EXPECT_EQ(error_of("C [D L").first, "'[' without its ']'");
    EXPECT_EQ(error_of("C [] L").first, "a set without events");
    EXPECT_EQ(error_of("C <RD L").second, 2u);
    EXPECT_EQ(error_of("C <RD'gold> L").first, "a name without its closing quote");
    EXPECT_EQ(error_of(R"(C <RD'gold\'> L)").first, "a name without its closing quote");
    EXPECT_NO_THROW((void)parse_expression(R"(C <RD'it\'s "gold" \\'> L)"));
    EXPECT_EQ(error_of("C <RT> L").first, "no event is all of this at once");
    EXPECT_EQ(error_of("C <L''>").first, "an empty name");
    for (const char* counts : {"C D{} L", "C D{3,1} L", "C D{0} L", "C D{65} L", "C D{-1} L", "C D{99999999999} L"})
        EXPECT_NE(error_of(counts).first.find("{N,M}"), std::string::npos) << counts;
}

TEST(ParseExpression, HasBounds) {
    EXPECT_NE(error_of(std::string(5000, 'D')).first.find("longer than"), std::string::npos);
    EXPECT_NE(error_of("C" + std::string(1000, '(') + "D" + std::string(1000, ')') + "L").first.find("groups"),
              std::string::npos);
    EXPECT_EQ(error_of("C D******** L").first, "");
    EXPECT_NE(error_of("C D********* L").first.find("repetition"), std::string::npos);
}

}  // namespace
}  // namespace etendue
