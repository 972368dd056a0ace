#include "output/exr_driver.h"

#include "color/primaries.h"
#include "core/error.h"
#include "core/source_date.h"
#include "output/cryptomatte.h"
#include "output/output_space.h"
#include "output/shot_attributes.h"
#include "output/software_name.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

// OpenEXR's camera space is left-handed, +Z forward; ours looks along -Z (openexr.com, "Standard Attributes").
Mat4f exr_world_to_camera(const Mat4f& world_to_camera) {
    return world_to_camera * Mat4f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
}

// OpenEXR's NDC has (0, 0) in the upper left and (1, 1) in the lower right corner of the display window.
Mat4f exr_world_to_ndc(const Mat4f& world_to_screen) {
    return world_to_screen * Mat4f(0.5f, 0, 0, 0, 0, -0.5f, 0, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0, 1);
}

void add_chromaticities(const ColorConfig& config, const std::string& space, std::vector<ImageAttribute>& attributes) {
    try {
        attributes.push_back({"chromaticities", numbers_of(config.chromaticities(space))});
    } catch (const SceneError&) {
        // A config without an interchange space does not say what its primaries are; the image is good all the same.
    }
}

/// Adds those of OpenEXR's standard attributes of cameras and shots that are known.
void add_standard_attributes(const OutputFrame& frame, std::vector<ImageAttribute>& attributes) {
    attributes.push_back({"utcOffset", utc_offset()});
    const auto add_text = [&](const char* name, const std::string& text) {
        if (!text.empty()) attributes.push_back({name, text});
    };
    const auto add_number = [&](const char* name, float number) {
        if (number > 0.0f) attributes.push_back({name, number});
    };
    add_text("owner", frame.owner);
    add_text("comments", frame.comments);
    add_text("cameraLabel", frame.camera);
    add_number("nominalFocalLength", frame.focal_length);
    add_number("aperture", frame.f_number);
    add_number("focus", frame.focus_distance);
    if (!frame.frame) return;
    attributes.push_back({"imageCounter", *frame.frame});
    if (const auto rate = frames_per_second(frame.fps)) attributes.push_back({"framesPerSecond", *rate});
    if (const auto code = time_code(*frame.frame, frame.fps)) attributes.push_back({"timeCode", *code});
}

std::vector<ImageAttribute> make_attributes(const OutputFrame& frame, const ColorConfig& config) {
    const std::string space =
        config.resolve_space(frame.output_space.empty() ? frame.working_space : frame.output_space);
    std::vector<ImageAttribute> attributes{
        {"Software", std::string(software_name())},
        {"oiio:ColorSpace", space},
        {"PixelAspectRatio", frame.pixel_aspect},
        {"worldToCamera", exr_world_to_camera(frame.world_to_camera)},
        {"etendue:scene", frame.scene},
        {"etendue:integrator", frame.integrator},
        {"etendue:sampler", frame.sampler},
        {"etendue:spp", frame.spp},
        {"etendue:seed", std::to_string(frame.seed)},  // EXR's integers are signed
        {"etendue:complete", frame.complete ? 1 : 0},
        {"etendue:haltReason", frame.halt_reason},
    };
    if (frame.world_to_screen) attributes.push_back({"worldToNDC", exr_world_to_ndc(*frame.world_to_screen)});
    if (!frame.settings.empty()) attributes.push_back({"etendue:settings", frame.settings});
    // How long it took is never the same twice, nor need the names of files be: files that are to have the same bytes
    // do not tell.
    if (!source_date()) {
        attributes.push_back({"etendue:renderTime", static_cast<float>(frame.render_seconds)});
        if (!frame.command.empty()) attributes.push_back({"etendue:command", frame.command});
    }
    if (frame.exposure) attributes.push_back({"etendue:exposure", *frame.exposure});
    if (frame.half_share > 0.0f) attributes.push_back({"etendue:halfShare", frame.half_share});
    if (!frame.layers.empty()) {
        // Nothing else is to be denoised, whatever its channels are called.
        std::string names;
        for (const OutputLayer& layer : frame.layers)
            if (layer.is_light && !layer.is_half) names += (names.empty() ? "" : " ") + layer.name;
        attributes.push_back({"etendue:lightLayers", names});
    }
    add_standard_attributes(frame, attributes);
    add_chromaticities(config, space, attributes);
    return attributes;
}

}  // namespace

ExrDriver::ExrDriver(std::filesystem::path path, ColorConfig config, PixelDepth depth)
    : path_(std::move(path)), config_(std::move(config)), depth_(depth) {}

ImagePart ExrDriver::part_of(const OutputLayer& layer, bool with_name) const {
    ImagePart part{.image = &layer.pixels, .attributes = layer.attributes};
    for (const char channel : layer.channels) {
        if (layer.is_matte)
            part.channel_names.push_back(matte_channel(layer.name, part.channel_names.size()));
        else
            part.channel_names.push_back(with_name ? fmt::format("{}.{}", layer.name, channel)
                                                   : std::string(1, channel));
        part.channel_depths.push_back(layer.is_float ? PixelDepth::Float : depth_);
    }
    return part;
}

void ExrDriver::write(const OutputFrame& frame) {
    if (is_to_be_converted(frame)) {
        OutputFrame converted = frame;
        to_output_space(converted, config_);
        return write(converted);
    }
    if (frame.layers.empty()) return write_parts(frame, std::array{ImagePart{.image = &frame.pixels}});
    constexpr std::string_view kColor = "RGBA";
    ImageF all;
    all.width = frame.pixels.width;
    all.height = frame.pixels.height;
    all.channels = frame.pixels.channels;
    ImagePart part{.image = &all};
    for (const char channel : kColor.substr(0, static_cast<std::size_t>(all.channels))) {
        part.channel_names.emplace_back(1, channel);
        part.channel_depths.push_back(depth_);
    }
    for (const OutputLayer& layer : frame.layers) {
        const ImagePart channels = part_of(layer, true);
        part.channel_names.insert(part.channel_names.end(), channels.channel_names.begin(),
                                  channels.channel_names.end());
        part.channel_depths.insert(part.channel_depths.end(), channels.channel_depths.begin(),
                                   channels.channel_depths.end());
        part.attributes.insert(part.attributes.end(), layer.attributes.begin(), layer.attributes.end());
        all.channels += layer.pixels.channels;
    }
    const auto pixels = static_cast<std::size_t>(all.width) * static_cast<std::size_t>(all.height);
    all.pixels.reserve(pixels * static_cast<std::size_t>(all.channels));
    const auto append = [&](const ImageF& image, std::size_t pixel) {
        const auto channels = static_cast<std::ptrdiff_t>(image.channels);
        const auto first = image.pixels.begin() + static_cast<std::ptrdiff_t>(pixel) * channels;
        all.pixels.insert(all.pixels.end(), first, first + channels);
    };
    for (std::size_t p = 0; p < pixels; ++p) {
        append(frame.pixels, p);
        for (const OutputLayer& layer : frame.layers) append(layer.pixels, p);
    }
    write_parts(frame, std::array{part});
}

void ExrDriver::write_layers_as_parts(const OutputFrame& frame) {
    std::vector<ImagePart> parts{{.name = "rgba", .image = &frame.pixels}};
    for (const OutputLayer& layer : frame.layers) {
        parts.push_back(part_of(layer, true));
        parts.back().name = layer.name;
        if (!layer.is_matte) continue;
        // Blender looks for them in the first part alone.
        std::vector<ImageAttribute>& first = parts.front().attributes;
        first.insert(first.end(), layer.attributes.begin(), layer.attributes.end());
    }
    write_parts(frame, parts);
}

void ExrDriver::write_layer(const OutputFrame& frame, const OutputLayer& layer) {
    write_parts(frame, std::array{part_of(layer, false)});
}

void ExrDriver::write_deep(const OutputFrame& frame) {
    const DeepPixels& deep = frame.deep;
    write_deep_image(path_,
                     {.width = frame.pixels.width,
                      .height = frame.pixels.height,
                      .counts = deep.counts,
                      .colors = deep.colors.pixels,
                      .depths = deep.depths},
                     options_of(frame));
}

void ExrDriver::write_parts(const OutputFrame& frame, std::span<const ImagePart> parts) {
    write_image_parts(path_, parts, options_of(frame));
}

ImageWriteOptions ExrDriver::options_of(const OutputFrame& frame) const {
    ImageWriteOptions options;
    options.depth = depth_;
    options.attributes = make_attributes(frame, config_);
    options.offset_x = frame.crop_x;
    options.offset_y = frame.crop_y;
    options.full_width = frame.full_width;
    options.full_height = frame.full_height;
    return options;
}

}  // namespace etendue
