// Which scene of a file is shown, and which nodes it begins with.
#pragma once

#include "loader/gltf/gltf_document.h"
#include "scene/scene_desc.h"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace etendue {

/// Hands out names of which none is there twice.
class FreeNames {
  public:
    /// Returns `wanted`, or `fallback` for an empty one; where that is taken, with a number behind it.
    std::string take(const std::string& wanted, const std::string& fallback) {
        const std::string base = wanted.empty() ? fallback : wanted;
        std::string name = base;
        for (int& n = last_number_[base]; !taken_.insert(name).second;) name = fmt::format("{}-{}", base, ++n + 1);
        return name;
    }

  private:
    std::set<std::string> taken_;
    std::map<std::string, int> last_number_;  ///< by name, so that finding a free one does not start over
};

/// Stands for the parent of a node that has none.
inline constexpr int kNoParent = -1;

/// Returns the parent of every node. Errors for nodes with two.
[[nodiscard]] std::vector<int> find_parents(const GltfDocument& document, ProblemList& problems);

/// Reports one error for each cycle.
void check_cycles(const GltfDocument& document, const std::vector<int>& parents, ProblemList& problems);

/// Chooses the scene that `settings` name, or the file's own, and tells `scene` which there are. An error if there is
/// none of that name, and a note if one of several was taken without being asked for.
void choose_scene(const GltfDocument& document, const RenderSettings& settings, SceneDesc& scene,
                  ProblemList& problems);

/// Returns the nodes to start from, of the scene with this index. There must be no cycles.
[[nodiscard]] std::vector<int> find_roots(const GltfDocument& document, std::size_t index,
                                          const std::vector<int>& parents, ProblemList& problems);

}  // namespace etendue
