#include "picture/exr_files.h"

#include "output/aces_file.h"
#include "output/exr_driver.h"
#include "output/output_space.h"
#include "picture/output_paths.h"

namespace etendue {

namespace {

/// The image, and its layers where they are to be; all in the space that they are written in.
void write_frame(const std::filesystem::path& exr, const OutputFrame& frame, AovLayout layout,
                 const ColorConfig& colors, PixelDepth depth) {
    ExrDriver driver(exr, colors, depth);
    if (!frame.deep.counts.empty()) ExrDriver(layer_path(exr, "deep"), colors, depth).write_deep(frame);
    if (!frame.aces_container && (frame.layers.empty() || layout == AovLayout::Layers)) return driver.write(frame);
    if (layout == AovLayout::Parts) return driver.write_layers_as_parts(frame);
    for (const OutputLayer& layer : frame.layers)
        ExrDriver(layer_path(exr, layer.name), colors, depth).write_layer(frame, layer);
    OutputFrame alone = frame;
    alone.layers.clear();
    if (frame.aces_container)
        write_aces(exr, alone, colors);
    else
        driver.write(alone);
}

}  // namespace

void write_exr_files(const std::filesystem::path& exr, const ImageDescription& image, const ColorConfig& colors,
                     PixelDepth depth) {
    const OutputFrame& frame = image.frame;
    if (frame.aces_container && frame.layers.empty() && frame.deep.counts.empty()) {
        write_aces(exr, frame, colors);
    } else if (is_to_be_converted(frame)) {
        OutputFrame converted = frame;
        to_output_space(converted, colors);
        write_frame(exr, converted, image.aov_layout, colors, depth);
    } else {
        write_frame(exr, frame, image.aov_layout, colors, depth);
    }
}

std::vector<std::string> layer_file_names(const std::filesystem::path& exr, const ImageDescription& image) {
    std::vector<std::string> names;
    if (!image.frame.deep.counts.empty()) names.push_back(layer_path(exr, "deep").filename().string());
    if (image.aov_layout == AovLayout::Files)
        for (const OutputLayer& layer : image.frame.layers)
            names.push_back(layer_path(exr, layer.name).filename().string());
    return names;
}

}  // namespace etendue
