#include "render/brightest_paths.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

namespace etendue {

namespace {

/// Returns how far a contribution is from `sample`, relative to the brightness of `sample`.
double distance(const SpelledContribution& contribution, const BrightSample& sample) {
    const Rgb difference = contribution.value - sample.value;
    const float most = std::max({std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)});
    return static_cast<double>(most / sample.brightness());
}

/// Returns whether light that falls on `position` is of the pixel of `sample`, or of one beside the image that its
/// filter shows.
bool is_in_pixel(const Vec2f& position, const BrightSample& sample) {
    constexpr float kFilterReach = 8.0f;  // pixels
    return std::abs(position.x - static_cast<float>(sample.x)) < kFilterReach &&
           std::abs(position.y - static_cast<float>(sample.y)) < kFilterReach;
}

/// Writes the word of `path` into `sample`; a word that does not fit ends in ".*", and matches the path as well.
void write_path(const SpelledPath& path, BrightSample& sample) {
    std::string word = path.word;
    if (word.size() >= BrightSample::kWordSize) {
        const std::string rest = std::string(" .* ") + word.back();
        word.resize((BrightSample::kWordSize - 1 - rest.size()) / 2 * 2 - 1);
        word += rest;
    }
    std::ranges::fill(sample.word, '\0');
    std::ranges::copy(word, sample.word.begin());
    sample.s = static_cast<std::uint16_t>(path.s);
    sample.t = static_cast<std::uint16_t>(path.t);
    sample.edges = static_cast<std::uint16_t>(path.edges);
}

void find_path(std::span<const SpelledContribution> contributions, BrightSample& sample) {
    // Neighbours in a packet of rays may change the last bits of a hit.
    double nearest = 1e-3;
    for (const SpelledContribution& found : contributions) {
        if (!found.path || found.position.has_value() != (sample.is_splat != 0)) continue;
        if (found.position && !is_in_pixel(*found.position, sample)) continue;
        const double off = distance(found, sample);
        if (!(off < nearest)) continue;
        nearest = off;
        write_path(*found.path, sample);
    }
}

}  // namespace

void find_brightest_paths(const World& world, const Integrator& integrator, const SamplingOptions& options,
                          RenderState& state) {
    PathSpeller speller;
    AovSet spelled;
    spelled.speller = &speller;
    std::unique_ptr<IntegratorScratch> scratch;
    for (BrightSample& sample : state.counters.brightest.samples()) {
        if (sample.has_path()) continue;
        if (!scratch) scratch = integrator.make_scratch();
        TileJob job{{sample.sample_x, sample.sample_y, sample.sample_x + 1, sample.sample_y + 1},
                    state.film.splat_window(),
                    options.full_width,
                    options.full_height,
                    sample.sample,
                    1,
                    options.seed,
                    options.sequence,
                    &options.filter,
                    &spelled};
        job.merging = integrator.merging(world, job);
        speller.clear();
        TileBuffer tile;
        tile.reset(job.rect);
        RenderCounters counters;
        integrator.render_tile(world, job, *scratch, tile, counters);
        find_path(speller.contributions(), sample);
    }
}

}  // namespace etendue
