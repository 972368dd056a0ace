#include "agreement/failure_images.h"

#include "core/parallel.h"
#include "image/write.h"
#include "integrator/agreement_render.h"
#include "render/strategy_pyramid.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue::test {

namespace {

void write(const std::filesystem::path& path, const ImageF& image) {
    write_image(path, image, {.depth = PixelDepth::Float});
}

/// "area/rough dielectric/flat/pinhole/whole" as the name of a folder.
std::string folder_name(std::string room) {
    std::replace(room.begin(), room.end(), '/', '_');
    std::replace(room.begin(), room.end(), ' ', '-');
    return room;
}

/// What each strategy adds to the image, all in one file: together they are the whole.
void write_pyramid(const std::filesystem::path& path, const AgreementCase& agreement, const World& world) {
    const ThreadPool this_thread(1);
    const std::atomic<bool> stop{false};
    const std::vector<Strategy> strategies =
        strategies_between(agreement.lengths.min_depth, agreement.lengths.max_depth);
    std::vector<ImageF> images;
    std::vector<std::string> names;
    for (StrategyImage& alone : render_strategies(world, {.lengths = agreement.lengths}, strategies,
                                                  render_options(agreement), this_thread, stop, {})) {
        ImageF& image = images.emplace_back(agreement.window.width(), agreement.window.height(), 4);
        image.pixels = std::move(alone.rgba);
        names.push_back(fmt::format("s{}t{}", alone.strategy.s, alone.strategy.t));
    }
    std::vector<ImagePart> parts;
    for (std::size_t i = 0; i < images.size(); ++i) parts.push_back({names[i], &images[i]});
    write_image_parts(path, parts, {.depth = PixelDepth::Float});
}

}  // namespace

void write_failure_images(const std::filesystem::path& directory, const RoomComparison& comparison,
                          const AgreementCase& agreement, const World& world,
                          std::span<const ImageEstimate> estimates) {
    const std::filesystem::path folder = directory / folder_name(agreement.name);
    std::filesystem::create_directories(folder);
    const auto image_of = [&](const std::string& integrator) -> const ImageF& {
        const auto found = std::find(agreement.integrators.begin(), agreement.integrators.end(), integrator);
        return estimates[static_cast<std::size_t>(found - agreement.integrators.begin())].mean;
    };
    bool bdpt_disagrees = false;
    for (const PairComparison& pair : comparison.pairs) {
        if (pair.agreement.agree()) continue;
        write(folder / (pair.a + ".exr"), image_of(pair.a));
        write(folder / (pair.b + ".exr"), image_of(pair.b));
        ImageF difference = image_of(pair.a);
        for (std::size_t i = 0; i < difference.pixels.size(); ++i) difference.pixels[i] -= image_of(pair.b).pixels[i];
        write(folder / (pair.a + "-" + pair.b + ".exr"), difference);
        bdpt_disagrees = bdpt_disagrees || pair.a == "bdpt" || pair.b == "bdpt";
    }
    if (bdpt_disagrees) write_pyramid(folder / "bdpt-strategies.exr", agreement, world);
}

}  // namespace etendue::test
