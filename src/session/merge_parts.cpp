#include "session/merge_parts.h"

#include "core/error.h"
#include "core/pixel_rect_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
    throw SceneError({file.string(), {}}, message);
}

/// Samples [begin, end) of the pixels of one window.
struct Range {
    std::uint32_t begin;
    std::uint32_t end;
    std::filesystem::path file;
};

/// Left to right, top to bottom.
struct WindowOrder {
    bool operator()(const PixelRect& a, const PixelRect& b) const {
        return std::tie(a.y0, a.x0, a.y1, a.x1) < std::tie(b.y0, b.x0, b.y1, b.x1);
    }
};
using Ranges = std::map<PixelRect, std::vector<Range>, WindowOrder>;

/// Samples per pixel of one window. Throws SceneError if ranges overlap.
std::uint32_t count_samples(std::vector<Range>& ranges, const std::function<void(const std::string&)>& note) {
    std::ranges::sort(ranges, {}, &Range::begin);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const Range& range = ranges[i];
        count += range.end - range.begin;
        if (i == 0) continue;
        const Range& before = ranges[i - 1];
        if (range.begin < before.end)
            fail(range.file,
                 fmt::format("has samples {} to {} of each pixel, and {} has {} to {}: none may be added twice",
                             range.begin, range.end - 1, before.file.string(), before.begin, before.end - 1));
        if (range.begin > before.end)
            note(fmt::format("no part has samples {} to {}; the image is right, but its samples are spread less evenly",
                             before.end, range.begin - 1));
    }
    return count;
}

PixelRect bounds_of(const Ranges& ranges) {
    PixelRect bounds = ranges.begin()->first;
    for (const auto& [window, ignored] : ranges)
        bounds = {std::min(bounds.x0, window.x0), std::min(bounds.y0, window.y0), std::max(bounds.x1, window.x1),
                  std::max(bounds.y1, window.y1)};
    return bounds;
}

/// Throws SceneError if two windows have a pixel in common, or a pixel of their bounds is in none.
void check_tiling(const Ranges& ranges, const PixelRect& bounds) {
    std::vector<const Range*> owners(bounds.area(), nullptr);
    std::size_t covered = 0;
    for (const auto& [window, parts] : ranges) {
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                const Range*& owner =
                    owners[static_cast<std::size_t>(y - bounds.y0) * static_cast<std::size_t>(bounds.width()) +
                           static_cast<std::size_t>(x - bounds.x0)];
                if (owner != nullptr)
                    fail(parts.front().file,
                         fmt::format(
                             "has pixel ({}, {}), which {} has in another window: windows must be equal or apart", x, y,
                             owner->file.string()));
                owner = &parts.front();
            }
        covered += window.area();
    }
    if (covered == bounds.area()) return;
    const auto hole = static_cast<std::size_t>(std::ranges::find(owners, nullptr) - owners.begin());
    const auto width = static_cast<std::size_t>(bounds.width());
    fail(ranges.begin()->second.front().file,
         fmt::format("no part has pixel ({}, {}), which lies between those of others",
                     static_cast<std::size_t>(bounds.x0) + hole % width,
                     static_cast<std::size_t>(bounds.y0) + hole / width));
}

/// Throws SceneError if the number of samples per pixel is not the same everywhere; notes if only the number is.
void check_samples(Ranges& ranges, const std::function<void(const std::string&)>& note) {
    std::optional<std::uint32_t> common;
    for (auto& [window, parts] : ranges) {
        const std::uint32_t count = count_samples(parts, note);
        if (common && *common != count)
            fail(parts.front().file,
                 fmt::format("the pixels {} have {} samples each in all parts together, others have {}",
                             text_of(window), count, *common));
        common = count;
    }
    const auto& [first_window, first_parts] = *ranges.begin();
    for (const auto& [window, parts] : ranges)
        if (parts.front().begin != first_parts.front().begin || parts.back().end != first_parts.back().end)
            return note(fmt::format(
                "the pixels {} have samples {} to {} and the pixels {} have {} to {}: as many, but not the same ones",
                text_of(first_window), first_parts.front().begin, first_parts.back().end - 1, text_of(window),
                parts.front().begin, parts.back().end - 1));
}

/// Reads one part after the other, as what it must be to be added to the first.
class Parts {
  public:
    explicit Parts(const std::filesystem::path& first) : first_(first) {}

    Checkpoint read(const std::filesystem::path& file) {
        Checkpoint part = read_checkpoint(file);
        if (part.state.pass_size > 0)
            fail(file, "is the checkpoint of a render that is not finished; go on with it with --resume");
        if (part.state.spp_done == 0) fail(file, "has no samples");
        if (!part.state.adaptive.is_uniform())
            fail(file,
                 "is of an adaptive render (--error), whose pixels have different numbers of samples; "
                 "render parts with --samples or --crop");
        if (identity_.empty()) {
            identity_ = part.identity;
            splat_window_ = part.state.film.splat_window();
        }
        const std::string different =
            difference(part.identity, identity_, "in " + file.filename().string(), "in " + first_.filename().string());
        if (!different.empty())
            fail(file, fmt::format("is part of another render than {}:\n{}", first_.string(), different));
        if (part.state.film.splat_window() != splat_window_)
            fail(file, fmt::format("was not rendered as a part of the same image as {}", first_.string()));
        return part;
    }

  private:
    const std::filesystem::path& first_;
    RenderIdentity identity_;
    PixelRect splat_window_;
};

/// Without samples, of pixels `bounds`, with all that `part` has.
RenderState nothing_like(const RenderState& part, const PixelRect& bounds) {
    const Film& film = part.film;
    const auto empty_film = [&] {
        return Film(film.full_width(), film.full_height(), bounds, film.splat_window(), film.layers().layout());
    };
    RenderState none{.film = empty_film(), .first_sample = std::numeric_limits<std::uint32_t>::max()};
    if (part.every_other_pass) none.every_other_pass = empty_film();
    return none;
}

/// `is_counted` for the parts of one window, whose samples are those of every window.
void add(RenderState& sum, const RenderState& part, bool is_counted) {
    sum.film.add(part.film);
    if (sum.every_other_pass && part.every_other_pass) sum.every_other_pass->add(*part.every_other_pass);
    if (is_counted) {
        sum.spp_done += part.spp_done;
        sum.every_other_spp += part.every_other_spp;
    }
    sum.counters.add(part.counters);
    sum.wall_seconds += part.wall_seconds;
    sum.cpu_seconds += part.cpu_seconds;
    sum.first_sample = std::min(sum.first_sample, part.first_sample);
}

}  // namespace

MergedParts merge_parts(std::span<const std::filesystem::path> files,
                        const std::function<void(const std::string&)>& note) {
    // Twice, so that nothing is added before all is known to fit, and no more than one part is in memory.
    Parts parts(files.front());
    Ranges ranges;
    for (const std::filesystem::path& file : files) {
        const RenderState state = parts.read(file).state;
        ranges[state.film.window()].push_back({state.first_sample, state.next_sample(), file});
    }
    std::uint32_t end = 0;
    for (const auto& [ignored, of_window] : ranges)
        for (const Range& range : of_window) end = std::max(end, range.end);
    const PixelRect bounds = bounds_of(ranges);
    check_tiling(ranges, bounds);
    check_samples(ranges, note);
    const PixelRect counted = ranges.begin()->first;

    std::optional<Checkpoint> merged;
    for (const std::filesystem::path& file : files) {
        Checkpoint part = parts.read(file);
        if (!merged) merged = {std::move(part.identity), std::move(part.description), nothing_like(part.state, bounds)};
        add(merged->state, part.state, part.state.film.window() == counted);
    }
    const std::uint32_t span = end - merged->state.first_sample;
    return {std::move(*merged), span, ranges.size() == 1};
}

}  // namespace etendue
