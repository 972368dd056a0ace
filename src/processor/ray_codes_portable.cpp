// Of a program for every processor.
#include "processor/ray_code_here.h"

#include <array>
#include <cstddef>

namespace etendue {

// What cmake/EtendueRayCode.cmake makes of `ray_code_here`.
extern const RayCode avx2_ray_code;
extern const RayCode avx512_ray_code;

std::span<const RayCode* const> ray_codes() {
    static constexpr std::array<const RayCode*, kInstructionSets.size()> kCodes{&ray_code_here, &avx2_ray_code,
                                                                                &avx512_ray_code};
    return std::span(kCodes).first(static_cast<std::size_t>(largest_instruction_set()) + 1);
}

}  // namespace etendue
