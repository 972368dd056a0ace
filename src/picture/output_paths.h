// The files that belong to one image.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace etendue {

struct OutputPaths {
    std::filesystem::path exr;
    std::filesystem::path png;  ///< empty if there is none
    std::filesystem::path json;

    [[nodiscard]] static OutputPaths beside(const std::filesystem::path& exr, bool has_png = true);
};

/// Where the layer `name` of the image `exr` is written to if it has a file of its own; that of depths is "deep".
[[nodiscard]] std::filesystem::path layer_path(const std::filesystem::path& exr, const std::string& name);

/// True for the name of a part: it ends in .partial.
[[nodiscard]] bool is_partial(const std::filesystem::path& output);

/// Throws IoError if `file` cannot be written later: better found before hours of rendering than after.
void require_writable(const std::filesystem::path& file);

/// Throws ReplacedInput if one of `outputs` is one of `inputs`, whatever links and spellings lead there. `option` says
/// in the message what asked for the outputs: "--output box.exr".
void require_inputs_kept(std::string_view option, std::span<const std::filesystem::path> outputs,
                         std::span<const std::filesystem::path> inputs);

/// Where `file` will lie once it is written, and with it all that links lead to by then: equal for two names of one
/// file, whether it exists or not.
[[nodiscard]] std::filesystem::path written_file(const std::filesystem::path& file);

}  // namespace etendue
