#include "app/farm_leftovers.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// The samples in a file, if it is whole and of the render that is wanted.
std::optional<SampleRange> samples_in(const fs::path& file, const RenderIdentity& identity) {
    try {
        const Checkpoint kept = read_checkpoint(file);
        if (!difference(kept.identity, identity).empty()) return std::nullopt;
        return SampleRange{kept.state.first_sample, kept.state.next_sample()};
    } catch (const IoError&) {
        return std::nullopt;  // damaged: as good as none
    }
}

}  // namespace

FarmLeftovers find_leftovers(const FarmImage& image, const fs::path& output,
                             const std::function<RenderIdentity()>& identity) {
    const fs::path folder = parts_folder(output, image.job.output);
    std::vector<fs::path> files;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
        if (entry.is_regular_file(none)) files.push_back(entry.path());
    for (const char* extension : {".checkpoint", ".checkpoint.previous"}) {
        fs::path file = image.job.output;
        if (fs::exists(file.replace_extension(extension), none)) files.push_back(file);
    }

    FarmLeftovers leftovers{image.ranges, {}};
    if (files.empty()) return leftovers;
    const RenderIdentity wanted = identity();
    for (const fs::path& file : files) {
        const std::optional<SampleRange> samples = samples_in(file, wanted);
        const bool is_part = file.parent_path() == folder;
        const auto range = std::ranges::find_if(image.ranges, [&](const SampleRange& r) {
            return samples && samples->begin == r.begin && samples->end <= r.end;
        });
        const bool fits = is_part ? range != image.ranges.end() : samples && image.ranges.empty();
        if (!fits) leftovers.useless.push_back(file);
        if (fits && is_part && file == part_file(folder, image.job, *range) && samples->end == range->end)
            std::erase(leftovers.missing, *range);
    }
    return leftovers;
}

}  // namespace etendue
