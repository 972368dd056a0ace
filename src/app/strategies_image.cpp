#include "app/strategies_image.h"

#include "app/interrupt.h"
#include "app/progress_display.h"
#include "core/log.h"
#include "image/scale_down.h"
#include "image/write.h"
#include "output/contact_sheet.h"
#include "output/display_image.h"
#include "output/exr_driver.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr int kThumbnailWidth = 240;  // pixels

std::vector<ImagePart> make_parts(std::span<const StrategyImage> strategies, std::span<const ImageF> images) {
    std::vector<ImagePart> parts;
    for (std::size_t i = 0; i < images.size(); ++i)
        parts.push_back({fmt::format("s{}t{}", strategies[i].strategy.s, strategies[i].strategy.t), &images[i]});
    return parts;
}

/// A row for each length of path.
std::vector<std::vector<LabelledImage>> make_rows(std::span<const StrategyImage> strategies,
                                                  std::span<const ImageF> images, const DisplayView& view,
                                                  const ColorConfig& colors) {
    std::vector<std::vector<LabelledImage>> rows;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const Strategy& strategy = strategies[i].strategy;
        if (i == 0 || strategies[i - 1].strategy.edges() != strategy.edges()) rows.emplace_back();
        rows.back().push_back(
            {strategy_label(strategy), display_image(scale_down(images[i], kThumbnailWidth), view, colors)});
    }
    return rows;
}

}  // namespace

std::string strategy_label(const Strategy& strategy) {
    return fmt::format("({},{})", strategy.s, strategy.t);
}

void write_strategies_image(const StrategiesRequest& request, const World& world, const IntegratorOptions& integrator,
                            const RenderOptions& options, OutputFrame frame, const ColorConfig& colors,
                            PixelDepth depth, const ThreadPool& threads, const std::string& title, bool quiet) {
    const PathLengths& lengths = integrator.lengths;
    const int longest = request.longest > 0 ? std::min(request.longest, lengths.max_depth)
                                            : std::min(StrategiesRequest::kLongest, lengths.max_depth);
    if (longest < lengths.max_depth && !quiet)
        log_warning("note: {} shows the strategies of paths of up to {} edges, of {}; --strategies-depth shows more",
                    request.output.string(), longest, lengths.max_depth);
    IntegratorOptions one = integrator;
    one.weighted = request.weighted;
    ProgressDisplay display(title + " strategies", quiet);
    const std::vector<Strategy> wanted = strategies_between(lengths.min_depth, longest);
    const std::vector<StrategyImage> strategies =
        render_strategies(world, one, wanted, options, threads, interrupt_requested(),
                          [&](const RenderProgress& progress) { display.update(progress); });
    if (strategies.size() < wanted.size()) return;
    std::vector<ImageF> images;
    for (const StrategyImage& strategy : strategies) {
        images.emplace_back(options.window.width(), options.window.height(), 4);
        images.back().pixels = strategy.rgba;
    }
    ExrDriver(request.output, colors, depth).write_parts(frame, make_parts(strategies, images));
    const DisplayView view = with_defaults({frame.working_space, frame.display, frame.view, frame.exposure}, colors);
    ImageWriteOptions png;
    png.depth = PixelDepth::UInt8;
    png.attributes = display_attributes(view);
    write_image(std::filesystem::path(request.output).replace_extension(".png"),
                make_contact_sheet(make_rows(strategies, images, view, colors)), png);
}

}  // namespace etendue
