// Name and version of this program, for the metadata of what it writes.
#pragma once

#include <string_view>

namespace etendue {

/// "Etendue 1.2.3".
[[nodiscard]] std::string_view software_name();

}  // namespace etendue
