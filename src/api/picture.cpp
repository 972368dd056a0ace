#include "api/picture_state.h"
#include "api/translate.h"
#include "picture/exr_files.h"
#include "picture/output_paths.h"

#include <utility>

#include <etendue/picture.h>
#include <fmt/format.h>

namespace etendue {

void Picture::State::list_layers() {
    layers.clear();
    for (const OutputLayer& layer : image.frame.layers)
        layers.push_back({layer.name, layer.channels, layer.pixels.pixels});
}

Picture::Picture(std::unique_ptr<State> state) : state_(std::move(state)) {
    state_->list_layers();
}

Picture::~Picture() = default;
Picture::Picture(const Picture& other) : Picture(std::make_unique<State>(*other.state_)) {}
Picture::Picture(Picture&& other) noexcept = default;

Picture& Picture::operator=(Picture other) noexcept {
    std::swap(state_, other.state_);
    return *this;
}

int Picture::width() const {
    return state_->image.frame.pixels.width;
}

int Picture::height() const {
    return state_->image.frame.pixels.height;
}

std::span<const float> Picture::pixels() const {
    return state_->image.frame.pixels.pixels;
}

const std::string& Picture::working_space() const {
    return state_->image.frame.working_space;
}

std::span<const Layer> Picture::layers() const {
    return state_->layers;
}

bool Picture::is_complete() const {
    return state_->image.frame.complete;
}

int Picture::samples_per_pixel() const {
    return state_->image.frame.spp;
}

double Picture::seconds() const {
    return state_->image.frame.render_seconds;
}

std::span<const Message> Picture::messages() const {
    return state_->messages;
}

void Picture::write_exr(const std::filesystem::path& file, Depth depth) const {
    translating({}, [&] {
        const ImageDescription& image = state_->image;
        if (image.frame.aces_container && depth == Depth::Float)
            throw IoError(
                fmt::format("cannot write {}: an ACES container (SMPTE ST 2065-4) holds 16-bit floats", file.string()));
        std::vector<std::filesystem::path> outputs{file};
        for (const std::string& name : layer_file_names(file, image)) outputs.push_back(file.parent_path() / name);
        for (const std::filesystem::path& output : outputs) require_writable(output);
        require_inputs_kept("Picture::write_exr", outputs, state_->inputs);
        write_exr_files(file, image, state_->colors, depth == Depth::Float ? PixelDepth::Float : PixelDepth::Half);
    });
}

}  // namespace etendue
