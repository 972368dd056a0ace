#include "session/checkpoint_files.h"

#include "core/error.h"
#include "core/log.h"
#include "core/pixel_rect_text.h"
#include "core/write_file.h"
#include "picture/output_paths.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// `identity` and what else a render cannot go on with if it is different.
RenderIdentity with_sampling(RenderIdentity identity, const PixelRect& window, const PixelRect& splat_window,
                             std::uint32_t first_sample) {
    identity["pixels"] = text_of(window);
    identity["pixels that have light paths"] = text_of(splat_window);
    identity["first sample"] = fmt::format("{}", first_sample);
    return identity;
}

/// Why `kept` is not of what is expected; empty if it is. `what` it is, and how to do `without` it.
std::string why_refused(const Checkpoint& kept, const CheckpointFiles::Expected& expected, const char* what,
                        const char* without) {
    const RenderState& state = kept.state;
    const std::string differences =
        difference(with_sampling(kept.identity, state.film.window(), state.film.splat_window(), state.first_sample),
                   with_sampling(expected.identity, expected.window, expected.splat_window, expected.first_sample));
    if (!differences.empty())
        return fmt::format("the {} is of another render; {}, or mend what differs:\n{}", what, without, differences);
    const std::uint64_t spp = std::uint64_t{state.spp_done} + state.pass_size;
    if (expected.most_spp && spp > *expected.most_spp)
        return fmt::format("the {} has {} samples of each pixel, and no more than {} are asked for; {}", what, spp,
                           *expected.most_spp, without);
    if (expected.every_other_pass && !state.every_other_pass)
        return fmt::format(
            "the {} was begun without --error and without layers for denoising, and does not hold what they need; "
            "leave them out, or {}",
            what, without);
    if (!expected.adaptive && !state.adaptive.is_uniform())
        return fmt::format(
            "the {} is of an adaptive render (--error), and some of its pixels have more samples than others; go on "
            "with it as it was begun, or {}",
            what, without);
    return {};
}

/// Throws RefusedCheckpoint if `kept`, which stands in `path`, is not of what is expected.
void require_expected(const Checkpoint& kept, const CheckpointFiles::Expected& expected,
                      const std::filesystem::path& path, const char* what, const char* without) {
    const std::string why = why_refused(kept, expected, what, without);
    if (!why.empty()) throw RefusedCheckpoint({path.string(), {}}, why);
}

/// Drops what is not needed.
void simplify(RenderState& state, const CheckpointFiles::Expected& expected) {
    if (expected.every_other_pass) return;
    state.every_other_pass.reset();
    state.every_other_spp = 0;
}

/// Throws IoError.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (error) throw IoError(fmt::format("cannot rename {} to {}: {}", from.string(), to.string(), error.message()));
}

}  // namespace

CheckpointFiles::CheckpointFiles(const std::filesystem::path& output) : newest_(output) {
    // A part and an image may have one name but for the extension, and be rendered at once.
    if (is_partial(output))
        newest_ += ".checkpoint";
    else
        newest_.replace_extension(".checkpoint");
    previous_ = newest_;
    previous_ += ".previous";
}

void CheckpointFiles::write(const RenderIdentity& identity, const std::string& description,
                            const RenderState& state) const {
    // A second name for the newest file, which then is replaced as a whole.
    std::error_code error;
    if (std::filesystem::exists(newest_, error)) {
        std::filesystem::remove(previous_, error);
        std::filesystem::create_hard_link(newest_, previous_, error);
        // Where there are no links, the newest is renamed: the previous one is then the only one for a moment.
        if (error) rename_file(newest_, previous_);
    }
    write_checkpoint(newest_, identity, description, state);
}

std::optional<Checkpoint> CheckpointFiles::read(const Expected& expected, bool quiet) const {
    std::optional<DamagedCheckpoint> damage;
    std::optional<IoError> unreadable;
    for (const std::filesystem::path& path : {newest_, previous_}) {
        std::error_code error;
        if (!std::filesystem::exists(path, error)) continue;
        std::optional<Checkpoint> kept;
        try {
            kept = read_checkpoint(path);
        } catch (const DamagedCheckpoint& broken) {
            if (!quiet) log_warning("warning: {}", broken.what());
            damage = broken;
            continue;
        } catch (const IoError& failure) {
            if (!quiet) log_warning("warning: {}", failure.what());
            unreadable = failure;
            continue;
        }
        require_expected(*kept, expected, path, "checkpoint", "start anew without --resume");
        // Else the damaged one would become the previous one, in place of this.
        if (damage) rename_file(path, newest_);
        // What cannot be read may not be replaced either, and that is no reason to do without both.
        if (unreadable) std::filesystem::rename(path, newest_, error);
        simplify(kept->state, expected);
        return kept;
    }
    if (unreadable) throw IoError(*unreadable);
    if (damage)
        throw RefusedCheckpoint(
            {}, fmt::format("{}; no other checkpoint is left: start anew without --resume", damage->what()));
    return std::nullopt;
}

bool CheckpointFiles::exist() const {
    std::error_code error;
    return std::filesystem::exists(newest_, error) || std::filesystem::exists(previous_, error);
}

bool CheckpointFiles::are_newer_than(const std::filesystem::path& file) const {
    std::error_code error;
    const auto written = std::filesystem::last_write_time(file, error);
    if (error) return true;
    return std::ranges::any_of(paths(), [&](const std::filesystem::path& path) {
        const auto kept = std::filesystem::last_write_time(path, error);
        return !error && kept > written;
    });
}

void CheckpointFiles::remove() const {
    std::error_code ignored;
    std::filesystem::remove(newest_, ignored);
    std::filesystem::remove(previous_, ignored);
    // A render that was killed while it wrote one and was gone on with to its end may have written no more of them.
    remove_abandoned_files_of(newest_);
}

CheckpointFiles::Expected expected_image(const RenderIdentity& identity, const RenderOptions& options,
                                         bool every_other_pass) {
    return {.identity = identity,
            .window = options.window,
            .splat_window = options.splat_window.empty() ? options.window : options.splat_window,
            .every_other_pass = every_other_pass,
            .adaptive = options.adaptive};
}

CheckpointFiles::Expected expected_part(const RenderIdentity& identity, const RenderOptions& options,
                                        std::uint32_t first_sample, bool every_other_pass) {
    CheckpointFiles::Expected expected = expected_image(identity, options, every_other_pass);
    expected.first_sample = first_sample;
    // An image may have more samples than are asked for, but parts must not overlap.
    expected.most_spp = options.spp;
    return expected;
}

bool is_of(const Checkpoint& kept, const CheckpointFiles::Expected& expected) {
    return why_refused(kept, expected, "", "").empty();
}

std::optional<Checkpoint> read_part(const std::filesystem::path& file, const CheckpointFiles::Expected& expected,
                                    bool quiet) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    std::optional<Checkpoint> kept;
    try {
        kept = read_checkpoint(file);
    } catch (const DamagedCheckpoint& broken) {
        if (!quiet) log_warning("warning: {}; it is rendered again", broken.what());
        return std::nullopt;
    }
    require_expected(*kept, expected, file, "part", "write to another file, or replace it with --force");
    simplify(kept->state, expected);
    return kept;
}

std::filesystem::path sums_path(const std::filesystem::path& output) {
    return std::filesystem::path(output).replace_extension(".sums");
}

void keep_sums(const std::filesystem::path& output, bool are_kept, const RenderIdentity& identity,
               const std::string& description, const RenderState& state) {
    const std::filesystem::path path = sums_path(output);
    try {
        if (are_kept) return write_checkpoint(path, identity, description, state);
    } catch (const IoError& error) {
        log_error("error: the sums were not kept: {}", error.what());
    }
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
}

std::optional<Checkpoint> read_sums(const std::filesystem::path& file, const CheckpointFiles::Expected& expected,
                                    int most_spp, bool quiet) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    try {
        Checkpoint kept = read_checkpoint(file);
        if (!is_of(kept, expected) || static_cast<std::int64_t>(kept.state.spp_done) > most_spp) return std::nullopt;
        simplify(kept.state, expected);
        return kept;
    } catch (const RefusedCheckpoint&) {
        // Sums that another version wrote are left out, like sums of other renders.
    } catch (const DamagedCheckpoint& broken) {
        if (!quiet) log_warning("warning: {}; the image begins anew", broken.what());
    } catch (const IoError& failure) {
        if (!quiet) log_warning("warning: {}; the image begins anew", failure.what());
    }
    return std::nullopt;
}

}  // namespace etendue
