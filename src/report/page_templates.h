// The pages of reports, without their data.
#pragma once

#include <string_view>

namespace etendue {

/// HTML with @REPORT@ and @IMAGES@ where JSON is to stand.
[[nodiscard]] std::string_view comparison_page_template();
[[nodiscard]] std::string_view batch_page_template();
[[nodiscard]] std::string_view profile_page_template();

}  // namespace etendue
