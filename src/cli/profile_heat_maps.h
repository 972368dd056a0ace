// The files of `etendue profile` that show what each pixel costs.
#pragma once

#include "profile/profile_runs.h"
#include "report/profile_report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// Returns the names of all maps that runs of `integrators` on these numbers of threads may write.
[[nodiscard]] std::vector<std::string> heat_map_files(const std::vector<std::string>& integrators,
                                                      const std::vector<int>& threads);

/// Returns the names of the maps that earlier profiles have left in `directory`; none if there is no such directory.
[[nodiscard]] std::vector<std::string> heat_maps_in(const std::filesystem::path& directory);

/// Writes the map's EXR and PNG, names it in `report`, and keeps its picture for the page.
void write_heat_map(const std::filesystem::path& directory, const PixelRect& window, const CostMap& costs,
                    ProfileReport& report, ProfileImages& images);

}  // namespace etendue
