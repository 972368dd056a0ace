#include "cli/profile_accelerators.h"

#include "image/write.h"
#include "metrics/color_map.h"
#include "session/interrupt.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace etendue {

namespace {

std::string visits_stem(std::string_view name) {
    return fmt::format("visits-{}", name);
}

/// Writes the EXR of a map and the PNG of its nodes, and keeps the latter for the page.
void write_visits(const std::filesystem::path& directory, const VisitMap& map, AcceleratorMeasure& measure,
                  ProfileImages& images) {
    ImageF both(map.width, map.height, 2);
    ImageF nodes(map.width, map.height, 1);
    for (std::size_t p = 0; p < map.nodes.size(); ++p) {
        both.pixels[2 * p] = nodes.pixels[p] = map.nodes[p];
        both.pixels[2 * p + 1] = map.triangles[p];
    }
    measure.picture_high = static_cast<double>(std::ranges::max(map.nodes));
    const ImageF picture = paint_magma(nodes, measure.picture_high);
    const std::filesystem::path stem = directory / visits_stem(map.name);
    write_image(stem.string() + ".exr", both, {.depth = PixelDepth::Float, .channel_names = {"nodes", "triangles"}});
    write_image(stem.string() + ".png", picture, {.depth = PixelDepth::UInt8});
    measure.picture = stem.filename().string() + ".exr";
    images[fmt::format("visits/{}", map.name)] = encode_png(picture);
}

}  // namespace

void add_accelerator_options(CLI::App& command, AcceleratorArguments& arguments) {
    auto* accelerators =
        command
            .add_option("--accelerators", arguments.names,
                        "Structures that trace recorded rays, too, separated by commas (docs/accelerators.md)")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->check(CLI::IsMember(accelerator_names()));
    command
        .add_option("--growth", arguments.growth,
                    "Measure the --accelerators over 100 triangles, ten times as many, and so on up to this number")
        ->check(CLI::Range(std::uint64_t{100}, std::uint64_t{10'000'000}))
        ->needs(accelerators);
}

std::vector<std::string> accelerator_pictures(const AcceleratorArguments& arguments) {
    std::vector<std::string> pictures;
    for (const std::string& name : arguments.names)
        for (const char* extension : {".exr", ".png"}) pictures.push_back(visits_stem(name) + extension);
    return pictures;
}

bool measure_and_write_accelerators(const World& world, const AcceleratorArguments& arguments, const RecordedRays& rays,
                                    int width, int height, const std::function<World(SceneDesc)>& compile,
                                    const std::filesystem::path& directory, ProfileReport& report,
                                    ProfileImages& images) {
    const std::vector<AcceleratorKind> kinds = accelerator_kinds(arguments.names);
    if (kinds.empty()) return true;
    AcceleratorRuns runs = measure_accelerators(world, kinds, rays, width, height);
    if (arguments.growth > 0) runs.report.growth = measure_growth(kinds, arguments.growth, compile);
    if (runs.interrupted || interrupt_requested().load()) return false;
    for (const VisitMap& map : runs.visits)
        for (AcceleratorMeasure& measure : runs.report.measures)
            if (measure.name == map.name) write_visits(directory, map, measure, images);
    report.accelerators = std::move(runs.report);
    return true;
}

}  // namespace etendue
