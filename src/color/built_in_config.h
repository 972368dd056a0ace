// The project's own OpenColorIO config, third_party_config/ocio/config.ocio, as it stood when the program was built.
#pragma once

#include <string_view>

namespace etendue {

[[nodiscard]] std::string_view built_in_config_text();

}  // namespace etendue
