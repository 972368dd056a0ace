#include "scene/ies_profile_desc.h"

#include <algorithm>

namespace etendue {

float peak_candela(const IesProfileDesc& profile) {
    return profile.candela.empty() ? 0.0f : *std::ranges::max_element(profile.candela);
}

}  // namespace etendue
