// combine_halves OUT.exr SHARE (LAYER WEIGHTED WITH OTHER)...: the input of 'etendue denoise' from pairs of renders.
//
// Each LAYER takes two EXR files, the first from a share SHARE of the samples of both; "RGB" is the beauty, "N" gets
// channels X, Y, Z.
#include "image/read.h"
#include "image/write.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace etendue;

struct Layer {
    std::string name;
    ImageF a;
    ImageF b;

    [[nodiscard]] std::string channel(std::size_t i) const {
        const std::string letter(1, name == "N" ? "XYZ"[i] : "RGB"[i]);
        return name == "RGB" ? letter : name + "." + letter;
    }
};

void combine(const std::filesystem::path& output, float share, const std::vector<Layer>& layers) {
    const int width = layers.front().a.width;
    const int height = layers.front().a.height;
    ImageF image(width, height, static_cast<int>(6 * layers.size()));
    ImageWriteOptions options{.depth = PixelDepth::Float};
    options.attributes = {{"etendue:halfShare", share}, {"oiio:ColorSpace", std::string("ACEScg")}};
    for (std::size_t i = 0; i < 6 * layers.size(); ++i)
        options.channel_names.push_back((i % 6 < 3 ? "" : "half.") + layers[i / 6].channel(i % 3));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t i = 0; i < 6 * layers.size(); ++i) {
                const float a = layers[i / 6].a.pixel(x, y)[i % 3];
                const float b = layers[i / 6].b.pixel(x, y)[i % 3];
                image.pixel(x, y)[i] = i % 6 < 3 ? share * a + (1.0f - share) * b : a;
            }
    write_image(output, image, options);
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
    if (argc < 6 || argc % 3 != 0) {
        std::fputs("usage: combine_halves OUT.exr SHARE (LAYER A.exr B.exr)...\n", stderr);
        return 2;
    }
    try {
        std::vector<Layer> layers;
        for (std::size_t i = 3; i + 2 < arguments.size(); i += 3)
            layers.push_back({arguments[i], read_image_float(std::filesystem::path(arguments[i + 1])),
                              read_image_float(std::filesystem::path(arguments[i + 2]))});
        combine(arguments[1], std::strtof(arguments[2], nullptr), layers);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "combine_halves: %s\n", error.what());
        return 1;
    }
    return 0;
}
