// The options of a command line as they were given, to be written down as another one.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// One option with one value; it stands once for each if it has several.
struct GivenOption {
    std::string name;                  ///< "--max-depth"; empty for a positional argument
    std::optional<std::string> value;  ///< none for a flag
};

/// `options` without those of the name `name`.
[[nodiscard]] std::vector<GivenOption> without(std::vector<GivenOption> options, const std::string& name);

/// `common`, but for those that `own` gives anew, and then `own`: each option stands in one of the two places only.
[[nodiscard]] std::vector<GivenOption> merged(std::vector<GivenOption> common, std::span<const GivenOption> own);

/// `command` and after it the options, as a shell reads them.
[[nodiscard]] std::string command_line(const std::string& command, std::span<const GivenOption> options);

}  // namespace etendue
