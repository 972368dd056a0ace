// Name and version of this program, for the metadata of what it writes.
#pragma once

#include <string>
#include <string_view>

namespace etendue {

/// "Etendue 1.2.3".
[[nodiscard]] std::string_view software_name();

/// Tells apart what was compiled from other code, or in another way: the first 16 hex digits of the GNU build ID of the
/// program that runs, a hash that its linker made of all of it. "unknown" if it has none. Libraries that are loaded
/// when it starts are no part of it.
[[nodiscard]] std::string software_build();

}  // namespace etendue
