#include "loader/ies/ies_file.h"

#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

const SourceLocation kLamp{"lamp.ies", {}};

IesProfileDesc parse_lamp(const std::string& text) {
    return parse_ies(text, "lamp.ies", kLamp);
}

/// A file of two vertical angles, with one horizontal angle and two values for each entry of `planes`.
std::string file(const std::string& horizontal, int planes, const std::string& candela,
                 const std::string& first_line = "IESNA:LM-63-2002", const std::string& factors = "1 1") {
    return fmt::format("{}\n[TEST] a\n[MANUFAC] b\nTILT=NONE\n1 1000 1 2 {} 1 2 0.1 0.2 0\n{} 50\n0 90\n{}\n{}\n",
                       first_line, planes, factors, horizontal, candela);
}

double degrees(float radians) {
    return static_cast<double>(radians) * 180.0 / std::numbers::pi;
}

/// The intensities at the first vertical angle, by their horizontal angles in degrees.
void expect_planes(const IesProfileDesc& profile, const std::vector<std::pair<double, float>>& expected) {
    ASSERT_EQ(profile.horizontal.size(), expected.size());
    ASSERT_EQ(profile.candela.size(), 2 * expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(degrees(profile.horizontal[i]), expected[i].first, 1e-4);
        EXPECT_EQ(profile.candela[2 * i], expected[i].second) << expected[i].first << " degrees";
    }
}

TEST(IesFile, OnePlaneIsTheSameAllAround) {
    const IesProfileDesc profile = parse_lamp(file("0", 1, "7 3"));
    expect_planes(profile, {{0, 7}, {360, 7}});
    EXPECT_EQ(profile.candela[1], 3.0f);
    ASSERT_EQ(profile.vertical.size(), 2u);
    EXPECT_EQ(profile.vertical[0], 0.0f);
    EXPECT_NEAR(degrees(profile.vertical[1]), 90.0, 1e-4);
    EXPECT_EQ(peak_candela(profile), 7.0f);
    EXPECT_EQ(profile.name, "lamp.ies");
}

TEST(IesFile, QuartersAreMirroredTwice) {
    expect_planes(parse_lamp(file("0 30 90", 3, "1 0 2 0 3 0")),
                  {{0, 1}, {30, 2}, {90, 3}, {150, 2}, {180, 1}, {210, 2}, {270, 3}, {330, 2}, {360, 1}});
}

TEST(IesFile, HalvesAreMirroredOnce) {
    expect_planes(parse_lamp(file("0 45 180", 3, "1 0 2 0 3 0")), {{0, 1}, {45, 2}, {180, 3}, {315, 2}, {360, 1}});
}

// LM-63-1995 lets type C start at 90 degrees.
TEST(IesFile, HalvesFromNinetyDegreesAreMirroredAtTheirPlane) {
    expect_planes(parse_lamp(file("90 100 180 240 270", 5, "1 0 2 0 3 0 4 0 5 0", "IESNA:LM-63-1995")),
                  {{0, 3}, {80, 2}, {90, 1}, {100, 2}, {180, 3}, {240, 4}, {270, 5}, {300, 4}, {360, 3}});
}

TEST(IesFile, FullCirclesAreClosed) {
    expect_planes(parse_lamp(file("0 120 360", 3, "1 0 2 0 3 0")), {{0, 1}, {120, 2}, {360, 3}});
    expect_planes(parse_lamp(file("0 120 240", 3, "1 0 2 0 3 0")), {{0, 1}, {120, 2}, {240, 3}, {360, 1}});
}

TEST(IesFile, FactorsMultiply) {
    // Candela multiplier 1.5, ballast factor 2; the third factor counts until 1995 only.
    const auto peak = [](const std::string& first_line) {
        std::string text = file("0", 1, "10 0", first_line, "2 3");
        text.replace(text.find("1 1000 1 2"), 10, "1 1000 1.5 2");
        return peak_candela(parse_lamp(text));
    };
    EXPECT_EQ(peak("My lamp, 1986"), 90.0f);
    EXPECT_EQ(peak("IESNA91"), 90.0f);
    EXPECT_EQ(peak("IESNA:LM-63-1995"), 90.0f);
    EXPECT_EQ(peak("IESNA:LM-63-2002"), 30.0f);
    EXPECT_EQ(peak("IES:LM-63-2019"), 30.0f);
}

TEST(IesFile, SeparatorsAndLineEndsMayVary) {
    const IesProfileDesc expected = parse_lamp(file("0 90", 2, "1 2 3 4"));
    for (const auto& [from, to] : {std::pair<char, std::string>{'\n', "\r\n"}, {'\n', "\r"}, {' ', ", "}}) {
        std::string text;
        for (const char c : file("0 90", 2, "1 2 3 4")) text += c == from ? to : std::string(1, c);
        EXPECT_EQ(parse_lamp(text).candela, expected.candela) << text;
    }
    EXPECT_EQ(parse_lamp("\xef\xbb\xbf" + file("0 90", 2, "+1 2.0 3e0 4.")).candela, expected.candela);
    EXPECT_EQ(parse_lamp(file("0 90", 2, "1 2 3 4") + "\x1a").candela, expected.candela);
}

TEST(IesFile, TiltDataIsSkipped) {
    std::string text = file("0", 1, "7 3");
    text.replace(text.find("TILT=NONE"), 9, "TILT=INCLUDE\n1\n3\n0 15 30\n1 0.9 0.8");
    EXPECT_EQ(peak_candela(parse_lamp(text)), 7.0f);
    text.replace(text.find("TILT=INCLUDE\n1\n3\n0 15 30\n1 0.9 0.8"), 35, "TILT=/etc/passwd\n");
    EXPECT_EQ(peak_candela(parse_lamp(text)), 7.0f);
}

struct BadFile {
    const char* name;
    std::string text;
    const char* expected;
};

class BadIesFile : public testing::TestWithParam<BadFile> {};

TEST_P(BadIesFile, IsAnErrorWithItsLine) {
    try {
        (void)parse_lamp(GetParam().text);
        FAIL() << "was accepted";
    } catch (const SceneError& error) {
        ASSERT_EQ(error.problems().all().size(), 1u);
        const Problem& problem = error.problems().all().front();
        EXPECT_NE(problem.message.find(GetParam().expected), std::string::npos) << problem.message;
        EXPECT_EQ(problem.where.file, "lamp.ies");
    }
}

std::string changed(const std::string& from, const std::string& to) {
    std::string text = file("0 90", 2, "1 2 3 4");
    return text.replace(text.find(from), from.size(), to);
}

const BadFile kBadFiles[] = {
    {"Empty", "", "line 1: there is no line TILT="},
    {"NoTilt", "IESNA91\n[TEST] x\n", "line 3: there is no line TILT="},
    {"Binary", std::string("\0\x01\xff\n\0", 5), "no line TILT="},
    {"NothingFollows", "IESNA91\nTILT=NONE\n", "ends where the number of lamps"},
    {"TypeB", changed(" 2 2 1 2", " 2 2 2 2"), "line 5: type B photometry is not supported"},
    {"TypeA", changed(" 2 2 1 2", " 2 2 3 2"), "type A photometry is not supported"},
    {"TypeUnknown", changed(" 2 2 1 2", " 2 2 4 2"), "photometric type is 4"},
    {"NoVertical", changed(" 2 2 1 2", " 0 2 1 2"), "number of vertical angles is 0"},
    {"OneVertical", changed(" 2 2 1 2", " 1 2 1 2"), "number of vertical angles is 1"},
    {"NegativeCount", changed(" 2 2 1 2", " 2 -2 1 2"), "number of horizontal angles is -2"},
    {"FractionalCount", changed(" 2 2 1 2", " 2.5 2 1 2"), "must be an integer"},
    {"HugeCount", changed(" 2 2 1 2", " 2 2000000000 1 2"), "number of horizontal angles is 2000000000"},
    {"HugeTable", changed(" 2 2 1 2", " 4096 4096 1 2"), "more than the limit"},
    {"CountBeyondTheFile", changed(" 2 2 1 2", " 4000 200 1 2"), "too short for 4000 numbers"},
    {"Descending", changed("0 90\n0 90", "90 0\n0 90"), "vertical angles do not ascend"},
    {"Repeated", changed("0 90\n0 90", "0 90\n0 0"), "horizontal angles do not ascend"},
    {"BeyondTheZenith", changed("0 90\n0 90", "0 190\n0 90"), "a vertical angle is 190"},
    {"NegativeAngle", changed("0 90\n0 90", "-90 90\n0 90"), "a vertical angle is -90"},
    {"OddRange", changed("0 90\n0 90", "0 90\n0 100"), "go from 0 to 100"},
    {"OddStart", changed("0 90\n0 90", "0 90\n10 90"), "go from 10 to 90"},
    {"NinetyWithoutMiddle", changed("0 90\n0 90", "0 90\n90 270"), "from 90 over 180"},
    {"NegativeCandela", changed("1 2 3 4", "1 -2 3 4"), "line 9: an intensity is -2"},
    {"Text", changed("1 2 3 4", "1 two 3 4"), "must be a number, but is 'two'"},
    {"NotANumber", changed("1 2 3 4", "1 nan 3 4"), "must be a number, but is 'nan'"},
    {"Infinite", changed("1 2 3 4", "1 inf 3 4"), "must be a number"},
    {"BeyondDouble", changed("1 2 3 4", "1 1e999 3 4"), "must be a number"},
    {"BeyondFloat", changed("1 2 3 4", "1 1e300 3 4"), "beyond single precision"},
    {"Short", changed("1 2 3 4", "1 2 3"), "line 10: the file ends where an intensity should stand"},
    {"ControlCharacters", changed("1 2 3 4", "1 \x1b[2J 3 4"), "must be a number, but is '"},
    {"TiltCount", changed("TILT=NONE", "TILT=INCLUDE\n1\n99999"), "number of tilt angles is 99999"},
    {"TiltShort", "IESNA91\nTILT=INCLUDE\n1\n4096\n1", "too short for 8192 numbers"},
};

INSTANTIATE_TEST_SUITE_P(All, BadIesFile, testing::ValuesIn(kBadFiles),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

// Every prefix of a good file must be refused in order, or be complete.
TEST(IesFile, EveryPrefixIsRefusedOrWhole) {
    const std::string text = file("0 30 90", 3, "1 2 3 4 5 6");
    int whole = 0;
    for (std::size_t length = 0; length <= text.size(); ++length) {
        try {
            EXPECT_EQ(parse_lamp(text.substr(0, length)).candela.size(), 18u);
            ++whole;
        } catch (const SceneError&) {
        }
    }
    EXPECT_EQ(whole, 2) << "with the last digit, and with the line end after it";
}

}  // namespace
}  // namespace etendue
