#include "scene/aov_desc.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(ParseAov, TakesNamesSourcesAndDepths) {
    const auto depth = parse_aov("depth");
    ASSERT_TRUE(depth);
    EXPECT_EQ(depth->name, "depth");
    EXPECT_EQ(depth->source, "depth");
    EXPECT_FALSE(depth->is_float.has_value());
    const auto caustics = parse_aov("caustics=lpe:C <RD'a=b'> S+ L:float");
    ASSERT_TRUE(caustics);
    EXPECT_EQ(caustics->name, "caustics");
    EXPECT_EQ(caustics->source, "lpe:C <RD'a=b'> S+ L");
    EXPECT_EQ(caustics->is_float, true);
    EXPECT_EQ(parse_aov("Z=depth:half")->is_float, false);
}

TEST(ParseAov, TakesRanksOfMattesOnly) {
    const auto mattes = parse_aov("ids=cryptomatte_object:8:float");
    ASSERT_TRUE(mattes);
    EXPECT_EQ(mattes->name, "ids");
    EXPECT_EQ(mattes->source, "cryptomatte_object");
    EXPECT_EQ(mattes->ranks, 8);
    EXPECT_EQ(parse_aov("cryptomatte:4")->name, "cryptomatte");
    EXPECT_EQ(parse_aov("cryptomatte")->ranks, std::nullopt);
    EXPECT_EQ(parse_aov("key=light:8")->source, "light:8");
    EXPECT_EQ(parse_aov("key=light:8")->ranks, std::nullopt);
    for (const char* text : {"cryptomatte:", "cryptomatte:6x", "cryptomatte:6:6", "cryptomatte:99999999999"})
        EXPECT_FALSE(parse_aov(text).has_value()) << text;
}

TEST(ParseAov, RefusesOtherForms) {
    for (const char* text : {"", "=depth", "Z=", "a.b=depth", "a b", ":half", "x=:float", "lpe:C L"})
        EXPECT_FALSE(parse_aov(text).has_value()) << text;
    EXPECT_FALSE(parse_aov(std::string(101, 'a')).has_value());
}

TEST(ParseAov, IsUndoneByToText) {
    for (const char* text : {"depth", "N:half", "Z=depth:float", "c=lpe:C D S+ L", "x=cryptomatte_asset:8"})
        EXPECT_EQ(to_text(*parse_aov(text)), text);
}

}  // namespace
}  // namespace etendue
