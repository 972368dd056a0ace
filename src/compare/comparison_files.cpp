#include "compare/comparison_files.h"

#include "core/error.h"
#include "core/write_file.h"
#include "image/read_channels.h"
#include "metrics/error_metrics.h"
#include "output/exr_driver.h"
#include "report/comparison_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

constexpr const char* kDataFile = "data.csv";
constexpr const char* kTablesFile = "tables.tex";
constexpr const char* kPlotsDirectory = "plots";
constexpr const char* kNoiseLayer = "noise";
constexpr const char* kSeedsAttribute = "etendue:pooledSeeds";

std::string plot_path(const std::string& name, const char* extension) {
    return fmt::format("{}/{}.{}", kPlotsDirectory, name, extension);
}

constexpr std::array kPlotFormats{"svg", "pdf"};

std::vector<std::string> plot_paths() {
    std::vector<std::string> metrics;
    metrics.reserve(kErrorMetrics.size());
    for (const ErrorMetric metric : kErrorMetrics) metrics.emplace_back(name_of(metric));
    std::vector<std::string> paths;
    for (const std::string& name : convergence_plot_names(metrics))
        for (const char* format : kPlotFormats) paths.push_back(plot_path(name, format));
    return paths;
}

/// The frame of an image of the report's window, without the image.
OutputFrame frame_of(const ComparisonReport& report) {
    OutputFrame frame;
    if (report.crop) {
        frame.crop_x = report.crop->x0;
        frame.crop_y = report.crop->y0;
        frame.full_width = report.width;
        frame.full_height = report.height;
    }
    frame.working_space = report.working_space;
    frame.scene = report.scene;
    frame.command = report.command;
    return frame;
}

/// Returns what the header says under `name`; empty if that is no text or not there.
std::string text_of(const ChannelImage& image, const char* name) {
    const ImageAttribute* const found = image.find(name);
    const auto* const text = found != nullptr ? std::get_if<std::string>(&found->value) : nullptr;
    return text != nullptr ? *text : "";
}

/// `name` as a part of a file's name: letters, digits and what no shell takes apart.
std::string plain_name(const std::string& name) {
    std::string result;
    for (const char c : name) {
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
        if (is_plain)
            result += c;
        else if (!result.ends_with('_'))
            result += '_';
    }
    return result;
}

/// True if `path` is an image that another comparison has kept: its name is what its header says, or would be in a file
/// that says no command (SOURCE_DATE_EPOCH).
bool is_kept_render(const fs::path& path) {
    ChannelImage image;
    try {
        image = read_channels(path);
    } catch (const IoError&) {
        return false;
    }
    const std::string command = text_of(image, "etendue:command");
    const std::string name = plain_name(text_of(image, "etendue:integrator"));
    const std::string file = path.filename().string();
    return (command.empty() || command.starts_with("etendue compare ")) && !name.empty() && file.starts_with(name) &&
           file.ends_with(fmt::format("-seed{}.exr", text_of(image, "etendue:seed")));
}

/// Returns whether `path` is a reference that a comparison has made.
bool is_own_reference(const fs::path& path) {
    try {
        const ChannelImage image = read_channels(path);
        return !text_of(image, kSeedsAttribute).empty() ||
               text_of(image, "etendue:command").starts_with("etendue compare ");
    } catch (const IoError&) {
        return false;
    }
}

/// Removes what `is_kept_render` finds in `directory`.
void remove_kept_renders(const fs::path& directory) {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(directory))
        if (entry.is_regular_file() && entry.path().filename().string().find("-seed") != std::string::npos &&
            is_kept_render(entry.path()))
            found.push_back(entry.path());
    for (const fs::path& file : found) fs::remove(file);
}

}  // namespace

std::vector<std::string> names_of_data_files() {
    std::vector<std::string> names = plot_paths();
    names.emplace_back(kDataFile);
    names.emplace_back(kTablesFile);
    return names;
}

void write_data_files(const fs::path& directory, const ComparisonReport& report) {
    write_text(directory / kDataFile, to_csv(report));
    write_text(directory / kTablesFile, to_tex(report));
    std::error_code ignored;  // one that stays is only one too many
    for (const std::string& path : plot_paths()) fs::remove(directory / path, ignored);
    const std::vector<NamedPlot> plots = convergence_plots(report);
    for (const NamedPlot& plot : plots) {
        write_text(directory / plot_path(plot.name, "svg"), to_svg(plot.plot));
        write_text(directory / plot_path(plot.name, "pdf"), to_pdf(plot.plot));
    }
    fs::remove(directory / kPlotsDirectory, ignored);  // if it is empty
}

std::string lost_in_pdf(const ComparisonReport& report) {
    std::vector<std::string> names;
    const auto look_at = [&](const std::string& name) {
        if (!has_pdf_text(name)) names.push_back(fmt::format("'{}'", name));
    };
    look_at(report.scene);
    for (const VariantReport& variant : report.variants) look_at(variant.name);
    if (report.metrics.empty() || names.empty()) return "";
    return fmt::format(
        "plots in PDF have question marks for characters of {}: their font has Western European ones "
        "alone, and the plots in SVG have all",
        fmt::join(names, ", "));
}

void write_reference(const fs::path& path, const Reference& reference, const ComparisonReport& report,
                     const ColorConfig& colors) {
    OutputFrame frame = frame_of(report);
    frame.pixels = reference.whole();
    if (const ImageF* const variance = reference.variance()) {
        OutputLayer noise{.name = kNoiseLayer, .channels = "RGB", .is_float = true, .pixels = *variance};
        for (float& value : noise.pixels.pixels) value = std::sqrt(value);
        const SeedRange& seeds = report.reference.seeds;
        noise.attributes.push_back({kSeedsAttribute, fmt::format("{} {}", seeds.first, seeds.count)});
        frame.layers.push_back(std::move(noise));
    }
    ExrDriver(path, colors, PixelDepth::Float).write(frame);
}

bool remove_own_reference(const fs::path& path) {
    std::error_code ignored;  // one that stays is only one too many
    return fs::exists(path, ignored) && is_own_reference(path) && fs::remove(path, ignored);
}

std::optional<ReferenceOrigin> read_reference_origin(const fs::path& path, const PixelRect& window) {
    ChannelImage image;
    try {
        image = read_channels(path);
    } catch (const IoError&) {
        return std::nullopt;
    }
    const std::string seeds = text_of(image, kSeedsAttribute);
    const std::string seed = text_of(image, "etendue:seed");
    if (seeds.empty() && seed.empty()) return std::nullopt;
    ReferenceOrigin origin{.seeds = {.first = 0, .count = 1}, .has_other_renders = !seeds.empty()};
    std::istringstream text(seeds.empty() ? seed : seeds);
    text >> origin.seeds.first;
    if (origin.has_other_renders) text >> origin.seeds.count;
    if (!text) return std::nullopt;
    const PixelRect& data = image.data_window;
    const PixelRect& full = image.display_window;
    const auto channels = static_cast<std::size_t>(image.pixels.channels);
    ImageF variance(window.width(), window.height(), 3);
    for (std::size_t c = 0; c < 3; ++c) {
        if (seeds.empty()) return origin;  // a layer of the user's may have the name, too
        const auto noise = static_cast<std::size_t>(
            std::ranges::find(image.channel_names, fmt::format("{}.{}", kNoiseLayer, "RGB"[c])) -
            image.channel_names.begin());
        if (noise >= channels) return origin;
        for (int y = 0; y < variance.height; ++y)
            for (int x = 0; x < variance.width; ++x) {
                const float error =
                    image.pixels.pixel(x + window.x0 + full.x0 - data.x0, y + window.y0 + full.y0 - data.y0)[noise];
                variance.pixel(x, y)[c] = error * error;
            }
    }
    origin.variance = std::move(variance);
    return origin;
}

std::string render_file_name(const ComparisonReport& report, std::size_t variant, std::uint32_t seed) {
    const std::string name = plain_name(report.variants[variant].name);
    const auto is_like = [&](const VariantReport& other) { return plain_name(other.name) == name; };
    const bool is_one_of_several = std::ranges::count_if(report.variants, is_like) > 1;
    return fmt::format("{}{}-seed{}.exr", name, is_one_of_several ? fmt::format("-{}", variant + 1) : "", seed);
}

void write_renders(const fs::path& directory, const ComparisonReport& report, std::span<const FinishedImages> images,
                   const ColorConfig& colors) {
    fs::create_directories(directory);
    remove_kept_renders(directory);
    for (std::size_t v = 0; v < images.size(); ++v)
        for (std::size_t i = 0; i < images[v].of_seeds.size(); ++i) {
            const VariantReport& variant = report.variants[v];
            OutputFrame frame = frame_of(report);
            frame.pixels = images[v].of_seeds[i];
            frame.spp = static_cast<int>(variant.spp);
            frame.seed = variant.seeds[i];
            frame.integrator = variant.name;
            frame.render_seconds = variant.seconds.values[i];
            ExrDriver(directory / render_file_name(report, v, variant.seeds[i]), colors, PixelDepth::Float)
                .write(frame);
        }
}

}  // namespace etendue
