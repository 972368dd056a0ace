// Parts of a render, added up, are the whole.
#include "render/render.h"
#include "render/render_test_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kImageWidth = 80;
constexpr int kImageHeight = 50;
constexpr std::uint32_t kSpp = 9;

/// The film of samples [begin, end) of `window`, as a part of the whole image.
Film render_part(const World& world, const Integrator& integrator, const PixelRect& window, std::uint32_t begin,
                 std::uint32_t end) {
    RenderOptions options = options_for(kImageWidth, kImageHeight, end - begin);
    options.window = window;
    options.splat_window = {0, 0, kImageWidth, kImageHeight};
    const ThreadPool pool(2);
    const std::atomic<bool> never{false};
    return render(world, integrator, options, pool, never, {}, {}, {.film = make_film(options), .first_sample = begin})
        .film;
}

/// Largest difference between two images, over the value where that is above 1.
double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
        largest = std::max(largest, difference / std::max(1.0, static_cast<double>(std::abs(b[i]))));
    }
    return largest;
}

class Parts : public testing::TestWithParam<std::string> {};

TEST_P(Parts, RangesOfSamplesAddUp) {
    const World world = compile(busy_scene(kImageWidth, kImageHeight));
    const auto integrator = make_integrator(GetParam(), {});
    const PixelRect all{0, 0, kImageWidth, kImageHeight};
    Film sum = render_part(world, *integrator, all, 5, kSpp);
    sum.add(render_part(world, *integrator, all, 0, 3));
    sum.add(render_part(world, *integrator, all, 3, 5));
    const RenderResult whole = render_now(world, GetParam().c_str(), options_for(kImageWidth, kImageHeight, kSpp), 2);
    EXPECT_EQ(sum.sample_count(), whole.film.sample_count());
    EXPECT_LT(largest_difference(sum.resolve(), whole.film.resolve()), 1e-6);
}

TEST_P(Parts, WindowsAddUpWithTheLightThatTheyThrowOnEachOther) {
    const World world = compile(busy_scene(kImageWidth, kImageHeight));
    const auto integrator = make_integrator(GetParam(), {});
    Film sum(kImageWidth, kImageHeight, {0, 0, kImageWidth, kImageHeight});
    for (const PixelRect& window :
         {PixelRect{33, 0, kImageWidth, 21}, PixelRect{0, 0, 33, 21}, PixelRect{0, 21, kImageWidth, 50}})
        sum.add(render_part(world, *integrator, window, 0, kSpp));
    const RenderResult whole = render_now(world, GetParam().c_str(), options_for(kImageWidth, kImageHeight, kSpp), 2);
    EXPECT_LT(largest_difference(sum.resolve(), whole.film.resolve()), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Parts, testing::Values("path", "light", "bdpt", "vcm"),
                         [](const auto& test) { return test.param; });

}  // namespace

}  // namespace etendue::test
