#include "farm/farm_leftovers.h"

#include "core/error.h"
#include "picture/description_text.h"
#include "picture/render_setup.h"
#include "session/checkpoint_files.h"

#include <algorithm>
#include <optional>
#include <system_error>

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// Judges which files that are there of an image are of use.
class LeftoverJudge {
  public:
    LeftoverJudge(const FarmImage& image, const fs::path& folder, const WantedImage& wanted)
        : image_(image), folder_(folder), wanted_(wanted) {}

    /// True if a task goes on with the file, or needs not.
    bool is_useful(const fs::path& file, std::vector<SampleRange>& missing) const try {
        const Checkpoint kept = read_checkpoint(file);
        if (file.parent_path() != folder_) return image_.ranges.empty() && is_of_image(kept);
        const auto range = std::ranges::find(image_.ranges, kept.state.first_sample, &SampleRange::begin);
        if (range == image_.ranges.end() || !is_of_part(kept, *range)) return false;
        const bool is_finished =
            file == part_file(folder_, image_.job, *range) && kept.state.next_sample() == range->end;
        if (!is_finished) return true;
        if (description_of(kept, file).statistics.settings_hash != wanted_.settings_hash) return false;
        std::erase(missing, *range);
        return true;
    } catch (const IoError&) {
        return false;  // damaged: as good as none
    } catch (const RefusedCheckpoint&) {
        return false;  // of another format
    }

  private:
    [[nodiscard]] bool is_of_image(const Checkpoint& kept) const {
        const RenderOptions options = make_render_options(wanted_.settings);
        return is_of(kept,
                     expected_image(wanted_.identity, options, options.relative_error > 0.0 || wanted_.has_halves));
    }
    [[nodiscard]] bool is_of_part(const Checkpoint& kept, const SampleRange& range) const {
        const RenderOptions options = make_part_options(wanted_.settings, range);
        return is_of(kept, expected_part(wanted_.identity, options, range.begin, wanted_.has_halves));
    }

    const FarmImage& image_;
    const fs::path& folder_;
    const WantedImage& wanted_;
};

}  // namespace

FarmLeftovers find_leftovers(const FarmImage& image, const fs::path& output,
                             const std::function<WantedImage()>& wanted) {
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
    const WantedImage it = wanted();
    const LeftoverJudge judge(image, folder, it);
    for (const fs::path& file : files)
        if (!judge.is_useful(file, leftovers.missing)) leftovers.useless.push_back(file);
    return leftovers;
}

}  // namespace etendue
