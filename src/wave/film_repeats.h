// Where the film of a camera that sees all around shows the same again, beyond its edges.
#pragma once

#include "film/splat_film.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <cstddef>
#include <vector>

namespace etendue {

/// Calls `visit` for each place, pixels of the full image, where such a film shows what it shows at `place`, and that
/// some pixel of the window sees. Windows go no farther beyond the image than that is large.
template <typename Visit>
void for_each_repeat(const TileJob& job, const Vec2f& place, const Visit& visit) {
    const auto width = static_cast<float>(job.full_width);
    const auto height = static_cast<float>(job.full_height);
    const auto visit_seen = [&](const Vec2f& repeat) {
        if (reaches(job.window, *job.filter, repeat)) visit(repeat);
    };
    for (const float turns : {-1.0f, 1.0f}) visit_seen({place.x + turns * width, place.y});
    // Beyond the poles, upside down.
    for (const float turns : {-1.5f, -0.5f, 0.5f, 1.5f})
        for (const float y : {-place.y, 2.0f * height - place.y}) visit_seen({place.x + turns * width, y});
}

/// Returns true if some pixel of the window sees what the camera sees at `place`, pixels of the full image.
[[nodiscard]] inline bool is_in_view(const World& world, const TileJob& job, const Vec2f& place) {
    if (reaches(job.window, *job.filter, place)) return true;
    bool is_seen = false;
    if (world.traits().film_wraps) for_each_repeat(job, place, [&](const Vec2f&) { is_seen = true; });
    return is_seen;
}

/// Adds the repeats of those of `splats` from index `first` on.
inline void repeat_splats(const TileJob& job, std::size_t first, std::vector<Splat>& splats) {
    for (std::size_t i = first, end = splats.size(); i < end; ++i) {
        Splat copy = splats[i];
        const Vec2f place = copy.position;
        for_each_repeat(job, place, [&](const Vec2f& repeat) {
            copy.position = repeat;
            splats.push_back(copy);
        });
    }
}

}  // namespace etendue
