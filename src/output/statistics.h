// What a render cost and did, for the JSON file beside each image.
#pragma once

#include "film/dropped_sample.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct RayCounts {
    std::uint64_t camera = 0;
    std::uint64_t bounce = 0;
    std::uint64_t shadow = 0;
    std::uint64_t light_subpath = 0;
    std::uint64_t connection = 0;
    std::uint64_t light_to_camera = 0;
    std::uint64_t lamp_in_view = 0;
    std::uint64_t lamp_image = 0;

    [[nodiscard]] std::uint64_t total() const {
        return camera + bounce + shadow + light_subpath + connection + light_to_camera + lamp_in_view + lamp_image;
    }
};

/// Seconds that a phase took on the clock, and on all processors together.
struct PhaseTime {
    double wall = 0.0;
    double cpu = 0.0;
};

/// One of the brightest contributions of a render.
struct BrightContribution {
    int x = 0;  ///< pixel of the full image
    int y = 0;
    int sample_x = 0;  ///< pixel whose sample made it
    int sample_y = 0;
    std::uint32_t sample = 0;      ///< index within that pixel
    std::array<float, 3> value{};  ///< in the working space, as a sample of the pixel has it
    bool is_splat = false;         ///< connected to the camera
    std::string path;              ///< as a light path expression; empty if it is not known
    int s = 0;                     ///< vertices from the light
    int t = 0;                     ///< vertices from the eye
    int edges = 0;
};

/// A file that the image depends on.
struct InputFile {
    /// Stands in `modified` for a file that changed while it was read. It is not 0, a time that archives give to files.
    static constexpr std::int64_t kChanged = -1;

    std::string path;                  ///< from the scene's directory, or absolute
    std::uint64_t size = 0;            ///< bytes
    std::int64_t modified = kChanged;  ///< nanoseconds since 1970, UTC
    std::string content;               ///< hash, in hexadecimal digits
};

/// Describes the image of all strategies (--strategies-image) that was written with a render.
struct StrategiesShown {
    std::string file;      ///< its name
    int longest = 0;       ///< edges of the longest paths in it
    bool weighted = true;  ///< by multiple importance sampling

    bool operator==(const StrategiesShown&) const = default;
};

struct RenderStatistics {
    std::string scene;
    std::string integrator;
    std::string integrator_choice;    ///< a sentence that says why it was chosen; empty if it was asked for
    std::string camera;               ///< camera that the image shows; empty if it has no name
    std::optional<int> frame;         ///< number of this frame in its sequence
    std::optional<double> time_code;  ///< seconds of the animation that is shown
    std::string settings_hash;        ///< equal for equal settings
    std::string hash_of_whole;        ///< that of the settings without a crop window; not in JSON
    std::string settings;             ///< all that were rendered with, as a JSON object by JSON pointers
    std::string requested_settings;  ///< settings that are not the default and decide the contents of files, unresolved
    std::string command;             ///< the command line; empty if there was none
    std::vector<InputFile> inputs;
    std::vector<std::string> layer_files;  ///< names of what lies beside the image and belongs to it
    std::optional<StrategiesShown> strategies_image;
    std::map<std::string, std::uint64_t> file_sizes;  ///< bytes of the EXRs and the PNG, by their names
    std::string light_units;  ///< units of lamps: "photometric" (the image is in cd/m²) or "radiometric" (W/(m² sr))
    std::optional<float> exposure;  ///< stops, of the PNG
    std::string exposure_reason;    ///< why it was chosen; empty if it was asked for
    /// Holds the share of the PNG's pixels that are as bright as it can show; none without a PNG.
    std::optional<double> clipped_share;
    int width = 0;  ///< pixels rendered: the crop window's, or the image's
    int height = 0;
    int full_width = 0;  ///< pixels of the whole image
    int full_height = 0;

    RayCounts rays;
    std::uint64_t samples = 0;  ///< in all pixels together
    int spp_requested = 0;
    int spp_done = 0;  ///< that every pixel has
    /// Samples of the pixel that has the fewest, of all on average and of the one that has most, if it is adaptive.
    struct AdaptiveSpp {
        std::uint32_t least = 0;
        double mean = 0.0;
        std::uint32_t most = 0;
    };
    std::optional<AdaptiveSpp> adaptive;
    bool complete = true;
    std::string halt_reason;               ///< why rendering ended
    std::optional<double> relative_error;  ///< estimated; if every other pass was kept for it

    PhaseTime load;   ///< reading the scene
    PhaseTime build;  ///< compiling the world: BVHs, textures, lights
    PhaseTime render;
    PhaseTime write;  ///< the images; this file is written after them

    double seconds_before = 0.0;    ///< part of `render` before this process went on with it, seconds on the clock
    std::uint64_t rays_before = 0;  ///< rays that were traced before it did

    std::uint64_t peak_memory_bytes = 0;  ///< largest memory of the process, bytes
    std::uint64_t bvh_bytes = 0;
    double bvh_build_seconds = 0.0;
    std::uint64_t triangles = 0;  ///< stored ones; a mesh counts once however often it is placed
    std::uint64_t instances = 0;
    std::uint64_t lights = 0;

    std::uint64_t textures = 0;
    std::uint64_t missing_textures = 0;        ///< images that could not be read, which materials do without
    std::vector<std::string> warnings;         ///< warnings of loading and compiling the scene, as they were told
    std::uint64_t texture_bytes = 0;           ///< decoded and held at the end
    bool textures_cached = false;              ///< they are read piece by piece, as they do not fit
    std::uint64_t texture_cache_budget = 0;    ///< bytes
    std::uint64_t failed_texture_lookups = 0;  ///< that met broken pixels in a file

    std::uint64_t dropped_samples = 0;
    std::vector<DroppedSample> first_dropped;  ///< the first few of them

    float clamp_indirect = 0.0f;                 ///< limit of indirect contributions; 0 for none
    std::optional<double> removed_share;         ///< share of all light that this took away, if it is known
    int robust_buckets = 0;                      ///< buckets of the median of means; 0 if the image is the mean
    int robust_filled = 0;                       ///< buckets that have samples in every pixel
    std::optional<double> robust_removed_share;  ///< share of the mean's light that the median lacks
    std::vector<BrightContribution> brightest;   ///< the brightest first

    int threads = 0;
    std::string isa;              ///< instruction set of the ray kernels
    std::string instruction_set;  ///< instruction set of Etendue's own code per ray, as ETENDUE_ISA names it
    std::map<std::string, std::string> libraries;  ///< versions by name
};

/// `statistics` as an indented JSON object that ends in a newline. Adds the rates: rays and samples per second of
/// rendering, 0 where no time was taken. Strings that are not UTF-8 are repaired.
[[nodiscard]] std::string to_json(const RenderStatistics& statistics);

}  // namespace etendue
