#include "session/image_files.h"

#include "core/content_hash.h"
#include "core/log.h"
#include "core/write_file.h"
#include "image/finite.h"
#include "output/auto_exposure.h"
#include "output/output_space.h"
#include "output/preview_png.h"
#include "picture/exr_files.h"
#include "process/peak_memory.h"
#include "session/checkpoint_files.h"
#include "session/phase_timer.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// Delimits a part of a string: from `begin` up to `end`.
struct TextSpan {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// Finds the number of `frame`, with its sign, in the name of one of its files: the last run of as many digits as
/// `frame_path` writes that has this value, since a take or a size may follow it (shot.0007.v2.json).
std::optional<TextSpan> find_frame_number(const std::string& name, int frame) {
    constexpr std::string_view kDigits = "0123456789";
    constexpr std::size_t kLeastDigits = 4;
    std::size_t last = name.find_last_of(kDigits);
    while (last != std::string::npos) {
        const std::size_t begin = name.find_last_not_of(kDigits, last) + 1;  // 0 if all are digits
        const std::size_t sign = frame < 0 && begin > 0 && name[begin - 1] == '-' ? 1 : 0;
        int number = 0;
        const char* const end = name.data() + last + 1;
        const auto [read_to, problem] = std::from_chars(name.data() + begin - sign, end, number);
        if (last + 1 - begin >= kLeastDigits && problem == std::errc() && read_to == end && number == frame)
            return TextSpan{begin - sign, last + 1};
        last = begin == 0 ? std::string::npos : name.find_last_of(kDigits, begin - 1);
    }
    return std::nullopt;
}

/// Returns the statistics of the frames before number `frame` that lie beside `statistics`, the file that this one will
/// have, by their numbers.
std::map<int, std::filesystem::path> frames_before(const std::filesystem::path& statistics, int frame) {
    std::map<int, std::filesystem::path> before;
    const std::string name = statistics.filename().string();
    const std::optional<TextSpan> place = find_frame_number(name, frame);
    if (!place) return before;
    const std::string before_number = name.substr(0, place->begin);
    const std::string after_number = name.substr(place->end);
    std::error_code code;
    const std::filesystem::path directory = absolute(statistics).parent_path();
    for (std::filesystem::directory_iterator entry(directory, code), end; !code && entry != end;
         entry.increment(code)) {
        const std::string other = entry->path().filename().string();
        if (other.size() <= before_number.size() + after_number.size() || !other.starts_with(before_number) ||
            !other.ends_with(after_number))
            continue;
        int number = 0;
        const char* const last = other.data() + other.size() - after_number.size();
        const auto [read_to, problem] = std::from_chars(other.data() + before_number.size(), last, number);
        if (problem == std::errc() && read_to == last && number < frame) before.emplace(number, entry->path());
    }
    return before;
}

/// Returns the exposure that was chosen for the first of the frames before number `frame` that lie beside
/// `statistics`, the file that this one will have, if they are of `scene`.
std::optional<float> exposure_of_sequence(const std::filesystem::path& statistics, int frame,
                                          const std::string& scene) {
    for (const auto& [number, path] : frames_before(statistics, frame)) {
        std::ifstream file = open_regular_file(path);
        const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
        if (!json.is_object() || !json.contains("exposure") || json.value("scene", nlohmann::json()) != scene) continue;
        const nlohmann::json& exposure = json.at("exposure");
        if (exposure.is_object() && exposure.contains("chosen") && exposure.at("chosen").is_string() &&
            exposure.contains("stops") && exposure.at("stops").is_number())
            return exposure.at("stops").get<float>();
    }
    return std::nullopt;
}

/// Chooses an exposure for a frame that asks for none: of a sequence, that of its first image.
void settle_exposure(const OutputPaths& paths, OutputFrame& frame) {
    if (!frame.exposure && frame.frame) {
        frame.exposure = exposure_of_sequence(paths.json, *frame.frame, frame.scene);
        if (frame.exposure) frame.exposure_reason = "that of the first frame";
    }
    choose_missing_exposure(frame);
}

/// True if `auto` has chosen for the frame of the statistics `json`, and all that this depends on is as in `own`.
bool has_same_choice(const nlohmann::json& json, const nlohmann::json& own) try {
    const auto contents = [](const nlohmann::json& statistics) {
        std::map<std::string, std::string> of_inputs;
        for (const nlohmann::json& input : statistics.at("inputs"))
            of_inputs[input.at("path").get<std::string>()] = input.at("content").get<std::string>();
        return of_inputs;
    };
    const auto settings = [](const nlohmann::json& statistics) {
        nlohmann::json requested = statistics.at("requested_settings");
        requested.erase("/time_code");  // each frame's own
        return requested;
    };
    for (const char* key : {"software", "scene"})
        if (json.at(key) != own.at(key)) return false;
    return settings(json) == settings(own) && json.at("integrator_choice").is_string() &&
           json.at("integrator").is_string() && contents(json) == contents(own);
} catch (const nlohmann::json::exception&) {
    return false;  // of another program
}

/// Returns the bytes of each of the image's files that there are.
std::map<std::string, std::uint64_t> sizes_of_files(const OutputPaths& paths, const std::vector<std::string>& layers) {
    std::map<std::string, std::uint64_t> sizes;
    const auto add = [&](const std::filesystem::path& file) {
        std::error_code error;
        if (const auto bytes = std::filesystem::file_size(file, error); !error) sizes[file.filename().string()] = bytes;
    };
    add(paths.exr);
    if (!paths.png.empty()) add(paths.png);
    for (const std::string& layer : layers) add(paths.exr.parent_path() / layer);
    return sizes;
}

}  // namespace

std::optional<IntegratorChoice> choice_of_sequence(const std::filesystem::path& file,
                                                   const RenderStatistics& statistics) {
    if (!statistics.frame) return std::nullopt;
    const nlohmann::json own = nlohmann::json::parse(to_json(statistics), nullptr, false);
    for (const auto& [number, path] : frames_before(file, *statistics.frame)) {
        std::ifstream in = open_regular_file(path);
        const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
        if (json.is_object() && has_same_choice(json, own)) {
            const auto integrator = json.at("integrator").get<std::string>();
            return IntegratorChoice{integrator, fmt::format("'{}', as in frame {}", integrator, number)};
        }
    }
    return std::nullopt;
}

std::filesystem::path preview_path(const std::filesystem::path& output) {
    std::filesystem::path path = output;
    return path.replace_extension(".preview.png");
}

void remove_preview(const std::filesystem::path& output) {
    std::error_code ignored;
    const std::filesystem::path preview = preview_path(output);
    if (!std::filesystem::exists(OutputPaths::beside(preview).json, ignored)) std::filesystem::remove(preview, ignored);
}

std::vector<std::filesystem::path> files_of_image(const std::filesystem::path& output,
                                                  std::span<const std::string> layers) {
    std::vector<std::filesystem::path> files{output, preview_path(output)};
    for (const std::filesystem::path& checkpoint : CheckpointFiles(output).paths()) files.push_back(checkpoint);
    if (is_partial(output)) return files;
    files.push_back(sums_path(output));
    const OutputPaths paths = OutputPaths::beside(output);
    files.insert(files.end(), {paths.png, paths.json});
    for (const std::string& layer : layers) files.push_back(layer_path(output, layer));
    return files;
}

std::vector<std::string> write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors,
                                           PixelDepth depth, const std::function<void()>& beside) {
    const PhaseTimer timer;
    std::vector<std::string> earlier = listed_layer_files(paths);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(paths.json, ignored)))
        std::filesystem::remove(paths.json, ignored);
    settle_exposure(paths, image.frame);
    image.statistics.exposure = image.frame.exposure;
    image.statistics.exposure_reason = image.frame.exposure_reason;
    write_exr_files(paths.exr, image, colors, depth);
    if (!paths.png.empty()) image.statistics.clipped_share = write_preview_png(paths.png, image.frame, colors);
    if (beside) beside();
    image.statistics.layer_files = layer_file_names(paths.exr, image);
    image.statistics.file_sizes = sizes_of_files(paths, image.statistics.layer_files);
    image.statistics.write = timer.elapsed();
    image.statistics.peak_memory_bytes = peak_memory_bytes();
    write_text(paths.json, to_json(image.statistics));
    std::erase_if(earlier, [&](const std::string& name) {
        return std::ranges::find(image.statistics.layer_files, name) != image.statistics.layer_files.end() ||
               !std::filesystem::exists(paths.exr.parent_path() / name, ignored);
    });
    return earlier;
}

void note_earlier_files(const std::vector<std::string>& names) {
    for (const std::string& name : names)
        log_warning("note: {} is of the image that was replaced, and still there", name);
}

void note_brightest(const OutputPaths& paths, const OutputFrame& frame, const ColorConfig& colors, PixelDepth depth) {
    // The standard of the container allows no other values.
    if (depth != PixelDepth::Half || frame.aces_container) return;
    ImageF converted;
    if (is_to_be_converted(frame)) {
        converted = frame.pixels;
        convert_space(converted, frame.working_space, frame.output_space, colors);
    }
    const ImageF& image = converted.pixels.empty() ? frame.pixels : converted;
    const std::vector<float>& values = image.pixels;
    const auto channels = static_cast<std::size_t>(image.channels);
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.size(); i += channels)
        if (std::max({values[i], values[i + 1], values[i + 2]}) > kLargestHalf) ++count;
    if (count > 0)
        log_warning(
            "note: {}: {} pixels are brighter than {}, the largest of 16-bit floats, and have that value; "
            "--float keeps them as they are",
            paths.exr.string(), count, kLargestHalf);
}

void note_exposure(const OutputPaths& paths, const RenderStatistics& statistics) {
    if (paths.png.empty()) return;
    if (!statistics.exposure_reason.empty())
        log_info("{}: exposure {:+.2f} stops (chosen; --exposure sets it): {}", paths.png.string(),
                 statistics.exposure.value_or(0.0f), statistics.exposure_reason);
    constexpr double kMuch = 0.05;
    if (statistics.clipped_share.value_or(0.0) > kMuch)
        log_warning("note: {}: {:.0f}% of the pixels are as bright as it can show; a lower --exposure shows more",
                    paths.png.string(), 100.0 * *statistics.clipped_share);
}

}  // namespace etendue
