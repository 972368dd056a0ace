// The part of `etendue profile` that is about accelerators.
#pragma once

#include "profile/accelerator_runs.h"
#include "report/profile_report.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace etendue {

struct AcceleratorArguments {
    std::vector<std::string> names{};  ///< empty for none
    std::uint64_t growth = 0;          ///< most triangles; 0 for none
};

/// Declares the options that fill in `arguments`.
void add_accelerator_options(CLI::App& command, AcceleratorArguments& arguments);

/// Returns the names of all pictures that `write_accelerators` may write.
[[nodiscard]] std::vector<std::string> accelerator_pictures(const AcceleratorArguments& arguments);

/// Measures the accelerators, and their growth if that is asked for, puts it all into `report`, writes the pictures
/// into `directory` and keeps them in `images`. `width` and `height` are those of the scene's image, and `compile`
/// makes a World of a scene. Returns false if it was interrupted.
[[nodiscard]] bool measure_and_write_accelerators(const World& world, const AcceleratorArguments& arguments,
                                                  const RecordedRays& rays, int width, int height,
                                                  const std::function<World(SceneDesc)>& compile,
                                                  const std::filesystem::path& directory, ProfileReport& report,
                                                  ProfileImages& images);

}  // namespace etendue
