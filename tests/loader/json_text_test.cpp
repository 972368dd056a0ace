#include "loader/json_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {
namespace {

const SourceLocation kFile{"file.json", ""};

std::string parse_failure(const std::string& text) {
    try {
        static_cast<void>(parse_json(text, kFile));
        return "";
    } catch (const SceneError& error) {
        return error.what();
    }
}

TEST(ParseJson, ParsesJson) {
    EXPECT_EQ(parse_json(R"({"a": [1, 2.5, "x"]})", kFile)["a"][1], 2.5);
}

TEST(ParseJson, SaysWhereTheSyntaxIsBroken) {
    const std::string message = parse_failure("{\n\"a\": }");
    EXPECT_NE(message.find("file.json"), std::string::npos) << message;
    EXPECT_NE(message.find("line 2"), std::string::npos) << message;
}

TEST(ParseJson, RefusesWhatIsNotStrict) {
    for (const char* text : {"", " ", "{", "[1,]", "{'a': 1}", "{\"a\": 1} x", "// c\n{}", "{\"a\": NaN}",
                             "{\"a\": 1e999}", "{\"a\": \"\xff\"}", "{\"a\": \"\xc0\xaf\"}"}) {
        EXPECT_NE(parse_failure(text), "") << text;
    }
}

TEST(ParseJson, RefusesDuplicateKeysInOneObjectOnly) {
    EXPECT_NE(parse_failure(R"({"a": 1, "b": {}, "a": 2})").find("'a' stands twice"), std::string::npos);
    EXPECT_EQ(parse_failure(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})"), "");
}

TEST(ParseJson, LimitsDepthWithoutDeepRecursion) {
    const auto nested = [](int depth) {
        return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
    };
    EXPECT_EQ(parse_failure(nested(kMaxJsonDepth)), "");
    EXPECT_NE(parse_failure(nested(kMaxJsonDepth + 1)).find("nest deeper"), std::string::npos);
    EXPECT_NE(parse_failure(nested(5'000'000)).find("nest deeper"), std::string::npos);
    EXPECT_NE(parse_failure(std::string(5'000'000, '[')).find("nest deeper"), std::string::npos);
}

TEST(ChildPointer, EscapesAsTheRfcSays) {
    EXPECT_EQ(child_pointer("/a", "b/c~d"), "/a/b~1c~0d");
    EXPECT_EQ(child_pointer("", std::size_t{3}), "/3");
}

}  // namespace
}  // namespace etendue
