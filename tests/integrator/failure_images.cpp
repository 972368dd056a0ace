#include "integrator/failure_images.h"

#include "core/parallel.h"
#include "image/write.h"
#include "integrator/agreement_render.h"
#include "render/strategy_pyramid.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <vector>

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
    const std::vector<StrategyImage> images =
        render_strategies(world, {.type = "bdpt", .lengths = agreement.lengths},
                          strategies_between(agreement.lengths.min_depth, agreement.lengths.max_depth),
                          render_options(agreement), this_thread, stop, {});
    write_image_parts(path, strategy_parts(images), {.depth = PixelDepth::Float});
}

}  // namespace

std::filesystem::path write_failure_images(const std::filesystem::path& directory, const AgreementCase& agreement,
                                           const World& world, std::span<const Disagreement> pairs) {
    std::filesystem::path folder = directory / folder_name(agreement.name);
    std::filesystem::create_directories(folder);
    bool bdpt_disagrees = false;
    for (const auto& [a, b] : pairs) {
        write(folder / (a.integrator + ".exr"), *a.mean);
        write(folder / (b.integrator + ".exr"), *b.mean);
        ImageF difference = *a.mean;
        for (std::size_t i = 0; i < difference.pixels.size(); ++i) difference.pixels[i] -= b.mean->pixels[i];
        write(folder / (a.integrator + "-" + b.integrator + ".exr"), difference);
        bdpt_disagrees = bdpt_disagrees || a.integrator == "bdpt" || b.integrator == "bdpt";
    }
    if (bdpt_disagrees) write_pyramid(folder / "bdpt-strategies.exr", agreement, world);
    return folder;
}

std::filesystem::path test_output_directory() {
    const char* const set = std::getenv("ETENDUE_TEST_OUTPUT");
    return set != nullptr ? std::filesystem::path(set) : std::filesystem::temp_directory_path() / "etendue-test-output";
}

}  // namespace etendue::test
