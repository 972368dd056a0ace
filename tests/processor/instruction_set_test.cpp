#include "processor/instruction_set.h"

#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::span<const InstructionSet> kAll(kInstructionSets);

std::string refusal(std::string_view asked, std::span<const InstructionSet> available) {
    try {
        static_cast<void>(choose_instruction_set(asked, available));
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(InstructionSet, IsTheLargestUnlessAnotherIsAskedFor) {
    EXPECT_EQ(choose_instruction_set(std::nullopt, kAll), InstructionSet::Avx512);
    EXPECT_EQ(choose_instruction_set(std::nullopt, kAll.first(2)), InstructionSet::Avx2);
    EXPECT_EQ(choose_instruction_set(std::nullopt, kAll.first(1)), InstructionSet::Sse4);
}

TEST(InstructionSet, IsTheOneThatIsAskedFor) {
    for (const InstructionSet set : kInstructionSets)
        EXPECT_EQ(choose_instruction_set(instruction_set_name(set), kAll), set);
    EXPECT_EQ(choose_instruction_set("sse4", kAll.first(1)), InstructionSet::Sse4);
}

TEST(InstructionSet, IsRefusedWhereItIsMissing) {
    EXPECT_EQ(refusal("avx512", kAll.first(2)),
              "the environment variable ETENDUE_ISA asks for 'avx512', which this processor lacks or this program was "
              "built without; there is 'sse4', 'avx2'");
    EXPECT_NE(refusal("avx2", kAll.first(1)), "");
    // A program for one kind of processor has nothing smaller either.
    EXPECT_NE(refusal("sse4", std::array{InstructionSet::Avx512}), "");
}

TEST(InstructionSet, IsRefusedUnderNamesThatAreNone) {
    for (const std::string_view name : {"", "avx", "AVX2", "avx2 ", "avx5120", "native"})
        EXPECT_EQ(refusal(name, kAll), "the environment variable ETENDUE_ISA is '" + std::string(name) +
                                           "'; it can be 'sse4', 'avx2' or 'avx512'");
}

}  // namespace

}  // namespace etendue::test
