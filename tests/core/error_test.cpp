#include "core/error.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(SourceLocation, NamesTheFileAndThePlaceInIt) {
    EXPECT_EQ((SourceLocation{"a.gltf", "/nodes/3"}).str(), "a.gltf#/nodes/3");
    EXPECT_EQ((SourceLocation{"a.gltf", ""}).str(), "a.gltf");
}

TEST(Problem, SaysHowBadWhereAndWhat) {
    EXPECT_EQ((Problem{Severity::Error, {"a.gltf", "/nodes/3"}, "no such mesh"}).str(),
              "error: a.gltf#/nodes/3: no such mesh");
    EXPECT_EQ((Problem{Severity::Warning, {}, "no light"}).str(), "warning: no light");
    EXPECT_EQ((Problem{Severity::Note, {"a", ""}, "framed"}).str(), "note: a: framed");
}

TEST(ProblemList, KeepsTheOrderAndKnowsItsErrors) {
    ProblemList problems;
    problems.note({}, "one");
    problems.warning({}, "two");
    EXPECT_FALSE(problems.has_errors());
    problems.error({"f", "/p"}, "three");
    EXPECT_TRUE(problems.has_errors());
    EXPECT_EQ(problems.error_count(), 1u);
    ASSERT_EQ(problems.all().size(), 3u);
    EXPECT_EQ(problems.all()[0].message, "one");
    EXPECT_EQ(problems.all()[2].where.pointer, "/p");
}

TEST(ProblemList, KeepsOnlySoManyButCountsTheRest) {
    ProblemList problems;
    for (std::size_t i = 0; i < ProblemList::kMaxProblems + 7; ++i) problems.error({}, std::to_string(i));
    EXPECT_EQ(problems.all().size(), ProblemList::kMaxProblems);
    EXPECT_EQ(problems.dropped(), 7u);
    EXPECT_EQ(problems.error_count(), ProblemList::kMaxProblems + 7);
    EXPECT_NE(std::string(SceneError(problems).what()).find("and 7 more"), std::string::npos);
}

TEST(ProblemList, AnErrorAmongTheDroppedStillCounts) {
    ProblemList problems;
    for (std::size_t i = 0; i < ProblemList::kMaxProblems; ++i) problems.note({}, "n");
    problems.error({}, "e");
    EXPECT_TRUE(problems.has_errors());
}

TEST(ProblemList, KeepsBeginningAndEndOfWhatIsLong) {
    ProblemList problems;
    std::string umlauts;
    while (umlauts.size() < 100'000) umlauts += "\u00fc";
    problems.error({"f", "/a" + umlauts + "/b"}, "first " + umlauts + " last");
    const Problem& problem = problems.all()[0];
    EXPECT_LE(problem.where.pointer.size(), ProblemList::kMaxPointer);
    EXPECT_LE(problem.message.size(), ProblemList::kMaxMessage);
    EXPECT_TRUE(problem.where.pointer.starts_with("/a") && problem.where.pointer.ends_with("\u00fc/b"));
    EXPECT_TRUE(problem.message.starts_with("first ") && problem.message.ends_with("\u00fc last"));
    EXPECT_NE(problem.message.find("\u00fc ... \u00fc"), std::string::npos) << "whole characters";
}

TEST(ProblemList, IsFullWhenMoreAreOnlyCounted) {
    ProblemList problems;
    for (std::size_t i = 1; i < ProblemList::kMaxProblems; ++i) problems.note({}, "n");
    EXPECT_FALSE(problems.is_full());
    problems.note({}, "n");
    EXPECT_TRUE(problems.is_full());
}

TEST(SceneError, ListsTheErrorsOnly) {
    ProblemList problems;
    problems.warning({}, "harmless");
    problems.error({"f", "/a"}, "first");
    problems.error({"f", "/b"}, "second");
    EXPECT_STREQ(SceneError(problems).what(), "error: f#/a: first\nerror: f#/b: second");
    EXPECT_EQ(SceneError(problems).problems().all().size(), 3u);
    EXPECT_STREQ(SceneError({"f", "/a"}, "alone").what(), "error: f#/a: alone");
}

TEST(NearestName, SuggestsWhatWasMeant) {
    constexpr std::array<std::string_view, 4> kKnown = {"integrator", "environment", "film", "seed"};
    EXPECT_EQ(nearest_name("integrater", kKnown), "integrator");
    EXPECT_EQ(nearest_name("enviroment", kKnown), "environment");
    EXPECT_EQ(nearest_name("Film", kKnown), "film");
    EXPECT_EQ(nearest_name("sede", kKnown), "seed");
    EXPECT_EQ(nearest_name("film", kKnown), "film");
}

TEST(NearestName, SuggestsNothingFarOff) {
    constexpr std::array<std::string_view, 2> kKnown = {"integrator", "environment"};
    EXPECT_EQ(nearest_name("camera", kKnown), "");
    EXPECT_EQ(nearest_name("", kKnown), "");
    EXPECT_EQ(nearest_name(std::string(100'000, 'x'), kKnown), "") << "and takes no quadratic time";
    EXPECT_EQ(nearest_name("anything", {}), "");
}

TEST(NearestName, LooksAtSoManyNamesOnly) {
    const std::string unlike(60, 'x');
    std::vector<std::string_view> known(100'000, unlike);
    const std::string name(60, 'y');
    known.push_back(name);
    EXPECT_EQ(nearest_name(name, known), "");
    std::vector<std::string_view> others(100'000, "a name of another length");
    others.push_back(name);
    EXPECT_EQ(nearest_name(name, others), name) << "lengths alone cost nothing";
}

TEST(NameHint, ShortensLongNames) {
    const std::string longer(50'000, 'n');
    const std::vector<std::string_view> known(30, longer);
    const std::string hint = name_hint("name", known);
    EXPECT_LT(hint.size(), 2'000u);
    EXPECT_TRUE(hint.starts_with("there are '" + std::string(64, 'n') + "...', '")) << hint;
    EXPECT_TRUE(hint.ends_with(" and 10 more")) << hint;
}

}  // namespace

}  // namespace etendue
