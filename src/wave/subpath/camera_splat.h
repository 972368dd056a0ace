// What a camera sees of a vertex of a light subpath.
#pragma once

#include "core/ray.h"
#include "film/splat_film.h"
#include "transport/light.h"
#include "wave/aov/aov_set.h"
#include "wave/film_repeats.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"

#include <optional>

namespace etendue {

/// Says where in the image a point is seen besides.
struct CameraView : LensView {
    Vec2f pixel{0.0f, 0.0f};  ///< place in the full image, pixels
    float depth = 0.0f;       ///< metres along the viewing direction; of deep images only
};

/// Returns how the camera sees `position` through the lens point made from `lens` in [0, 1)²; nothing if no pixel of
/// the window would show it.
[[nodiscard]] inline std::optional<CameraView> view_from_camera(const World& world, const TileJob& job,
                                                                const Vec3f& position, Vec2f lens, float time) {
    const std::optional<LensView> seen = view_from_lens(world, position, lens, time);
    if (!seen) return std::nullopt;
    CameraView view{*seen,
                    {seen->camera.film.x * static_cast<float>(job.full_width),
                     seen->camera.film.y * static_cast<float>(job.full_height)}};
    if (!is_in_view(world, job, view.pixel)) return std::nullopt;
    if (job.aovs != nullptr && job.aovs->layout.is_deep) view.depth = world.camera().depth(position, time);
    return view;
}

}  // namespace etendue
