#include "output/aces_file.h"

#include "color/primaries.h"
#include "core/error.h"
#include "image/write.h"
#include "output/output_space.h"
#include "output/software_name.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr float kLargestValue = 65504.0f;  // SMPTE ST 2065-1:2021, 4.3.2

std::string comment_of(const OutputFrame& frame) {
    std::string text =
        fmt::format("{}: scene {}, integrator {}, sampler {}, {} samples per pixel, seed {}", software_name(),
                    frame.scene, frame.integrator, frame.sampler, frame.spp, frame.seed);
    if (!frame.complete) text += fmt::format(", incomplete: {}", frame.halt_reason);
    return frame.comments.empty() ? text : fmt::format("{}\n{}", frame.comments, text);
}

std::vector<ImageAttribute> aces_attributes(const OutputFrame& frame) {
    return {{"acesImageContainerFlag", 1},
            {"chromaticities", numbers_of(kAp0)},
            {"PixelAspectRatio", frame.pixel_aspect},
            {"comments", comment_of(frame)}};
}

}  // namespace

void write_aces(const std::filesystem::path& path, const OutputFrame& frame, const ColorConfig& config) {
    const std::string aces = config.aces_space();
    if (aces.empty())
        throw SceneError({path.string(), {}},
                         fmt::format("the OpenColorIO config {} has no ACES2065-1", config.origin()));
    ImageF pixels = frame.pixels;
    convert_space(pixels, frame.working_space, aces, config);
    for (float& value : pixels.pixels)
        value = std::isnan(value) ? 0.0f : std::clamp(value, -kLargestValue, kLargestValue);
    ImageWriteOptions options;
    options.depth = PixelDepth::Half;
    options.compression = ExrCompression::None;
    options.attributes = aces_attributes(frame);
    options.offset_x = frame.crop_x;
    options.offset_y = frame.crop_y;
    options.full_width = frame.full_width;
    options.full_height = frame.full_height;
    write_image(path, pixels, options);
}

}  // namespace etendue
