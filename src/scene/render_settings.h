// How a scene is rendered: what render.json says and the command line overrides. Defaults in place.
#pragma once

#include "core/error.h"
#include "core/pixel_rect.h"
#include "core/vec.h"
#include "scene/accelerator_kind.h"
#include "scene/aov_desc.h"
#include "scene/integrator_settings.h"
#include "scene/light_desc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

inline constexpr int kMostLightSamples = 64;
inline constexpr int kMostCachedConnections = 999;
inline constexpr std::string_view kConnectionsForm = "pairwise or cache:N, N from 1 to 999";
/// `IntegratorSettings::cached_connections` in that form; nothing if `text` is not.
[[nodiscard]] std::optional<int> parse_connections(std::string_view text);

inline constexpr std::string_view kStrategyForm = "S,T, the vertices from the light and the eye, or merging";
/// Reads a strategy in that form; nothing if `text` is not.
[[nodiscard]] std::optional<Strategy> parse_strategy(std::string_view text);
/// Returns the form that `parse_strategy` reads.
[[nodiscard]] std::string strategy_text(const Strategy& strategy);

/// Buckets of the median of means: an odd number, so that there is a middle one (and see BucketLayers).
inline constexpr int kLeastBuckets = 3;
inline constexpr int kMostBuckets = 31;
inline constexpr std::string_view kRobustForm = "mean or mon:N, N odd and from 3 to 31";
/// `RenderSettings::robust_buckets` in that form; nothing if `text` is not.
[[nodiscard]] std::optional<int> parse_robust(std::string_view text);

/// Largest number of `RenderSettings::brightest`.
inline constexpr int kMostBrightest = 1024;

/// Says whether a texture that cannot be read is left out with a warning, or is an error.
enum class MissingTextures { Warn, Error };

/// Gives them the names that render.json and the command line have.
inline constexpr std::array<std::pair<std::string_view, MissingTextures>, 2> kMissingTexturesNames{{
    {"warn", MissingTextures::Warn},
    {"error", MissingTextures::Error},
}};

enum class SamplerType { Sobol, Random };
enum class PixelFilterType { BlackmanHarris, Box, Gaussian, Mitchell };

inline constexpr int kMostSide = 65536;  ///< pixels of the width and the height of an image

struct FilmSettings {
    int width = 1024;  ///< pixels, [1, 65536]
    int height = 576;  ///< pixels, [1, 65536]
    /// x0, y0, x1, y1 in pixels, half-open, y down from the top left corner, beyond which they may lie.
    std::optional<std::array<int, 4>> crop;
    PixelFilterType filter = PixelFilterType::BlackmanHarris;
    float filter_radius = 0.0f;  ///< pixels; 0 for the filter's own default
    float overscan = 0.0f;       ///< pixels beyond each edge; below 1, a share of the image's longer side
    float pixel_aspect = 1.0f;   ///< width over height of a pixel, [1/64, 64]

    /// Returns the pixels of the image, and those of its overscan around them.
    [[nodiscard]] PixelRect frame() const {
        const float share = std::ceil(overscan * static_cast<float>(std::max(width, height)));
        const int beyond = static_cast<int>(overscan < 1.0f ? share : overscan);
        return {-beyond, -beyond, width + beyond, height + beyond};
    }
    /// Returns the pixels that are rendered.
    [[nodiscard]] PixelRect window() const {
        return crop ? PixelRect{(*crop)[0], (*crop)[1], (*crop)[2], (*crop)[3]} : frame();
    }
    /// Returns the width of the image over its height, as it is to be shown.
    [[nodiscard]] float aspect() const { return pixel_aspect * static_cast<float>(width) / static_cast<float>(height); }
};

struct ColorSettings {
    std::string working_space;      ///< empty for the config's scene_linear role
    std::string display;            ///< display of the preview image; empty for the config's default
    std::string view;               ///< view of the preview image; empty for the display's default
    std::string look;               ///< look of the preview image, in place of the view's own; empty for the view's
    std::optional<float> exposure;  ///< stops, applied to the preview image only; none for what the image asks for
    std::string output_space;       ///< colour space of the EXR; empty for the working space
    /// The EXR follows SMPTE ST 2065-4: ACES2065-1, which `output_space` is then or is empty.
    bool aces_container = false;
};

/// Frames of a sequence: `first`, `first + step`, … not beyond `last`.
struct FrameRange {
    static constexpr int kMaxFrame = 999'999;  ///< largest number of a frame
    static constexpr double kMost = 100'000;   ///< most frames

    int first = 0;  ///< [-kMaxFrame, kMaxFrame]
    int last = 0;   ///< the same, >= first
    int step = 1;   ///< >= 1

    [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>((last - first) / step) + 1; }
    [[nodiscard]] int frame(std::size_t index) const { return first + static_cast<int>(index) * step; }
};

/// When light reaches the film, seconds from the moment that is shown.
struct Shutter {
    double open = 0.0;
    double close = 0.0;  ///< >= open; equal for a moment without motion blur

    [[nodiscard]] bool is_open() const { return close > open; }
    [[nodiscard]] double middle() const { return 0.5 * (open + close); }
};

/// Holds what files say of an image besides how it was made.
struct MetadataSettings {
    std::string owner;     ///< whose image it is; empty for nobody's
    std::string comments;  ///< any text; empty for none
};

/// Stands in `RenderSettings::animations` for no animation.
inline constexpr std::string_view kNoAnimation = "none";

/// Is the farthest that anything may be from the scene's origin along an axis, metres. Within it, squares of distances
/// between any two places, and rays from outside all of them, stay far within the range of single precision.
inline constexpr double kFarthest = 1e15;

/// Places a camera, in the world that the scene's file describes.
struct CameraPlace {
    Vec3d eye{0.0};
    Vec3d target{0.0, 0.0, -1.0};  ///< point that the camera looks at, elsewhere than `eye`
    Vec3d up{0.0, 1.0, 0.0};       ///< which way is up in the image, not along the view
};

struct RenderSettings {
    IntegratorSettings integrator{.type = std::string(kAutoIntegrator)};
    SamplerType sampler = SamplerType::Sobol;
    int spp = 64;  ///< samples per pixel, [1, 2^24]
    std::uint32_t seed = 0;
    double time_limit = 0.0;  ///< seconds; 0 for none. Rendering stops after the pass that exceeds it.
    /// Holds the error of the image at which rendering stops, after the pass that reaches it; 0 for none.
    double relative_error = 0.0;
    float clamp_indirect = 0.0f;  ///< most of an indirect contribution, in units of the image; 0 for no limit
    int robust_buckets = 0;       ///< buckets of the median of means; 0 for the mean
    int brightest = 8;            ///< how many of the brightest contributions to list, [0, kMostBrightest]
    bool adaptive = true;         ///< with a relative error: pixels get samples as they need them
    int min_spp = 48;             ///< samples that every pixel gets before, [1, 2^24]
    std::string camera;           ///< name of the camera or of its node; empty for the first
    std::optional<CameraPlace> camera_place;  ///< place of that camera, which then stands still, instead of its node's
    std::string scene_name;                   ///< which of the scene file's scenes; empty for the file's default
    std::string variant;  ///< KHR_materials_variants: name of the set of materials; empty for the file's default
    std::optional<double> time_code;   ///< seconds of the animation; of a sequence, where frame 0 is
    std::optional<FrameRange> frames;  ///< a sequence; none for one image
    double fps = 24.0;                 ///< frames per second, > 0
    Shutter shutter;
    std::optional<int> frame;  ///< which frame of the sequence this is
    /// Names the animations that play, or holds `kNoAnimation` alone; empty for all whose targets do not conflict.
    std::vector<std::string> animations;
    LightUnits light_units = LightUnits::Photometric;
    std::optional<std::uint64_t> texture_memory;  ///< bytes for decoded textures; none for half of the machine's memory
    MissingTextures missing_textures = MissingTextures::Warn;
    AcceleratorKind accelerator = AcceleratorKind::Embree;  ///< structure that finds the surfaces that rays meet
    bool cull_backfaces = false;  ///< single-sided surfaces are invisible from behind, but for those of bodies
    std::optional<bool> studio;   ///< the studio is the environment; none for where nothing else emits light
    bool ground = true;           ///< the studio has a ground
    FilmSettings film;
    std::vector<AovDesc> aovs;  ///< layers to write besides the image
    AovLayout aov_layout = AovLayout::Layers;
    MistSettings mist;
    ColorSettings color;
    MetadataSettings metadata;
    SourceLocation location;                     ///< place of render.json
    std::map<std::string, std::string> options;  ///< JSON pointers of what the command line set, and with which option

    /// The moment of the animation that is shown, seconds; none for the scene at rest.
    [[nodiscard]] std::optional<double> shown_time() const {
        return frame ? time_code.value_or(0.0) + *frame / fps : time_code;
    }

    /// Where the setting with this JSON pointer comes from: an option, or render.json.
    [[nodiscard]] SourceLocation at(const std::string& pointer) const {
        const auto option = options.find(pointer);
        return option != options.end() ? SourceLocation{option->second, {}} : SourceLocation{location.file, pointer};
    }
};

}  // namespace etendue
