#include "app/checkpoint_files.h"

#include "core/error.h"
#include "core/log.h"
#include "core/write_file.h"

#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

std::string text_of(const PixelRect& rect) {
    return fmt::format("{},{},{},{}", rect.x0, rect.y0, rect.x1, rect.y1);
}

/// `identity` and what else a render cannot go on with if it is different.
RenderIdentity with_sampling(RenderIdentity identity, const PixelRect& window, const PixelRect& splat_window,
                             std::uint32_t first_sample) {
    identity["pixels"] = text_of(window);
    identity["pixels that have light paths"] = text_of(splat_window);
    identity["first sample"] = fmt::format("{}", first_sample);
    return identity;
}

std::string difference_from(const Checkpoint& kept, const CheckpointFiles::Expected& expected) {
    const Film& film = kept.state.film;
    RenderIdentity is = with_sampling(kept.identity, film.window(), film.splat_window(), kept.state.first_sample);
    RenderIdentity wanted =
        with_sampling(expected.identity, expected.window, expected.splat_window, expected.first_sample);
    if (expected.every_other_pass) {
        wanted["what --error needs"] = "kept";
        is["what --error needs"] = kept.state.every_other_pass ? "kept" : "not kept";
    }
    return difference(is, wanted);
}

/// The state, without what is not needed.
RenderState take_state(Checkpoint&& kept, const CheckpointFiles::Expected& expected) {
    if (!expected.every_other_pass) {
        kept.state.every_other_pass.reset();
        kept.state.every_other_spp = 0;
    }
    return std::move(kept.state);
}

}  // namespace

CheckpointFiles::CheckpointFiles(const std::filesystem::path& exr) : newest_(exr), previous_(exr) {
    newest_.replace_extension(".checkpoint");
    previous_.replace_extension(".checkpoint.previous");
}

void CheckpointFiles::write(const RenderIdentity& identity, const std::string& description,
                            const RenderState& state) const {
    // A second name for the newest file, which then is replaced as a whole.
    std::error_code error;
    if (std::filesystem::exists(newest_, error)) {
        std::filesystem::remove(previous_, error);
        std::filesystem::create_hard_link(newest_, previous_, error);
        // Where there are no links, the newest is renamed: the previous one is then the only one for a moment.
        if (error) std::filesystem::rename(newest_, previous_);
    }
    write_checkpoint(newest_, identity, description, state);
}

std::optional<RenderState> CheckpointFiles::read(const Expected& expected, bool quiet) const {
    std::optional<DamagedCheckpoint> damage;
    for (const std::filesystem::path& path : {newest_, previous_}) {
        std::error_code error;
        if (!std::filesystem::exists(path, error)) continue;
        try {
            Checkpoint kept = read_checkpoint(path);
            if (const std::string differences = difference_from(kept, expected); !differences.empty())
                throw SceneError({path.string(), {}},
                                 fmt::format("the checkpoint is of another render; start anew without --resume, or "
                                             "mend what differs:\n{}",
                                             differences));
            // Else the damaged one would become the previous one, in place of this.
            if (damage) std::filesystem::rename(path, newest_);
            return take_state(std::move(kept), expected);
        } catch (const DamagedCheckpoint& broken) {
            if (!quiet) log_warning("warning: {}", broken.what());
            damage = broken;
        }
    }
    if (damage)
        throw SceneError({newest_.string(), {}},
                         fmt::format("{}; no other checkpoint is left: start anew without --resume", damage->what()));
    return std::nullopt;
}

bool CheckpointFiles::exist() const {
    std::error_code error;
    return std::filesystem::exists(newest_, error) || std::filesystem::exists(previous_, error);
}

void CheckpointFiles::remove() const {
    std::error_code ignored;
    std::filesystem::remove(newest_, ignored);
    std::filesystem::remove(previous_, ignored);
    // A render that was killed while it wrote one and was gone on with to its end may have written no more of them.
    remove_abandoned_files_of(newest_);
}

std::optional<RenderState> read_if_expected(const std::filesystem::path& file,
                                            const CheckpointFiles::Expected& expected) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    try {
        Checkpoint kept = read_checkpoint(file);
        if (!difference_from(kept, expected).empty()) return std::nullopt;
        return take_state(std::move(kept), expected);
    } catch (const IoError&) {
        return std::nullopt;  // it will be written anew
    }
}

}  // namespace etendue
