// What the command line can change about a scene, shared by `render` and `batch`.
#pragma once

#include "core/error.h"
#include "loader/loader.h"
#include "output/exr_driver.h"
#include "scene/scene_desc.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace etendue {

enum class Quality {
    Draft,    ///< half the width and height, a sixteenth of the samples
    Preview,  ///< full size, a quarter of the samples
    Final,    ///< as the scene says
};

struct SettingsOverrides {
    std::optional<Quality> quality;
    std::optional<std::string> integrator;
    std::optional<int> spp;
    std::optional<std::array<int, 2>> size;
    std::optional<std::array<int, 4>> crop;
    std::optional<std::string> camera;
    std::optional<std::string> variant;
    LoadOptions moment;
    std::optional<FrameRange> frames;
    std::optional<std::uint32_t> seed;
    std::optional<double> time_seconds;
    std::optional<double> relative_error;
    std::optional<float> clamp_indirect;
    std::optional<int> robust_buckets;
    std::optional<int> brightest;
    std::optional<bool> adaptive;
    std::optional<int> min_spp;
    std::optional<int> max_depth;
    std::optional<int> min_depth;
    std::optional<int> light_samples;
    std::optional<HeuristicType> heuristic;
    std::optional<std::array<int, 2>> strategy;
    std::optional<bool> weighted;
    std::optional<int> cached_connections;
    std::optional<LightUnits> light_units;
    std::optional<std::string> environment;
    std::optional<std::uint64_t> texture_memory;  ///< bytes
    std::vector<AovDesc> aovs;                    ///< besides those of the scene
    std::optional<AovLayout> aov_layout;
    bool deep = false;
    std::optional<float> exposure;
    std::optional<std::string> display;
    std::optional<std::string> view;
    std::optional<std::string> look;
    std::optional<std::string> working_space;
    std::optional<std::string> output_space;
    std::optional<bool> aces_container;
    PixelDepth depth = PixelDepth::Half;

    /// Adds the options to a subcommand; the values arrive when it is parsed.
    void add_options(CLI::App& command);

    /// Applies quality first, then everything that was stated explicitly. Throws SceneError if --float is asked of an
    /// ACES container.
    void apply(SceneDesc& scene) const;

  private:
    void add_firefly_options(CLI::App& command);
    void add_adaptive_options(CLI::App& command);
    void add_color_options(CLI::App& command);
};

/// Adds --time-code, --animation and --shutter to a subcommand; `options` must outlive it.
void add_moment_options(CLI::App& command, LoadOptions& options);

/// Adds --assets DIR, which adds to `assets` before what $ETENDUE_ASSETS lists.
void add_assets_option(CLI::App& command, std::vector<std::filesystem::path>& assets);

/// Adds --missing-textures to a subcommand; `options` must outlive it.
void add_missing_textures_option(CLI::App& command, LoadOptions& options);

/// Of the registry, in its order.
[[nodiscard]] std::vector<std::string> integrator_names();

/// Checks that an option's value is a number from `least` to `most`; NaN, which CLI::Range lets pass, is not.
[[nodiscard]] CLI::Validator real_range(double least, double most);

/// "100,100,200,200" to x0, y0, x1, y1. Throws the error that CLI11 shows for `option` unless 0 <= x0 < x1 and
/// 0 <= y0 < y1.
[[nodiscard]] std::array<int, 4> parse_pixel_window(const std::string& option, const std::string& text);

}  // namespace etendue
