// Connects the starting points of light subpaths to the camera, which shows lamps in view: the strategy (1, 1).
#pragma once

#include "transport/bodies.h"
#include "transport/connecting_ray.h"
#include "transport/light.h"
#include "wave/film_repeats.h"
#include "wave/number_pairs.h"
#include "wave/shadow_ray_queue.h"
#include "wave/subpath/subpath_wave.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// Says how the camera sees a point, and where in the image.
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

class LampsToCamera {
  public:
    /// Connects the points at which `subpaths`, those of `job` from lights, begin to points on the lens, and leaves to
    /// `connections` what arrives, times `weigh(emission, camera, cosine)` with the cosine at the lamp.
    template <typename Weigh>
    void connect(const SubpathJob& job, SubpathWave& subpaths, ShadowRayQueue& connections, const Weigh& weigh) {
        const World& world = job.world();
        draw_lens(job);
        for (std::uint32_t slot = 0; slot < job.samples.size(); ++slot) {
            const Emission& emission = subpaths.emissions()[slot];
            const float time = job.camera_rays[slot].time;
            const auto view = view_from_camera(world, job.job, emission.sample.position, lens_[slot], time);
            if (!view) continue;
            const SurfaceEmission emitted = world.emitters().surface_emission(emission, view->direction);
            if (is_black(emitted.radiance)) continue;
            const float share = weigh(emission, view->camera, emitted.cosine);
            if (share == 0.0f) continue;
            const Interior interior = interior_at_light(world, emission, view->direction);
            Ray ray = connecting_ray(world.emitters().origin(emission, view->direction), view->camera.lens);
            ray.time = time;
            ray.alpha_key = job.connection_key(SubpathEnd::AtLight, 0, slot);
            shares_.clear();
            if (PathWords& words = subpaths.vertices().words(); words.are_followed())
                words.end_at_camera(words.light_source(world, emission.light), shares_);
            connections.to_film(
                ray, slot,
                {.position = view->pixel,
                 .value = emitted.radiance * transmittance(world, interior, ray, view->distance, RayEnds::ToCamera) *
                          (emitted.cosine * view->camera.importance_area * share /
                           (emission.sample.pdf_position_area * emission.probability)),
                 .depth = view->depth},
                LightKind::Seen, shares_);
        }
    }

    [[nodiscard]] std::size_t bytes() const { return keys_.bytes() + lens_.bytes() + vector_bytes(shares_); }

  private:
    void draw_lens(const SubpathJob& job) {
        keys_.clear();
        for (const CameraSample& sample : job.samples) keys_.push_back(sample.key);
        if (job.needs(SubpathEnd::AtLight, SubpathDimension::LightChoice))
            lens_.draw(job.job.sequence, keys_,
                       subpath_dimension(SubpathEnd::AtLight, 0, SubpathDimension::LightChoice));
        else
            lens_.draw_none(keys_.size());
    }

    SampleKeys keys_;
    NumberPairs lens_;
    std::vector<ExpressionShare> shares_;  ///< shares of expressions in the light of the path at hand
};

}  // namespace etendue
