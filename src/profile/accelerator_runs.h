// The structures of accelerator/ beside Embree, on rays that integrators have traced.
#pragma once

#include "core/ray.h"
#include "report/accelerator_report.h"
#include "scene/accelerator_kind.h"
#include "scene/scene_desc.h"
#include "wave/profile/wave_profile.h"
#include "wave/ray_kind.h"
#include "world/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

/// Returns the names of all structures, Embree the first.
[[nodiscard]] std::vector<std::string> accelerator_names();

/// Returns the structures that `names` name, in the order of `accelerator_names`.
[[nodiscard]] std::vector<AcceleratorKind> accelerator_kinds(const std::vector<std::string>& names);

/// Throws SceneError if `world` cannot have one of `kinds`.
void require_acceleratable(const World& world, const std::vector<AcceleratorKind>& kinds);

/// Keeps rays of each kind that renders have traced, in the order in which they were.
class RecordedRays {
  public:
    /// Limits the rays of one kind: 2.4 MB.
    static constexpr std::size_t kMost = std::size_t{1} << 16;

    /// Adds rays that `profile` has recorded, as far as there is room.
    void add(const WaveProfile& profile);
    [[nodiscard]] const std::vector<Ray>& of(RayKind kind) const { return rays_[static_cast<std::size_t>(kind)]; }

  private:
    std::array<std::vector<Ray>, kRayKinds> rays_;
};

/// Holds what camera rays through the pixels of a small image make a structure do.
struct VisitMap {
    std::string name{};
    int width = 0;
    int height = 0;
    std::vector<float> nodes{};      ///< pixel by pixel
    std::vector<float> triangles{};  ///< pixel by pixel
};

struct AcceleratorRuns {
    AcceleratorReport report{};
    std::vector<VisitMap> visits{};  ///< map of visits for each structure that has nodes
    bool interrupted = false;
};

/// Builds each of `kinds` over `world` and lets all of them trace the same rays of `rays`: of each kind of ray as many
/// as the slowest structure can trace in about half a second. `width` and `height` are those of the image.
[[nodiscard]] AcceleratorRuns measure_accelerators(const World& world, const std::vector<AcceleratorKind>& kinds,
                                                   const RecordedRays& rays, int width, int height);

/// Measures `kinds` over a hilly ground of 100 triangles and of ten times as many, again and again up to `most`.
/// `compile` makes a World of a scene.
[[nodiscard]] std::vector<GrowthPoint> measure_growth(const std::vector<AcceleratorKind>& kinds, std::uint64_t most,
                                                      const std::function<World(SceneDesc)>& compile);

}  // namespace etendue
