#include "picture/output_paths.h"

#include "core/error.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

OutputPaths OutputPaths::beside(const std::filesystem::path& exr) {
    OutputPaths paths{exr, exr, exr};
    paths.png.replace_extension(".png");
    paths.json.replace_extension(".json");
    return paths;
}

std::filesystem::path layer_path(const std::filesystem::path& exr, const std::string& name) {
    std::filesystem::path path = exr;
    return path.replace_extension("." + name + ".exr");
}

bool is_partial(const std::filesystem::path& output) {
    return output.extension() == ".partial";
}

void require_writable(const std::filesystem::path& file, std::span<const std::filesystem::path> inputs) {
    const std::filesystem::path parent = file.parent_path();
    const std::filesystem::path directory = parent.empty() ? "." : parent;
    if (!std::filesystem::is_directory(directory))
        throw IoError(fmt::format("cannot write {}: there is no directory {}", file.string(), directory.string()));
    if (std::filesystem::is_directory(file))
        throw IoError(fmt::format("cannot write {}: it is a directory", file.string()));
    if (access(directory.c_str(), W_OK | X_OK) != 0)
        throw IoError(fmt::format("cannot write {}: {} is not writable", file.string(), directory.string()));
    const auto is_file = [&file](const std::filesystem::path& input) {
        std::error_code error;
        return std::filesystem::equivalent(file, input, error);
    };
    if (std::ranges::any_of(inputs, is_file))
        throw IoError(fmt::format("cannot write {}: it is an input, which would be lost; give the output another name",
                                  file.string()));
}

std::filesystem::path written_file(const std::filesystem::path& file) {
    constexpr int kMostLinks = 40;  // as the kernel
    std::filesystem::path target = std::filesystem::absolute(file);
    // Also of a link that leads to nothing: it will, as soon as another name has made what it leads to.
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(target); ++i)
        target = target.parent_path() / std::filesystem::read_symlink(target);
    return std::filesystem::weakly_canonical(target);
}

}  // namespace etendue
