#include "lightpath/label_classes.h"

#include <array>

#include <gtest/gtest.h>

namespace etendue {
namespace {

TEST(MatchesLabel, AStarStandsForAnyCharacters) {
    EXPECT_TRUE(matches_label("key", "key"));
    EXPECT_FALSE(matches_label("key", "keys"));
    EXPECT_FALSE(matches_label("keys", "key"));
    EXPECT_TRUE(matches_label("key*", "key"));
    EXPECT_TRUE(matches_label("key*", "key.001"));
    EXPECT_TRUE(matches_label("*lamp*left*", "desk lamp 2 left"));
    EXPECT_FALSE(matches_label("*lamp*left", "desk lamp left 2"));
    EXPECT_TRUE(matches_label("a*ab", "aaab"));
    EXPECT_TRUE(matches_label("*", ""));
    EXPECT_FALSE(matches_label("", "a"));
}

TEST(MatchesLabel, ABackslashMakesAStarOne) {
    for (const char* name : {"*", "key*", "a\\", "\\*", "it's", R"("it's")"}) {
        EXPECT_TRUE(matches_label(label_pattern(name), name)) << name;
        EXPECT_FALSE(matches_label(label_pattern(name), std::string(name) + "x")) << name;
    }
    EXPECT_FALSE(matches_label(label_pattern("*"), "key"));
    EXPECT_TRUE(matches_label("C:\\lamp", "C:\\lamp")) << "before other characters it is itself";
}

TEST(MatchesLabel, ManyStarsDoNotTakeLong) {
    EXPECT_FALSE(matches_label(std::string(2000, '*') + "b", std::string(2000, 'a')));
    std::string pattern;
    for (int i = 0; i < 1000; ++i) pattern += "*a";
    EXPECT_FALSE(matches_label(pattern + "b", std::string(3000, 'a')));
}

TEST(LabelClasses, NamesThatNoPatternTellsApartAreOne) {
    const std::array<std::string, 5> names{"gold", "glass", "gold leaf", "paint", "glass"};
    const LabelClasses classes({"glass", "gold*", "silver"}, names);
    EXPECT_EQ(classes.count(), 3u);
    EXPECT_EQ(classes.of(0), classes.of(2));
    EXPECT_EQ(classes.of(1), classes.of(4));
    EXPECT_EQ(classes.of(3), 0);
    EXPECT_TRUE(classes.matches(classes.of(0), "gold*"));
    EXPECT_FALSE(classes.matches(classes.of(0), "glass"));
    EXPECT_FALSE(classes.matches(classes.of(3), "glass"));
    EXPECT_TRUE(classes.matches(classes.of(3), ""));
    EXPECT_EQ(classes.unmatched(), std::vector<std::string>{"silver"});
}

TEST(LabelClasses, AliasesMatchAsNamesDo) {
    const std::array<std::string, 3> names{"bulb", "bulb", "spot"};
    const std::array<std::string, 2> aliases{"", "left lamp"};
    const LabelClasses classes({"bulb", "left*", "*"}, names, aliases);
    EXPECT_EQ(classes.count(), 4u) << "nothing, bulb, the left bulb, and what only * matches";
    EXPECT_FALSE(classes.matches(classes.of(0), "left*"));
    EXPECT_TRUE(classes.matches(classes.of(1), "left*"));
    EXPECT_TRUE(classes.matches(classes.of(1), "bulb"));
    EXPECT_FALSE(classes.matches(classes.of(2), "left*"));
}

}  // namespace
}  // namespace etendue
