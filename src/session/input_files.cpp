#include "session/input_files.h"

#include "color/color_config.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "picture/output_paths.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

struct Stamp {
    std::uint64_t size = 0;
    std::int64_t modified = 0;  ///< nanoseconds
    friend bool operator==(const Stamp&, const Stamp&) = default;
};

std::int64_t nanoseconds(fs::file_time_type time) {
    const auto since_1970 = std::chrono::file_clock::to_sys(time).time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
}

/// None if there is no such file.
std::optional<Stamp> stamp_of(const fs::path& path) {
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    if (error) return std::nullopt;
    const fs::file_time_type time = fs::last_write_time(path, error);
    if (error) return std::nullopt;
    return Stamp{size, nanoseconds(time)};
}

fs::path canonical_directory(const fs::path& directory) {
    return fs::weakly_canonical(directory.empty() ? "." : directory);
}

}  // namespace

std::string input_name(const fs::path& input, const fs::path& directory) {
    const fs::path whole = fs::weakly_canonical(input);
    const fs::path path = whole.lexically_relative(canonical_directory(directory));
    const bool is_inside = !path.empty() && *path.begin() != "..";
    return (is_inside ? path : whole).generic_string();
}

void require_files_kept(std::string_view option, std::span<const fs::path> outputs, std::vector<fs::path> inputs) {
    for (fs::path& file : ColorConfig::environment_files()) inputs.push_back(std::move(file));
    require_inputs_kept(option, outputs, inputs);
}

std::vector<InputFile> stamp_inputs(const SceneDesc& scene, fs::file_time_type started) {
    std::vector<InputFile> files;
    files.reserve(scene.inputs.size());
    for (const fs::path& input : scene.inputs) {
        const Stamp stamp = stamp_of(input).value_or(Stamp{});
        // A time in the future cannot be that of a change while the file was read.
        const bool is_known =
            stamp.modified < nanoseconds(started) || stamp.modified > nanoseconds(fs::file_time_type::clock::now());
        files.push_back(
            {input_name(input, scene.directory), stamp.size, is_known ? stamp.modified : InputFile::kChanged, {}});
    }
    return files;
}

void hash_inputs(const SceneDesc& scene, std::span<InputFile> files) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        InputFile& file = files[i];
        file.content = hex(hash_file(scene.inputs[i]));
        if (stamp_of(scene.inputs[i]) != Stamp{file.size, file.modified}) file.modified = InputFile::kChanged;
    }
}

std::optional<std::string> what_changed(const InputFile& file, const fs::path& directory) {
    const fs::path path = canonical_directory(directory) / file.path;
    const std::optional<Stamp> now = stamp_of(path);
    if (!now) return fmt::format("input {} is missing", path.filename().string());
    if (file.modified == InputFile::kChanged)
        return fmt::format("input {} changed while the image was made of it", path.filename().string());
    if (*now == Stamp{file.size, file.modified}) return std::nullopt;
    try {
        if (now->size == file.size && hex(hash_file(path)) == file.content) return std::nullopt;
    } catch (const IoError&) {
        // It can be looked at but not read: rendering will say why.
    }
    return fmt::format("input {} has changed", path.filename().string());
}

}  // namespace etendue
