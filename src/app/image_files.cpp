#include "app/image_files.h"

#include "app/peak_memory.h"
#include "app/phase_timer.h"
#include "app/up_to_date.h"
#include "core/log.h"
#include "core/write_file.h"
#include "output/aces_driver.h"
#include "output/exr_driver.h"
#include "output/output_space.h"
#include "output/preview_driver.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace etendue {

namespace {

/// The image, and its layers where they are to be; all in the space that they are written in.
void write_exr(const OutputPaths& paths, const OutputFrame& frame, AovLayout layout, const ColorConfig& colors,
               PixelDepth depth) {
    ExrDriver driver(paths.exr, colors, depth);
    if (!frame.deep.counts.empty()) ExrDriver(layer_path(paths.exr, "deep"), colors, depth).write_deep(frame);
    if (!frame.aces_container && (frame.layers.empty() || layout == AovLayout::Layers)) return driver.write(frame);
    if (layout == AovLayout::Parts) return driver.write_layers_as_parts(frame);
    for (const OutputLayer& layer : frame.layers)
        ExrDriver(layer_path(paths.exr, layer.name), colors, depth).write_layer(frame, layer);
    OutputFrame alone = frame;
    alone.layers.clear();
    if (frame.aces_container)
        AcesDriver(paths.exr, colors).write(alone);
    else
        driver.write(alone);
}

}  // namespace

std::vector<std::string> write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors,
                                           PixelDepth depth, const std::function<void()>& beside) {
    const PhaseTimer timer;
    std::vector<std::string> earlier = listed_layer_files(paths);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(paths.json, ignored)))
        std::filesystem::remove(paths.json, ignored);
    if (image.frame.aces_container && image.frame.layers.empty() && image.frame.deep.counts.empty()) {
        AcesDriver(paths.exr, colors).write(image.frame);
    } else if (is_to_be_converted(image.frame)) {
        // The preview is made of what is in the working space.
        OutputFrame frame = image.frame;
        to_output_space(frame, colors);
        write_exr(paths, frame, image.aov_layout, colors, depth);
    } else {
        write_exr(paths, image.frame, image.aov_layout, colors, depth);
    }
    PreviewDriver(paths.png, colors).write(image.frame);
    if (beside) beside();
    image.statistics.layer_files.clear();
    if (!image.frame.deep.counts.empty())
        image.statistics.layer_files.push_back(layer_path(paths.exr, "deep").filename().string());
    if (image.aov_layout == AovLayout::Files)
        for (const OutputLayer& layer : image.frame.layers)
            image.statistics.layer_files.push_back(layer_path(paths.exr, layer.name).filename().string());
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
