// docs/gltf.md and the loader must tell the same story of every extension.

#include "loader/gltf/gltf_builder.h"
#include "loader/gltf/gltf_document.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// The states in all rows `| \`NAME\` | STATE: remarks |`, of names that are those of extensions.
std::map<std::string, std::string> documented_states() {
    std::map<std::string, std::string> states;
    std::ifstream stream(ETENDUE_SOURCE_DIR "/docs/gltf.md");
    for (std::string line; std::getline(stream, line);) {
        const std::size_t name_end = line.find("` | ", 3);
        if (!line.starts_with("| `") || name_end == std::string::npos) continue;
        const std::string name = line.substr(3, name_end - 3);
        const std::size_t state = name_end + 4;
        const std::size_t state_end = std::min(line.find_first_of(":,", state), line.find(" |", state));
        if (name.front() < 'A' || name.front() > 'Z' || state_end == std::string::npos) continue;
        EXPECT_TRUE(states.emplace(name, line.substr(state, state_end - state)).second)
            << name << " stands in two rows";
    }
    return states;
}

std::set<std::string> names_with(const std::string& state) {
    std::set<std::string> names;
    for (const auto& [name, found] : documented_states())
        if (found == state) names.insert(name);
    return names;
}

std::set<std::string> to_set(std::span<const std::string_view> names) {
    return {names.begin(), names.end()};
}

TEST(ExtensionTable, SaysYesToWhatIsReadAndToNothingElse) {
    EXPECT_EQ(names_with("yes"), to_set(supported_gltf_extensions()));
}

TEST(ExtensionTable, SaysWhatNoImageDependsOn) {
    EXPECT_EQ(names_with("nothing to show"), to_set(irrelevant_gltf_extensions()));
}

TEST(ExtensionTable, EveryRowHasOneOfTheStates) {
    const auto states = documented_states();
    EXPECT_GT(states.size(), 60u) << "the whole registry";
    for (const auto& [name, state] : states)
        EXPECT_TRUE(state == "yes" || state == "nothing to show" || state == "no") << name << ": " << state;
}

// The look-ups are binary searches.
TEST(ExtensionTable, TheLoadersListsAreSorted) {
    EXPECT_TRUE(std::ranges::is_sorted(supported_gltf_extensions()));
    EXPECT_TRUE(std::ranges::is_sorted(irrelevant_gltf_extensions()));
}

TEST(ExtensionTable, ExtensionsAreTreatedAsItSays) {
    for (const auto& [name, state] : documented_states()) {
        GltfBuilder builder;
        builder.add_triangle();
        builder.json["extensionsUsed"] = {name};
        const LoadedScene used = builder.load();
        EXPECT_EQ(has_problem(used.problems, Severity::Warning, name), state == "no") << name;
        builder.json["extensionsRequired"] = {name};
        EXPECT_EQ(builder.load().problems.has_errors(), state == "no") << name;
    }
}

}  // namespace
}  // namespace etendue
