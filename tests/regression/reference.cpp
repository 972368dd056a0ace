#include "regression/reference.h"

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "image/read.h"
#include "image/write.h"
#include "integrator/integrator.h"
#include "loader/loader.h"
#include "render/whole_image.h"
#include "world/compile.h"

#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue::test {

namespace {

/// Far from the seeds that tests use.
constexpr std::uint32_t kReferenceSeed = 1'000'000;
constexpr const char* kWorkingSpace = "ACEScg";

ImageF without_alpha(const Film& film) {
    ImageF image(film.window().width(), film.window().height(), 3);
    const std::vector<float> rgba = film.resolve();
    for (std::size_t pixel = 0; pixel < rgba.size() / 4; ++pixel)
        for (std::size_t channel = 0; channel < 3; ++channel)
            image.pixels[3 * pixel + channel] = rgba[4 * pixel + channel];
    return image;
}

}  // namespace

ImageEstimate render_estimate(const RegressionScene& scene, const Sampling& sampling, SampleSequence sequence,
                              std::uint32_t first_seed) {
    SceneDesc desc = load_scene(std::filesystem::path(scene.parent) / scene.name).scene;
    desc.settings.film.width = scene.width;
    desc.settings.film.height = scene.height;
    const auto integrator = make_integrator(sampling.integrator, {.lengths = desc.settings.integrator.lengths});
    if (!integrator) throw IoError(fmt::format("no integrator is named '{}'", sampling.integrator));

    const ThreadPool threads;
    ProblemList warnings;
    const World world = compile_world(std::move(desc), ColorConfig::built_in(), kWorkingSpace, threads, warnings);
    RenderOptions options = whole_image(scene.width, scene.height, static_cast<std::uint32_t>(sampling.spp));
    options.sequence = sequence;
    const std::atomic<bool> stop{false};
    std::vector<ImageF> renders;
    for (int i = 0; i < sampling.renders; ++i) {
        options.seed = first_seed + static_cast<std::uint32_t>(i);
        const RenderResult result = render(world, *integrator, options, threads, stop, {});
        if (result.counters.dropped > 0)
            throw IoError(fmt::format("{} samples were not finite and were dropped", result.counters.dropped));
        renders.push_back(without_alpha(result.film));
    }
    return estimate_image(renders);
}

ReferenceFiles ReferenceFiles::of(const RegressionScene& scene) {
    const std::filesystem::path directory = ETENDUE_REFERENCES;
    return {directory / fmt::format("{}.exr", scene.name), directory / fmt::format("{}.variance.exr", scene.name)};
}

ImageEstimate read_reference(const RegressionScene& scene) {
    const ReferenceFiles files = ReferenceFiles::of(scene);
    return {read_image_float(files.mean), read_image_float(files.variance)};
}

void update_reference(const RegressionScene& scene) {
    const Sampling& sampling = scene.reference;
    const ImageEstimate estimate = render_estimate(scene, sampling, SampleSequence::Random, kReferenceSeed);
    const std::string made = fmt::format(
        "mean of {} renders with {} samples a pixel each, integrator {}, random sampler, seeds {} to {}, in {}",
        sampling.renders, sampling.spp, sampling.integrator, kReferenceSeed,
        kReferenceSeed + static_cast<std::uint32_t>(sampling.renders) - 1, kWorkingSpace);
    const auto write = [](const std::filesystem::path& path, const ImageF& image, const std::string& comment) {
        write_image(path, image,
                    {.depth = PixelDepth::Float,
                     .attributes = {{"oiio:ColorSpace", kWorkingSpace}, {"ImageDescription", comment}}});
    };
    const ReferenceFiles files = ReferenceFiles::of(scene);
    std::filesystem::create_directories(files.mean.parent_path());
    write(files.mean, estimate.mean, made);
    write(files.variance, estimate.variance, "variance of the " + made);
}

}  // namespace etendue::test
