#include "loader/gltf/gltf_scene_graph.h"

#include "core/shown_text.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

namespace etendue {

namespace {

/// Says of each node whether one of its ancestors is in `listed`. There must be no cycles.
class Ancestors {
  public:
    Ancestors(const std::vector<bool>& listed, const std::vector<int>& parents)
        : listed_(listed), parents_(parents), is_below_(parents.size()) {}

    [[nodiscard]] bool has_listed(int node) {
        // The walk stops at the first ancestor whose answer is known, so that each chain is climbed once.
        std::vector<std::size_t> climbed;
        bool found = false;
        for (auto at = static_cast<std::size_t>(node);;) {
            if (is_below_[at]) {
                found = *is_below_[at];
                break;
            }
            climbed.push_back(at);
            if (parents_[at] == kNoParent) break;
            at = static_cast<std::size_t>(parents_[at]);
            if (listed_[at]) {
                found = true;
                break;
            }
        }
        for (const std::size_t at : climbed) is_below_[at] = found;
        return found;
    }

  private:
    const std::vector<bool>& listed_;
    const std::vector<int>& parents_;
    std::vector<std::optional<bool>> is_below_;
};

/// The nodes that scene `index` lists, but for those that others of them bring along. There must be no cycles.
std::vector<int> roots_of_scene(const GltfDocument& document, std::size_t index, const std::vector<int>& parents,
                                ProblemList& problems) {
    const std::vector<int>& nodes = document.model.scenes[index].nodes;
    std::vector<bool> listed(parents.size(), false);
    std::vector<int> distinct;
    std::size_t repeated = 0;
    for (const int node : nodes) {
        if (listed[static_cast<std::size_t>(node)]) {
            ++repeated;
            continue;
        }
        listed[static_cast<std::size_t>(node)] = true;
        distinct.push_back(node);
    }
    const auto warn = [&](std::size_t count, std::string_view what) {
        if (count > 0)
            problems.warning(document.at(fmt::format("/scenes/{}/nodes", index)),
                             fmt::format("{} of the scene's nodes {}", count, what));
    };
    warn(repeated, "are listed again, and are shown once");
    Ancestors ancestors(listed, parents);
    warn(std::erase_if(distinct, [&](int node) { return ancestors.has_listed(node); }),
         "are children of others of them, and are shown as such");
    const auto has_parent = [&](int node) { return parents[static_cast<std::size_t>(node)] != kNoParent; };
    warn(static_cast<std::size_t>(std::ranges::count_if(distinct, has_parent)),
         "are children of nodes that it does not show, and are shown without their transforms");
    return distinct;
}

}  // namespace

std::vector<int> find_parents(const GltfDocument& document, ProblemList& problems) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<int> parents(nodes.size(), kNoParent);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (std::size_t c = 0; c < nodes[n].children.size(); ++c) {
            const auto child = static_cast<std::size_t>(nodes[n].children[c]);
            if (parents[child] == kNoParent) {
                parents[child] = static_cast<int>(n);
                continue;
            }
            problems.error(document.at(fmt::format("/nodes/{}/children/{}", n, c)),
                           fmt::format("node {} already is a child of node {}", child, parents[child]));
        }
    }
    return parents;
}

void check_cycles(const GltfDocument& document, const std::vector<int>& parents, ProblemList& problems) {
    // Every node has one parent at most, so walking up either ends or meets its own track.
    constexpr std::size_t kUnseen = 0;
    std::vector<std::size_t> walk_of(parents.size(), kUnseen);
    for (std::size_t start = 0; start < parents.size(); ++start) {
        int node = static_cast<int>(start);
        while (node != kNoParent && walk_of[static_cast<std::size_t>(node)] == kUnseen) {
            walk_of[static_cast<std::size_t>(node)] = start + 1;
            node = parents[static_cast<std::size_t>(node)];
        }
        if (node != kNoParent && walk_of[static_cast<std::size_t>(node)] == start + 1) {
            problems.error(document.at(fmt::format("/nodes/{}", node)), "the node is its own ancestor");
        }
    }
}

void choose_scene(const GltfDocument& document, const RenderSettings& settings, SceneDesc& scene,
                  ProblemList& problems) {
    const tinygltf::Model& model = document.model;
    FreeNames free_names;
    for (const tinygltf::Scene& each : model.scenes) scene.scenes.push_back(free_names.take(each.name, "scene"));
    scene.shown_scene = model.defaultScene >= 0 ? static_cast<std::size_t>(model.defaultScene) : 0;
    const std::vector<std::string_view> names(scene.scenes.begin(), scene.scenes.end());
    const std::string& wanted = settings.scene_name;
    if (!wanted.empty()) {
        const auto found = std::ranges::find(names, wanted);
        if (found == names.end())
            problems.error(settings.at("/scene_name"),
                           fmt::format("the file has no scene '{}'; {}", shown(wanted), name_hint(wanted, names)));
        else
            scene.shown_scene = static_cast<std::size_t>(found - names.begin());
    } else if (names.size() > 1) {
        problems.note(
            document.at("/scenes"),
            fmt::format("the file has {} scenes, of which '{}' is shown; --scene NAME shows another, such as "
                        "'{}'",
                        names.size(), shown(names[scene.shown_scene]), shown(names[scene.shown_scene == 0 ? 1 : 0])));
    }
}

std::vector<int> find_roots(const GltfDocument& document, std::size_t index, const std::vector<int>& parents,
                            ProblemList& problems) {
    const tinygltf::Model& model = document.model;
    if (model.scenes.empty()) {
        std::vector<int> roots;
        for (std::size_t n = 0; n < parents.size(); ++n) {
            if (parents[n] == kNoParent) roots.push_back(static_cast<int>(n));
        }
        if (!roots.empty()) {
            problems.warning(document.at(""), "the file has no scene: all nodes without a parent are shown");
        }
        return roots;
    }
    return roots_of_scene(document, index, parents, problems);
}

}  // namespace etendue
