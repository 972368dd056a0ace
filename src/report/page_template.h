// The page of a comparison, without its data.
#pragma once

#include <string_view>

namespace etendue {

/// HTML with @REPORT@ and @IMAGES@ where JSON is to stand.
[[nodiscard]] std::string_view page_template();

}  // namespace etendue
