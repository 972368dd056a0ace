#include "core/error.h"

#include <array>
#include <string>

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

}  // namespace

}  // namespace etendue
