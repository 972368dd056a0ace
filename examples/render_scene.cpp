// render_scene SCENE OUTPUT.exr: renders a scene with 16 samples per pixel and says how bright it is.
#include <cstddef>
#include <cstdio>
#include <span>
#include <utility>

#include <etendue/etendue.h>

namespace {

void print(std::span<const etendue::Message> messages) {
    for (const etendue::Message& message : messages)
        std::printf("%s: %s\n", message.file.c_str(), message.text.c_str());
}

/// Mean of the green of all pixels.
double brightness(const etendue::Picture& picture) {
    const std::span<const float> rgba = picture.pixels();
    double sum = 0.0;
    for (std::size_t i = 1; i < rgba.size(); i += 4) sum += static_cast<double>(rgba[i]);
    return sum * 4.0 / static_cast<double>(rgba.size());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return std::fputs("Usage: render_scene SCENE OUTPUT.exr\n", stderr), 2;
    try {
        etendue::Scene scene(argv[1], R"({"spp": 16, "aovs": ["depth"]})");
        print(scene.messages());
        const etendue::Picture picture = etendue::render(
            std::move(scene),
            {.progress = [](const etendue::Progress& now) { std::printf("%3.0f%%\n", now.fraction * 100.0); }});
        print(picture.messages());
        for (const etendue::Layer& layer : picture.layers()) std::printf("layer %s\n", layer.name.c_str());
        std::printf("%d x %d pixels, brightness %.4f\n", picture.width(), picture.height(), brightness(picture));
        picture.write_exr(argv[2]);
    } catch (const etendue::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.kind() == etendue::Error::Kind::InvalidScene ? 3 : 1;
    }
    return 0;
}
