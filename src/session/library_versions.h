// Versions of the libraries that a picture depends on, for its statistics.
#pragma once

#include <map>
#include <string>

namespace etendue {

[[nodiscard]] std::map<std::string, std::string> library_versions();

}  // namespace etendue
