#include "session/strategies_image.h"

#include "core/byte_size.h"
#include "core/log.h"
#include "image/scale_down.h"
#include "image/write.h"
#include "output/contact_sheet.h"
#include "output/display_image.h"
#include "output/exr_driver.h"
#include "output/output_space.h"
#include "session/interrupt.h"
#include "session/progress_display.h"
#include "session/up_to_date.h"
#include "session/usage_error.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr int kThumbnailWidth = 240;  // pixels

/// Returns the bytes that every pixel of each strategy takes: four floats, kept until all strategies are rendered, and,
/// for encoding at `depth`, about (measured) what the pixel would take in a file without compression.
double bytes_per_pixel(PixelDepth depth) {
    return 16.0 + (depth == PixelDepth::Float ? 16.0 : 8.0);
}

/// Edges of the longest paths that are shown.
int longest_shown(const StrategiesRequest& request, const PathLengths& lengths) {
    return std::min(request.longest > 0 ? request.longest : StrategiesRequest::kLongest, lengths.max_depth);
}

std::vector<Strategy> shown_strategies(const StrategiesRequest& request, const PathLengths& lengths) {
    return strategies_between(lengths.min_depth, longest_shown(request, lengths));
}

void require_other_files(std::span<const std::filesystem::path> image, const OutputPaths& pyramid) {
    for (const std::filesystem::path& of_image : image)
        for (const std::filesystem::path& of_pyramid : {pyramid.exr, pyramid.png})
            if (!of_image.empty() && written_file(of_image) == written_file(of_pyramid))
                throw UsageError(
                    fmt::format("--strategies-image would write {} over {}, which belongs to the image (--output): "
                                "give one of them another name",
                                of_pyramid.string(), of_image.string()));
}

void require_memory(std::size_t strategies, const PixelRect& window, PixelDepth depth) {
    constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
    const double needed = bytes_per_pixel(depth) * static_cast<double>(strategies) * static_cast<double>(window.area());
    const auto available = static_cast<double>(physical_memory());
    if (needed > available)
        throw std::runtime_error(
            fmt::format("--strategies-image: {} strategies of {}x{} pixels take about {:.1f} GiB of memory, and the "
                        "machine has {:.1f}; a smaller --size, --crop or --strategies-depth needs less",
                        strategies, window.width(), window.height(), needed / kGiB, available / kGiB));
}

/// A row for each length of path.
std::vector<std::vector<LabelledImage>> make_rows(std::span<const StrategyImage> images, const DisplayView& view,
                                                  const ColorConfig& colors) {
    std::vector<std::vector<LabelledImage>> rows;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const auto& [strategy, rgba] = images[i];
        if (i == 0 || images[i - 1].strategy.edges() != strategy.edges()) rows.emplace_back();
        rows.back().push_back(
            {strategy_label(strategy), display_image(scale_down(rgba, kThumbnailWidth), view, colors)});
    }
    return rows;
}

}  // namespace

std::string strategy_label(const Strategy& strategy) {
    return strategy == kMerges ? "merges" : fmt::format("({},{})", strategy.s, strategy.t);
}

StrategiesShown strategies_shown(const StrategiesRequest& request, const PathLengths& lengths) {
    return {request.output.filename().string(), longest_shown(request, lengths), request.weighted};
}

bool has_strategies_image(const StrategiesRequest& request, const PathLengths& lengths, const OutputPaths& image) {
    if (request.output.empty()) return true;
    if (listed_strategies_image(image) != strategies_shown(request, lengths)) return false;
    std::error_code pyramid_is_missing;
    std::error_code image_is_missing;
    const auto of_pyramid = std::filesystem::last_write_time(request.output, pyramid_is_missing);
    const auto of_image = std::filesystem::last_write_time(image.exr, image_is_missing);
    return !pyramid_is_missing && !image_is_missing && of_pyramid >= of_image;
}

void check_strategies_request(const StrategiesRequest& request, std::span<const std::filesystem::path> image,
                              const RenderSettings& settings, const RenderOptions& options, PixelDepth depth) {
    require_other_files(image, OutputPaths::beside(request.output));
    const PathLengths& lengths = settings.integrator.lengths;
    const std::size_t count = shown_strategies(request, lengths).size();
    if (count == 0)
        throw UsageError(fmt::format(
            "--strategies-image shows paths of up to {} edges, and with {} of {} none of them is kept: raise "
            "--strategies-depth or lower --min-depth",
            longest_shown(request, lengths), settings.at("/integrator/min_depth").str(), lengths.min_depth));
    require_memory(count, options.window, depth);
}

bool write_strategies_image(const StrategiesRequest& request, const World& world, const IntegratorSettings& integrator,
                            const RenderOptions& options, OutputFrame frame, const ColorConfig& colors,
                            PixelDepth depth, const ThreadPool& threads, const std::string& title, bool quiet) {
    IntegratorSettings one = integrator;
    one.weighted = request.weighted;
    const PathLengths& lengths = one.lengths;
    const int longest = longest_shown(request, lengths);
    if (longest < lengths.max_depth && !quiet)
        log_warning(
            "note: {} shows the strategies of paths of up to {} of {} edges; a larger --strategies-depth shows more",
            request.output.string(), longest, lengths.max_depth);
    ProgressDisplay display(title + " strategies", quiet);
    std::vector<Strategy> wanted = shown_strategies(request, lengths);
    if (find_integrator(one.type)->merges) wanted.push_back(kMerges);
    std::vector<StrategyImage> images =
        render_strategies(world, one, wanted, options, threads, interrupt_requested(),
                          [&](const RenderProgress& progress) { display.update(progress); });
    if (images.size() < wanted.size()) {
        log_warning("note: interrupted before all strategies were rendered: {} is not written",
                    request.output.string());
        return false;
    }
    if (is_to_be_converted(frame)) {
        // In place, since there is no room for another of each.
        for (StrategyImage& image : images) convert_space(image.rgba, frame.working_space, frame.output_space, colors);
        frame.working_space = frame.output_space;
    }
    ExrDriver(request.output, colors, depth).write_parts(frame, strategy_parts(images));
    const DisplayView view = with_defaults(
        {frame.working_space, frame.display, frame.view, frame.look, frame.exposure.value_or(0.0f)}, colors);
    ImageWriteOptions png;
    png.depth = PixelDepth::UInt8;
    png.attributes = display_attributes(view);
    write_image(std::filesystem::path(request.output).replace_extension(".png"),
                make_contact_sheet(make_rows(images, view, colors)), png);
    return true;
}

}  // namespace etendue
