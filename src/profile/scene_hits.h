// What the rays of a render meet, by the names of the scene: counted from the rays that a profile has recorded.
#pragma once

#include "report/profile_report.h"
#include "scene/scene_desc.h"
#include "wave/profile/wave_profile.h"
#include "world/world.h"

#include <string>
#include <vector>

namespace etendue {

/// Names of what surfaces belong to.
struct SceneHitNames {
    std::vector<std::string> objects{};                ///< name of each instance
    std::vector<std::string> materials{};              ///< name of each material
    std::vector<std::vector<std::string>> textures{};  ///< images that each material names, once each
};

[[nodiscard]] SceneHitNames scene_names(const SceneDesc& scene);

/// Counts the hits of all rays of `rays` that look for the nearest surface, by object, material and image, and shadow
/// rays by the lamp at which they end. The rays of `profile` are traced again; each stands for as many of its kind as
/// were not recorded. The time of tracing is shared out by hits. That of set-up, textures and lobes is shared out by
/// what hits on each material take when they are shaded one by one.
[[nodiscard]] SceneHitsReport count_scene_hits(const World& world, const SceneHitNames& names,
                                               const WaveProfile& profile, const RaysByKind& rays);

}  // namespace etendue
