#include "processor/ray_code.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

namespace etendue {

const RayCode& ray_code() {
    static const RayCode* const chosen = [] {
        std::vector<InstructionSet> available;
        for (const RayCode* const code : ray_codes()) available.push_back(code->instruction_set);
        const char* const asked = std::getenv("ETENDUE_ISA");
        const bool is_set = asked != nullptr && *asked != '\0';  // empty is how shells take a variable back
        const InstructionSet set =
            choose_instruction_set(is_set ? std::optional<std::string_view>(asked) : std::nullopt, available);
        return *std::ranges::find(ray_codes(), set, &RayCode::instruction_set);
    }();
    return *chosen;
}

}  // namespace etendue
