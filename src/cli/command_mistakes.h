// What is said of a command line that cannot be followed.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace etendue {

/// Says that what was given to `option` is not there: a file if `path` has an extension, else a directory.
[[nodiscard]] std::string missing_in_words(std::string_view option, const std::string& path);

/// Says what is wrong with a command line, where, and what to do about it, after "error: ". `app` has parsed as far as
/// it could.
[[nodiscard]] std::string mistake_in_words(const CLI::App& app, const CLI::ParseError& error);

}  // namespace etendue
