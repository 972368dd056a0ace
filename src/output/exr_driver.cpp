#include "output/exr_driver.h"

#include "core/error.h"
#include "output/output_space.h"
#include "output/software_name.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

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
        const Chromaticities c = config.chromaticities(space);
        attributes.push_back({"chromaticities", std::vector<float>{c.red[0], c.red[1], c.green[0], c.green[1],
                                                                   c.blue[0], c.blue[1], c.white[0], c.white[1]}});
    } catch (const SceneError&) {
        // A config without an interchange space does not say what its primaries are; the image is good all the same.
    }
}

std::vector<ImageAttribute> make_attributes(const OutputFrame& frame, const ColorConfig& config) {
    const std::string space =
        config.resolve_space(frame.output_space.empty() ? frame.working_space : frame.output_space);
    std::vector<ImageAttribute> attributes{
        {"Software", std::string(software_name())},
        {"oiio:ColorSpace", space},
        {"PixelAspectRatio", frame.pixel_aspect},
        {"worldToCamera", exr_world_to_camera(frame.world_to_camera)},
        {"worldToNDC", exr_world_to_ndc(frame.world_to_screen)},
        {"etendue:scene", frame.scene},
        {"etendue:integrator", frame.integrator},
        {"etendue:sampler", frame.sampler},
        {"etendue:spp", frame.spp},
        {"etendue:seed", std::to_string(frame.seed)},  // EXR's integers are signed
        {"etendue:renderTime", static_cast<float>(frame.render_seconds)},
        {"etendue:complete", frame.complete ? 1 : 0},
        {"etendue:haltReason", frame.halt_reason},
    };
    add_chromaticities(config, space, attributes);
    return attributes;
}

}  // namespace

ExrDriver::ExrDriver(std::filesystem::path path, ColorConfig config, PixelDepth depth)
    : path_(std::move(path)), config_(std::move(config)), depth_(depth) {}

void ExrDriver::write(const OutputFrame& frame) {
    if (frame.output_space.empty() || frame.output_space == frame.working_space) {
        write_parts(frame, std::array{ImagePart{{}, &frame.pixels}});
        return;
    }
    const ImageF converted = in_output_space(frame, config_);
    write_parts(frame, std::array{ImagePart{{}, &converted}});
}

void ExrDriver::write_parts(const OutputFrame& frame, std::span<const ImagePart> parts) {
    ImageWriteOptions options;
    options.depth = depth_;
    options.attributes = make_attributes(frame, config_);
    options.offset_x = frame.crop_x;
    options.offset_y = frame.crop_y;
    options.full_width = frame.full_width;
    options.full_height = frame.full_height;
    write_image_parts(path_, parts, options);
}

}  // namespace etendue
