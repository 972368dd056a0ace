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

ImageEstimate estimate(const World& world, const Integrator& integrator, const AgreementCase& agreement,
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
    ImageEstimate result = estimate_image(images);
    if (renders.filter != FilterShape::Box) (void)widen_for_correlation(result, images, kAgreementBlock);
    return result;
}

ImageEstimate estimate(const World& world, const std::string& integrator, const AgreementCase& agreement,
                       const AgreementRenders& renders, const ThreadPool& threads) {
    return estimate(world, *make_integrator(integrator, {.lengths = agreement.lengths}), agreement, renders, threads,
                    agreement.window);
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
