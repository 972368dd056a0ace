// Scenes with one known radiance, and what every integrator and sampler should find there.
//
// An image of 16 × 16 pixels looks at nearly one point, or at more where the radiance is the same in all of it, and
// gives 256 independent estimates of it: numbers of different pixels are independent, also those of the Sobol' sampler.
// Splats are not, because one path leaves several; for integrators that make them the means of independent images are
// the estimates. A t-test compares their mean with the closed form.
//
// To add a scene: a case in one of the lists below, or a list of its own that closed_form_test.cpp joins.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "film/pixel_filter.h"
#include "integrator/integrator.h"
#include "sampling/sampler.h"
#include "scene/scene_desc.h"
#include "world/world.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue::test {

/// Who finds what the cases are lit by. `light` is in none of the lists: nearly no light path passes the one point that
/// most cameras here look at. `light_too` adds it where the radiance is the same over a wider view.
///
/// Direct light of what rays can meet. (Not `light`, see above.)
inline const std::vector<std::string> kFindDirectLight{"path", "direct", "naive", "bdpt", "whitted"};
/// Direct light of points, spots and suns: not `naive`, whose rays never meet them.
inline const std::vector<std::string> kFindDeltaLights{"path", "direct", "bdpt", "whitted"};
/// Light that arrives after any number of bounces: not `direct` and `whitted`.
inline const std::vector<std::string> kFindAllBounces{"path", "naive", "bdpt"};
/// The same where all bounces are mirrors' and smooth glass's.
inline const std::vector<std::string> kFindAllMirrors{"path", "naive", "bdpt", "whitted"};
/// All bounces of the light of points, spots and suns.
inline const std::vector<std::string> kFindAllBouncesOfDeltaLights{"path", "bdpt"};

[[nodiscard]] inline std::vector<std::string> light_too(std::vector<std::string> integrators) {
    integrators.emplace_back("light");
    return integrators;
}

struct ClosedFormCase {
    std::string name;
    SceneDesc scene;
    double radiance = 0.0;    ///< what the camera sees, the same in all channels
    double tolerance = 1e-5;  ///< relative: rounding, and the tessellation's difference from the curved surface
    PathLengths lengths{};
    /// Those that can find all the light within `lengths`.
    std::vector<std::string> integrators = kFindDirectLight;
    std::uint32_t spp = 64;
    /// Set: the environment is an image of max(0, direction · axis), before the environment's rotation.
    std::optional<Vec3f> environment_axis{};
    bool is_exact = false;  ///< no sample may differ from the mean: every pixel is compared
};

/// Plane receivers under mesh lights, punctual lights and environments.
[[nodiscard]] std::vector<ClosedFormCase> direct_light_cases();
[[nodiscard]] std::vector<ClosedFormCase> environment_cases();
/// Closed spheres, empty or with lossless bodies in them.
[[nodiscard]] std::vector<ClosedFormCase> furnace_cases();
/// White surfaces whose normals lean away from those of their triangles, under a white sky.
[[nodiscard]] std::vector<ClosedFormCase> leaning_normal_cases();
/// Bodies that absorb, nest, overlap, disperse and scatter.
[[nodiscard]] std::vector<ClosedFormCase> body_cases();
/// Direct light where rounding is large.
[[nodiscard]] std::vector<ClosedFormCase> far_from_origin_cases();
/// Emitters, occluders and cameras that move while the shutter is open.
[[nodiscard]] std::vector<ClosedFormCase> motion_cases();
/// Exact shapes as lamps and as bodies.
[[nodiscard]] std::vector<ClosedFormCase> shape_cases();
/// Partly transparent cards, lights and films.
[[nodiscard]] std::vector<ClosedFormCase> transparency_cases();

/// Lamps together with an environment.
[[nodiscard]] std::vector<ClosedFormCase> mixed_light_cases();

/// A latitude-longitude image of max(0, direction · axis) in a file that lives as long as this.
class CosineImage {
  public:
    explicit CosineImage(const Vec3f& axis);
    ~CosineImage();
    CosineImage(const CosineImage&) = delete;
    CosineImage& operator=(const CosineImage&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Side of the images in pixels.
inline constexpr int kImageSide = 16;

/// Returns the world of `scene`, at the size of the images, in `working_space`.
[[nodiscard]] World closed_form_world(SceneDesc scene, const std::string& working_space);

/// Renders such a world, pixels in rows.
[[nodiscard]] std::vector<Rgb> render_pixels(const World& world, const Integrator& integrator, SampleSequence sequence,
                                             std::uint32_t spp, std::uint32_t seed,
                                             FilterShape filter = FilterShape::Box);

/// Renders `scene` in `working_space`, pixels in rows.
[[nodiscard]] std::vector<Rgb> render_pixels(const SceneDesc& scene, const Integrator& integrator,
                                             SampleSequence sequence, std::uint32_t spp, std::uint32_t seed,
                                             const std::string& working_space, FilterShape filter = FilterShape::Box);

}  // namespace etendue::test
