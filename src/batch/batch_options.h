// What `etendue batch` was asked to do.
#pragma once

#include "session/given_options.h"
#include "session/settings_overrides.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Says which images come first.
enum class BatchOrder {
    Found,     ///< in the order of the directories and of the scenes' names
    Shortest,  ///< by the estimates
    Longest,
    Name,
    Newest,  ///< by the time of the scene's newest file
};

struct BatchOptions {
    std::vector<std::string> roots{};  ///< directories to look for scenes in
    std::filesystem::path output{};    ///< directory of the images
    std::string command{};             ///< the whole command line, as a shell reads it

    SettingsOverrides overrides{};
    std::vector<GivenOption> given{};    ///< options behind `overrides`, as they were given: for other processes
    bool all_variants = false;           ///< an image of each variant of a scene's materials
    bool all_cameras = false;            ///< an image of each camera of a scene
    std::string name_pattern{};          ///< names of the images below `output`; empty for the usual ones
    std::vector<std::string> only{};     ///< globs of the images that are made; empty for all
    std::vector<std::string> exclude{};  ///< globs of images that are left out
    bool only_failed = false;            ///< only images that failed last time
    BatchOrder order = BatchOrder::Found;
    bool denoise = false;  ///< beside each image, one without noise
    int threads = 0;       ///< threads of all renders together; 0: one per processor
    int jobs = 1;          ///< images that are rendered at the same time; 0: as many as suit the threads
    std::optional<std::uint64_t>
        jobs_memory{};   ///< bytes that these may take together; none: what the machine has free
    bool force = false;  ///< images that are up to date are rendered, too

    bool dry_run = false;
    bool no_probe = false;
    bool in_process = false;
    int retries = 1;                               ///< retries of one image, after the first attempt
    double checkpoint_minutes = 5.0;               ///< 0: none
    std::optional<double> keep_sums_after = 60.0;  ///< seconds that a render takes whose sums are kept; none: never
    double stall_minutes = 30.0;                   ///< minutes without a sign of progress, until it is killed; 0: never
    std::optional<std::uint64_t> max_memory{};     ///< bytes that the process of one image may have
    std::string max_memory_text{};                 ///< max_memory as it was given
    std::filesystem::path log{};                   ///< file that gets every line; empty for none
    std::string on_finish{};                       ///< command of a shell that runs at the end; empty for none
    bool quiet = false;
    bool json = false;
};

}  // namespace etendue
