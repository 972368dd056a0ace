// What a camera sees of a vertex of a light subpath.
#pragma once

#include "core/ray.h"
#include "film/splat_film.h"
#include "wave/aov/aov_set.h"
#include "wave/film_repeats.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"

#include <optional>

namespace etendue {

/// How the camera sees a point, if it does at all.
struct CameraView {
    CameraConnection camera;
    Vec2f pixel{0.0f, 0.0f};  ///< place in the full image, pixels
    Vec3f direction{0.0f};    ///< unit, from the point to the lens
    float distance = 0.0f;    ///< metres
    float depth = 0.0f;       ///< metres along the viewing direction; of deep images only
};

/// Returns how the camera sees `position` through the lens point made from `lens` in [0, 1)²; nothing if no pixel of
/// the window would show it.
[[nodiscard]] inline std::optional<CameraView> view_from_camera(const World& world, const TileJob& job,
                                                                const Vec3f& position, Vec2f lens, float time) {
    CameraView view{.camera = world.camera().connect(position, lens, time)};
    if (!(view.camera.importance_area > 0.0f)) return std::nullopt;
    view.pixel = {view.camera.film.x * static_cast<float>(job.full_width),
                  view.camera.film.y * static_cast<float>(job.full_height)};
    if (!is_in_view(world, job, view.pixel)) return std::nullopt;
    const Vec3f to_lens = view.camera.lens - position;
    view.distance = length(to_lens);
    view.direction = to_lens * (1.0f / view.distance);
    if (job.aovs != nullptr && job.aovs->layout.is_deep) view.depth = world.camera().depth(position, time);
    return view;
}

}  // namespace etendue
