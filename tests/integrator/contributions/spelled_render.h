// All contributions of a room's renders, one by one, with their paths.
#pragma once

#include "integrator/agreement_render.h"
#include "wave/aov/layered_render.h"
#include "wave/aov/path_speller.h"

#include <functional>
#include <string>

namespace etendue::test {

/// Calls `see` for each contribution of every sample, with the pixel and the index of the sample that made it.
inline void spell_all(const World& world, const std::string& integrator, const AgreementCase& room, std::uint32_t seed,
                      const std::function<void(const SpelledContribution&, int x, int y, std::uint32_t sample)>& see) {
    const RenderOptions options = render_options(room);
    const auto algorithm = make_integrator(integrator, {.lengths = room.lengths});
    const auto scratch = algorithm->make_scratch();
    PathSpeller speller;
    AovSet aovs;
    aovs.speller = &speller;
    TileBuffer tile;
    RenderCounters counters;
    for (int y = options.window.y0; y < options.window.y1; ++y)
        for (int x = options.window.x0; x < options.window.x1; ++x)
            for (std::uint32_t sample = 0; sample < options.spp; ++sample) {
                const TileJob job{{x, y, x + 1, y + 1},
                                  options.window,
                                  options.full_width,
                                  options.full_height,
                                  sample,
                                  1,
                                  seed,
                                  options.sequence,
                                  &options.filter,
                                  &aovs};
                speller.clear();
                tile.reset(job.rect);
                algorithm->render_tile(world, job, *scratch, tile, counters);
                for (const SpelledContribution& found : speller.contributions()) see(found, x, y, sample);
            }
}

}  // namespace etendue::test
