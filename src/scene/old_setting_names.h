// Names that settings had before, which go on working.
#pragma once

#include <array>
#include <string_view>

namespace etendue {

/// Names a setting by the JSON pointer that it had, and by the one that it has now.
struct OldSettingName {
    std::string_view pointer;
    std::string_view now;
};
inline constexpr std::array<OldSettingName, 1> kOldSettingNames{{{"/resolution", "/size"}}};

}  // namespace etendue
