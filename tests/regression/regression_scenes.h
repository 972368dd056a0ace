// Which scenes are rendered, how, and what their references are made of.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace etendue::test {

/// How many independent renders make an estimate, and of what.
struct Sampling {
    std::string_view integrator;
    int renders = 4;  ///< independent seeds, from whose spread the variance is measured
    int spp = 32;     ///< of each render
};

/// Where scenes are: those for users, and what tools/gen/make_material_rows.py makes.
inline constexpr std::string_view kSceneDirectories[] = {ETENDUE_SCENES, ETENDUE_MATERIAL_ROWS};

/// A scene of kSceneDirectories, seen small.
///
/// To add one: a row in regression_scenes.cpp, then tools/dev/update_references with a filter for its name.
struct RegressionScene {
    std::string_view parent;  ///< one of kSceneDirectories
    std::string_view name;    ///< of the directory in it
    int width = 0;            ///< pixels
    int height = 0;           ///< pixels
    int block_size = 8;       ///< pixels; larger for scenes with fireflies, whose small blocks are far from normal
    /// Most relative difference of the images' means; what their noise allows.
    double mean_tolerance = 0.01;
    Sampling test;
    /// Made with the random sampler, and where that is possible without light sampling: an estimate that shares little
    /// with what is tested.
    Sampling reference;
};

[[nodiscard]] std::span<const RegressionScene> regression_scenes();
/// Names of scenes that are there to be rendered, not to be compared.
[[nodiscard]] std::span<const std::string_view> scenes_without_reference();

}  // namespace etendue::test
