#include "session/output_directory.h"

#include "core/error.h"
#include "picture/output_paths.h"

#include <system_error>

#include <fmt/format.h>

namespace etendue {

void make_directory_of(const std::filesystem::path& file) {
    std::error_code ignored;
    if (const std::filesystem::path directory = file.parent_path(); !directory.empty())
        std::filesystem::create_directories(directory, ignored);
}

std::vector<std::filesystem::path> prepare_directory(const std::filesystem::path& directory,
                                                     const std::vector<std::string>& names,
                                                     std::span<const std::filesystem::path> inputs) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (!std::filesystem::is_directory(directory))
        throw IoError(fmt::format("cannot make the directory {}: {}", directory.string(),
                                  error ? error.message() : "there is something else of that name"));
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) {
        files.push_back(directory / name);
        std::filesystem::create_directories(files.back().parent_path(), error);  // what is missing, the next line says
        require_writable(files.back());
    }
    require_inputs_kept("--output", files, inputs);
    return files;
}

}  // namespace etendue
