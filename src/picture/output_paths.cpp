#include "picture/output_paths.h"

#include "core/error.h"
#include "core/write_file.h"

#include <cstdint>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue {

namespace {

/// Device and inode.
using FileId = std::pair<std::uint64_t, std::uint64_t>;

/// None if there is no such file, or if it is a device or a pipe, which writing does not replace.
std::optional<FileId> file_id(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return FileId(status.st_dev, status.st_ino);
}

}  // namespace

OutputPaths OutputPaths::beside(const std::filesystem::path& exr, bool has_png) {
    OutputPaths paths{exr, {}, exr};
    if (has_png) paths.png = std::filesystem::path(exr).replace_extension(".png");
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

void require_writable(const std::filesystem::path& file) {
    const std::filesystem::path parent = written_file(file).parent_path();
    const std::filesystem::path directory = parent.empty() ? "." : parent;
    if (!std::filesystem::is_directory(directory))
        throw IoError(fmt::format("cannot write {}: there is no directory {}", file.string(), directory.string()));
    if (std::filesystem::is_directory(file))
        throw IoError(fmt::format("cannot write {}: it is a directory", file.string()));
    require_no_pipe(file);
    if (access(directory.c_str(), W_OK | X_OK) != 0)
        throw IoError(fmt::format("cannot write {}: {} is not writable", file.string(), directory.string()));
}

void require_inputs_kept(std::string_view option, std::span<const std::filesystem::path> outputs,
                         std::span<const std::filesystem::path> inputs) {
    // One look at each file: a batch has thousands of both.
    std::map<FileId, const std::filesystem::path*> read;
    for (const std::filesystem::path& input : inputs)
        if (const auto id = file_id(input)) read.emplace(*id, &input);
    if (read.empty()) return;
    for (const std::filesystem::path& output : outputs) {
        const auto id = file_id(output);
        const auto input = id ? read.find(*id) : read.end();
        if (input == read.end()) continue;
        const bool is_spelled_alike = std::filesystem::absolute(output).lexically_normal() ==
                                      std::filesystem::absolute(*input->second).lexically_normal();
        const std::string is = is_spelled_alike ? "" : fmt::format(", which is {}", input->second->string());
        throw ReplacedInput(
            fmt::format("{} would replace {}{}: it is an input, which would be lost; give the output "
                        "another name",
                        option, output.string(), is));
    }
}

std::filesystem::path written_file(const std::filesystem::path& file) {
    constexpr int kMostLinks = 40;  // as the kernel
    std::error_code code;
    const auto require = [&](bool known) {
        if (!known) throw IoError(fmt::format("cannot write {}: {}", file.string(), code.message()));
    };
    std::filesystem::path target = std::filesystem::absolute(file, code);
    require(!code);
    // Also of a link that leads to nothing: it will, as soon as another name has made what it leads to.
    for (int i = 0; i < kMostLinks; ++i) {
        const std::filesystem::file_status status = std::filesystem::symlink_status(target, code);
        require(std::filesystem::status_known(status));
        if (!std::filesystem::is_symlink(status)) break;
        const std::filesystem::path next = std::filesystem::read_symlink(target, code);
        require(!code);
        target = target.parent_path() / next;
    }
    target = std::filesystem::weakly_canonical(target, code);
    require(!code);
    return target;
}

}  // namespace etendue
