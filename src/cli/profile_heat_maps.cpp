#include "cli/profile_heat_maps.h"

#include "image/write.h"
#include "metrics/color_map.h"
#include "picture/render_setup.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace etendue {

namespace {

std::string heat_map_stem(const std::string& integrator, int threads) {
    return fmt::format("heat-{}-{}", integrator, threads);
}

}  // namespace

std::vector<std::string> heat_map_files(const std::vector<std::string>& integrators, const std::vector<int>& threads) {
    std::vector<std::string> names;
    for (const std::string& integrator : integrators)
        for (const int count : threads)
            for (const char* extension : {".exr", ".png"})
                names.push_back(heat_map_stem(integrator, count) + extension);
    return names;
}

std::vector<std::string> heat_maps_in(const std::filesystem::path& directory) {
    const auto is_number = [](std::string_view text) {
        return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
    };
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(directory, none)) {
        const std::string extension = entry.path().extension().string();
        if (!entry.is_regular_file(none) || (extension != ".exr" && extension != ".png")) continue;
        const std::string stem = entry.path().stem().string();
        const bool is_ours = std::ranges::any_of(integrator_names(), [&](const std::string& integrator) {
            const std::string start = fmt::format("heat-{}-", integrator);
            return stem.starts_with(start) && is_number(std::string_view(stem).substr(start.size()));
        });
        if (is_ours) names.push_back(entry.path().filename().string());
    }
    return names;
}

void write_heat_map(const std::filesystem::path& directory, const PixelRect& window, const CostMap& costs,
                    ProfileReport& report, ProfileImages& images) {
    ImageF both(window.width(), window.height(), 2);
    ImageF seconds(window.width(), window.height(), 1);
    for (std::size_t p = 0; p < costs.rays.size(); ++p) {
        both.pixels[2 * p] = costs.rays[p];
        both.pixels[2 * p + 1] = seconds.pixels[p] = costs.seconds[p];
    }
    // A few pixels that cost far more than all others would leave these black.
    std::vector<float> sorted = costs.seconds;
    const auto high = sorted.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(sorted.size() - 1) * 0.995);
    std::ranges::nth_element(sorted, high);
    const ImageF picture = paint_magma(seconds, static_cast<double>(*high));
    const auto most_threads = std::ranges::max_element(
        report.runs, {}, [&](const ProfileRun& run) { return run.integrator == costs.integrator ? run.threads : 0; });
    const std::filesystem::path stem = directory / heat_map_stem(costs.integrator, most_threads->threads);
    write_image(stem.string() + ".exr", both, {.depth = PixelDepth::Float, .channel_names = {"rays", "cpu_seconds"}});
    write_image(stem.string() + ".png", picture, {.depth = PixelDepth::UInt8});
    most_threads->heat_map = stem.filename().string() + ".exr";
    most_threads->heat_map_high = static_cast<double>(*high);
    images[heat_map_key(*most_threads)] = encode_png(picture);
}

}  // namespace etendue
