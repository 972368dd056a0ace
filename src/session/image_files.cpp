#include "session/image_files.h"

#include "core/log.h"
#include "core/write_file.h"
#include "output/preview_driver.h"
#include "picture/exr_files.h"
#include "process/peak_memory.h"
#include "session/checkpoint_files.h"
#include "session/phase_timer.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace etendue {

std::filesystem::path preview_path(const std::filesystem::path& output) {
    std::filesystem::path path = output;
    return path.replace_extension(".preview.png");
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
    write_exr_files(paths.exr, image, colors, depth);
    if (!paths.png.empty()) PreviewDriver(paths.png, colors).write(image.frame);
    if (beside) beside();
    image.statistics.layer_files = layer_file_names(paths.exr, image);
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

}  // namespace etendue
