#include "app/image_files.h"

#include "app/peak_memory.h"
#include "app/phase_timer.h"
#include "core/write_file.h"
#include "output/exr_driver.h"
#include "output/preview_driver.h"

#include <filesystem>
#include <system_error>

namespace etendue {

namespace {

/// The image, and its layers where they are to be.
void write_exr(const OutputPaths& paths, const ImageDescription& image, const ColorConfig& colors, PixelDepth depth) {
    ExrDriver driver(paths.exr, colors, depth);
    switch (image.aov_layout) {
        case AovLayout::Layers:
            return driver.write(image.frame);
        case AovLayout::Parts:
            return image.frame.layers.empty() ? driver.write(image.frame) : driver.write_layers_as_parts(image.frame);
        case AovLayout::Files:
            break;
    }
    for (const OutputLayer& layer : image.frame.layers) {
        std::filesystem::path path = paths.exr;
        path.replace_extension("." + layer.name + ".exr");
        ExrDriver(path, colors, depth).write_layer(image.frame, layer);
    }
    OutputFrame alone = image.frame;
    alone.layers.clear();
    driver.write(alone);
}

}  // namespace

void write_image_files(const OutputPaths& paths, ImageDescription& image, const ColorConfig& colors, PixelDepth depth,
                       const std::function<void()>& beside) {
    const PhaseTimer timer;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(paths.json, ignored)))
        std::filesystem::remove(paths.json, ignored);
    write_exr(paths, image, colors, depth);
    PreviewDriver(paths.png, colors).write(image.frame);
    if (beside) beside();
    image.statistics.write = timer.elapsed();
    image.statistics.peak_memory_bytes = peak_memory_bytes();
    write_text(paths.json, to_json(image.statistics));
}

}  // namespace etendue
