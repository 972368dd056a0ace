#include "integrator/closed_form.h"

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "render/render.h"
#include "world/compile.h"

#include <atomic>

namespace etendue::test {

std::vector<Rgb> render_pixels(const SceneDesc& scene, const Integrator& integrator, SampleSequence sequence,
                               std::uint32_t spp, std::uint32_t seed, const std::string& working_space) {
    SceneDesc sized = scene;
    sized.settings.film.width = kImageSide;
    sized.settings.film.height = kImageSide;
    const ProblemList problems = validate(sized);
    if (problems.has_errors()) throw SceneError(problems);

    const ThreadPool threads(1);
    ProblemList warnings;
    const World world = compile_world(std::move(sized), ColorConfig::built_in(), working_space, threads, warnings);
    RenderOptions options;
    options.full_width = kImageSide;
    options.full_height = kImageSide;
    options.window = {0, 0, kImageSide, kImageSide};
    options.spp = spp;
    options.seed = seed;
    options.sequence = sequence;
    options.filter = PixelFilter(FilterShape::Box);
    const std::atomic<bool> stop{false};
    const RenderResult result = render(world, integrator, options, threads, stop, {});
    if (result.counters.dropped > 0) throw IoError("samples were dropped");

    const std::vector<float> rgba = result.film.resolve();
    std::vector<Rgb> pixels;
    for (std::size_t i = 0; i < rgba.size(); i += 4) pixels.emplace_back(rgba[i], rgba[i + 1], rgba[i + 2]);
    return pixels;
}

}  // namespace etendue::test
