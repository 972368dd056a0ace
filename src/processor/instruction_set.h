// Which of a processor's instructions what works per ray is compiled for; see docs/processors.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace etendue {

/// Each has all instructions of those before it.
enum class InstructionSet {
    Sse4,    ///< x86-64-v2: four floats at once
    Avx2,    ///< x86-64-v3: eight
    Avx512,  ///< x86-64-v4: sixteen
};

inline constexpr std::array kInstructionSets{InstructionSet::Sse4, InstructionSet::Avx2, InstructionSet::Avx512};

/// "sse4", "avx2" or "avx512".
[[nodiscard]] std::string_view instruction_set_name(InstructionSet set);

/// The last one that the processor and the operating system both have.
[[nodiscard]] InstructionSet largest_instruction_set();

/// The one that the environment variable ETENDUE_ISA asks for, or else the last of `available`, of which there is at
/// least one. Throws std::invalid_argument, with a sentence for the user, if `asked` is no name of a set or of one that
/// is not available.
[[nodiscard]] InstructionSet choose_instruction_set(std::optional<std::string_view> asked,
                                                    std::span<const InstructionSet> available);

}  // namespace etendue
