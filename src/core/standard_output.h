// What commands print on stdout.
#pragma once

#include <string_view>

namespace etendue {

/// Prints text for people, of one or more lines, as `shown_lines` shows it. Throws IoError if not all of it could be
/// written, as to a full disk.
void print_text(std::string_view text);

/// Prints JSON or another text for programs as it is. Throws IoError as well.
void print_data(std::string_view data);

/// Opens those of the standard descriptors that are closed, so that no other file gets their numbers: writing to
/// standard output then fails as it would have.
void keep_standard_descriptors();

}  // namespace etendue
