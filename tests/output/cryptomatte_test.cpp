#include "output/cryptomatte.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {
namespace {

// The manifests that the specification shows ("Metadata", "Manifest").
TEST(MatteId, IsThatOfTheSpecificationsExamples) {
    EXPECT_EQ(matte_id("bunny"), 0x13851a76u);
    EXPECT_EQ(matte_id("default"), 0x42c9679fu);
    EXPECT_EQ(matte_id("bunny_porcelain_mat"), 0xb24b26d4u);
}

// The values that Psyop's own tests of its decoder expect (github.com/Psyop/Cryptomatte,
// nuke/cryptomatte_utilities_tests.py, CryptoHashing).
TEST(MatteId, IsTheFloatThatPsyopsTestsExpect) {
    const auto value = [](std::string_view name) { return std::bit_cast<float>(matte_id(name)); };
    EXPECT_FLOAT_EQ(value("hello"), 6.0705627102400005616e-17f);
    EXPECT_FLOAT_EQ(value("cube"), -4.08461912519e+15f);
    EXPECT_FLOAT_EQ(value("sphere"), 2.79018604383e+15f);
    EXPECT_FLOAT_EQ(value("plane"), 3.66557617593e-11f);
    EXPECT_FLOAT_EQ(value("\xd1\x80\xd0\xb0\xd0\xb2\xd0\xbd\xd0\xb8\xd0\xbd\xd0\xb0"), -1.3192631212399999468e-25f);
    EXPECT_FLOAT_EQ(value("m\xc3\xa4"
                          "dchen"),
                    6.2361298211599995797e+25f);
}

TEST(MatteId, IsAlwaysANormalNumber) {
    int clamped = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::uint32_t id = matte_id(std::to_string(i));
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(id))) << i;
        const std::uint32_t exponent = (id >> 23) & 0xffu;
        clamped += exponent == 1 || exponent == 254 ? 1 : 0;
    }
    EXPECT_GT(clamped, 200) << "four of 256 exponents are among these";
    // Its hash is 0, of which the exponent becomes 1.
    EXPECT_EQ(matte_id(""), 0x00800000u);
}

TEST(MatteManifest, HasEveryNameWithItsIdInHexadecimalDigits) {
    const std::vector<std::string> names{"default", "bunny", "a \"b\"\\c", "bunny", "m\xc3\xa4"};
    const auto manifest = nlohmann::json::parse(matte_manifest(names));
    ASSERT_EQ(manifest.size(), 4u);
    EXPECT_EQ(manifest.at("bunny"), "13851a76");
    EXPECT_EQ(manifest.at("default"), "42c9679f");
    for (const auto& [name, digits] : manifest.items()) {
        char expected[9];
        std::snprintf(expected, sizeof expected, "%08x", matte_id(name));
        EXPECT_EQ(digits, expected) << name;
    }
    EXPECT_EQ(matte_manifest({}), "{}");
}

// Found by trying numbers one after the other.
TEST(IdNames, AreAListInTheOrderOfTheIds) {
    const std::vector<std::string> names{"b", "a \"quoted\"", "b"};
    EXPECT_EQ(id_names(names), R"(["b","a \"quoted\"","b"])");
    EXPECT_EQ(id_names({}), "[]");
}

TEST(MatteCollisions, AreDifferentNamesWithOneId) {
    std::vector<std::string> names{"a", "b", "a"};
    EXPECT_TRUE(matte_collisions(names).empty());
    std::vector<std::string> many(300'000);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = fmt::format("n{}", i);
    const std::vector<MatteCollision> found = matte_collisions(many);
    ASSERT_FALSE(found.empty()) << "300,000 names make about ten in 32 bits";
    EXPECT_LT(found.size(), 40u);
    for (const MatteCollision& collision : found) {
        EXPECT_NE(collision.first, collision.second);
        EXPECT_EQ(matte_id(collision.first), matte_id(collision.second));
    }
}

TEST(MatteAttributes, AreFoundByTheKeyOfTheLayer) {
    const std::vector<ImageAttribute> attributes = matte_attributes("CryptoObject", R"({"a":"0"})");
    ASSERT_EQ(attributes.size(), 4u);
    // MurmurHash3 of "CryptoObject" is 3ae39a58.
    const auto expect = [&](std::size_t i, const char* name, const char* value) {
        EXPECT_EQ(attributes[i].name, std::string("cryptomatte/3ae39a5/") + name);
        EXPECT_EQ(std::get<std::string>(attributes[i].value), value);
        EXPECT_LE(attributes[i].name.size(), 31u) << "longer names need a newer kind of EXR";
    };
    expect(0, "name", "CryptoObject");
    expect(1, "hash", "MurmurHash3_32");
    expect(2, "conversion", "uint32_to_float32");
    expect(3, "manifest", R"({"a":"0"})");
    EXPECT_EQ(matte_attributes("CryptoObject", "").size(), 3u);
}

TEST(MatteChannel, HoldsTwoRanksToALayer) {
    EXPECT_EQ(matte_channel("CryptoAsset", 0), "CryptoAsset00.R");
    EXPECT_EQ(matte_channel("CryptoAsset", 3), "CryptoAsset00.A");
    EXPECT_EQ(matte_channel("CryptoAsset", 4), "CryptoAsset01.R");
    EXPECT_EQ(matte_channel("CryptoAsset", 42), "CryptoAsset10.B");
}

}  // namespace
}  // namespace etendue
