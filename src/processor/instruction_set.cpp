#include "processor/instruction_set.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace etendue {

std::string_view instruction_set_name(InstructionSet set) {
    switch (set) {
        case InstructionSet::Sse4:
            return "sse4";
        case InstructionSet::Avx2:
            return "avx2";
        case InstructionSet::Avx512:
            return "avx512";
    }
    return "";
}

InstructionSet largest_instruction_set() {
    // The others of x86-64-v3 and -v4 (F16C, LZCNT, MOVBE) are in every processor that has these, and Clang 14 knows no
    // way to ask for them. That the operating system keeps the registers is asked here too.
    if (__builtin_cpu_supports("avx2") == 0 || __builtin_cpu_supports("fma") == 0 ||
        __builtin_cpu_supports("bmi") == 0 || __builtin_cpu_supports("bmi2") == 0)
        return InstructionSet::Sse4;
    if (__builtin_cpu_supports("avx512f") == 0 || __builtin_cpu_supports("avx512bw") == 0 ||
        __builtin_cpu_supports("avx512cd") == 0 || __builtin_cpu_supports("avx512dq") == 0 ||
        __builtin_cpu_supports("avx512vl") == 0)
        return InstructionSet::Avx2;
    return InstructionSet::Avx512;
}

InstructionSet choose_instruction_set(std::optional<std::string_view> asked,
                                      std::span<const InstructionSet> available) {
    if (!asked) return available.back();
    const auto* const set = std::ranges::find(kInstructionSets, *asked, instruction_set_name);
    if (set == kInstructionSets.end())
        throw std::invalid_argument(
            fmt::format("the environment variable ETENDUE_ISA is '{}'; it can be 'sse4', 'avx2' or 'avx512'", *asked));
    if (std::ranges::find(available, *set) == available.end()) {
        std::vector<std::string_view> names(available.size());
        std::ranges::transform(available, names.begin(), instruction_set_name);
        throw std::invalid_argument(
            fmt::format("the environment variable ETENDUE_ISA asks for '{}', which this processor lacks or this "
                        "program was built without; there is '{}'",
                        *asked, fmt::join(names, "', '")));
    }
    return *set;
}

}  // namespace etendue
