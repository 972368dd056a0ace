#include "integrator/closed_form.h"

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "image/write.h"
#include "render/whole_image.h"
#include "world/compile.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <system_error>

#include <unistd.h>

namespace etendue::test {

CosineImage::CosineImage(const Vec3f& axis)
    : path_(std::filesystem::temp_directory_path() /
            ("etendue_cosine_environment_" + std::to_string(getpid()) + ".exr")) {
    constexpr int kWidth = 256;
    constexpr int kHeight = 128;
    ImageF image(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y) {
        const float theta = kPi * (static_cast<float>(y) + 0.5f) / kHeight;
        for (int x = 0; x < kWidth; ++x) {
            const float phi = 2.0f * kPi * ((static_cast<float>(x) + 0.5f) / kWidth - 0.5f);
            const Vec3f direction(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            std::ranges::fill(image.pixel(x, y), std::max(0.0f, dot(direction, axis)));
        }
    }
    write_image(path_, image, {.depth = PixelDepth::Float});
}

CosineImage::~CosineImage() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

World closed_form_world(SceneDesc scene, const std::string& working_space) {
    scene.settings.film.width = kImageSide;
    scene.settings.film.height = kImageSide;
    const ProblemList problems = validate(scene);
    if (problems.has_errors()) throw SceneError(problems);
    static const ColorConfig colors = ColorConfig::built_in();
    const ThreadPool threads(1);
    ProblemList warnings;
    return compile_world(std::move(scene), colors, working_space, threads, warnings);
}

std::vector<Rgb> render_pixels(const SceneDesc& scene, const Integrator& integrator, SampleSequence sequence,
                               std::uint32_t spp, std::uint32_t seed, const std::string& working_space,
                               FilterShape filter) {
    return render_pixels(closed_form_world(scene, working_space), integrator, sequence, spp, seed, filter);
}

std::vector<Rgb> render_pixels(const World& world, const Integrator& integrator, SampleSequence sequence,
                               std::uint32_t spp, std::uint32_t seed, FilterShape filter) {
    const ThreadPool threads(1);
    RenderOptions options = whole_image(kImageSide, kImageSide, spp, seed);
    options.sequence = sequence;
    options.filter = PixelFilter(filter);
    const std::atomic<bool> stop{false};
    const RenderResult result = render(world, integrator, options, threads, stop, {});
    if (result.counters.dropped > 0) throw IoError("samples were dropped");

    const std::vector<float> rgba = result.film.resolve();
    std::vector<Rgb> pixels;
    for (std::size_t i = 0; i < rgba.size(); i += 4) pixels.emplace_back(rgba[i], rgba[i + 1], rgba[i + 2]);
    return pixels;
}

}  // namespace etendue::test
