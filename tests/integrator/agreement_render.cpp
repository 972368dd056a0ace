#include "integrator/agreement_render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

namespace etendue::test {

RenderOptions render_options(const AgreementCase& agreement) {
    RenderOptions options;
    options.full_width = kAgreementWidth;
    options.full_height = kAgreementHeight;
    options.window = agreement.window;
    options.spp = agreement.spp;
    options.filter = PixelFilter(FilterShape::Box);
    return options;
}

namespace {

/// Renders `part` of the room once with each seed.
std::vector<ImageF> render_parts(const World& world, const Integrator& integrator, const AgreementCase& agreement,
                                 const AgreementRenders& renders, const ThreadPool& threads, const PixelRect& part) {
    const std::atomic<bool> stop{false};
    RenderOptions options = render_options(agreement);
    options.filter = PixelFilter(renders.filter);
    std::vector<ImageF> images;
    for (std::uint32_t i = 0; i < renders.seeds; ++i) {
        options.seed = renders.first_seed + i;
        const RenderResult result = render(world, integrator, options, threads, stop, {});
        if (result.counters.dropped > 0) throw std::runtime_error("samples were not finite and were dropped");
        const std::vector<float> rgba = result.film.resolve();
        ImageF image(part.width(), part.height(), 3);
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                const int row = y - agreement.window.y0;
                const auto p = static_cast<std::size_t>(row * agreement.window.width() + x - agreement.window.x0);
                std::copy_n(&rgba[4 * p], 3, image.pixel(x - part.x0, y - part.y0).begin());
            }
        images.push_back(std::move(image));
    }
    return images;
}

}  // namespace

ImageEstimate estimate(const World& world, const Integrator& integrator, const AgreementCase& agreement,
                       const AgreementRenders& renders, const ThreadPool& threads, const PixelRect& part) {
    const std::vector<ImageF> images = render_parts(world, integrator, agreement, renders, threads, part);
    ImageEstimate result = estimate_image(images);
    if (renders.filter != FilterShape::Box) (void)widen_for_correlation(result, images, kAgreementBlock);
    return result;
}

ImageEstimate estimate(const World& world, const std::string& integrator, const AgreementCase& agreement,
                       const AgreementRenders& renders, const ThreadPool& threads) {
    const auto images = [&](const MergeSettings& merging) {
        return render_parts(world, *make_integrator(integrator, {.lengths = agreement.lengths, .merging = merging}),
                            agreement, renders, threads, agreement.window);
    };
    const MergeSettings merging;
    std::vector<ImageF> result = images(merging);
    if (integrator == "vcm") {
        MergeSettings half = merging;
        half.radius *= 0.5;
        const std::vector<ImageF> nearer = images(half);
        for (std::size_t i = 0; i < result.size(); ++i)
            for (std::size_t p = 0; p < result[i].pixels.size(); ++p)
                result[i].pixels[p] = (4.0f * nearer[i].pixels[p] - result[i].pixels[p]) / 3.0f;
    }
    return estimate_image(result);
}

double mean_error(const ImageEstimate& image) {
    const auto channels = static_cast<std::size_t>(image.mean.channels);
    double largest = 0.0;
    for (std::size_t channel = 0; channel < channels; ++channel) {
        double sum = 0.0;
        double variance = 0.0;
        for (std::size_t i = channel; i < image.mean.pixels.size(); i += channels) {
            sum += static_cast<double>(image.mean.pixels[i]);
            variance += static_cast<double>(image.variance.pixels[i]);
        }
        if (sum != 0.0) largest = std::max(largest, std::sqrt(variance) / std::abs(sum));
    }
    return largest;
}

}  // namespace etendue::test
