// Of a program for the processors that ETENDUE_MARCH names.
#include "processor/ray_code_here.h"

#include <array>

namespace etendue {

std::span<const RayCode* const> ray_codes() {
    static constexpr std::array<const RayCode*, 1> kCodes{&ray_code_here};
    return kCodes;
}

}  // namespace etendue
