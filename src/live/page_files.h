// The files of the page that are the same for all that it shows.
#pragma once

#include "live/live_server.h"

#include <string_view>

namespace etendue {

/// Answers with the page at the empty path, with style.css or with script.js.
[[nodiscard]] LiveAnswer page_file(std::string_view path);

}  // namespace etendue
