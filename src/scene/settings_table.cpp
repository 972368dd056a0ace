// The table of settings: one row for each, in the header of its group, and nothing else to do for it but its use.
#include "scene/setting.h"
#include "scene/settings_of_files.h"
#include "scene/settings_of_samples.h"
#include "scene/settings_of_scene.h"
#include "scene/settings_of_transport.h"
#include "scene/settings_of_view.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace etendue {

namespace {

template <std::size_t N>
constexpr std::array<Setting, N> in_group(SettingGroup group, std::array<Setting, N> rows) {
    for (Setting& row : rows) row.group = group;
    return rows;
}

template <std::size_t... N>
constexpr std::array<Setting, (N + ...)> joined(const std::array<Setting, N>&... groups) {
    std::array<Setting, (N + ...)> all{};
    auto* end = all.begin();
    ((end = std::copy(groups.begin(), groups.end(), end)), ...);
    return all;
}

constexpr auto kRows =
    joined(in_group(SettingGroup::Transport, kTransportSettings), in_group(SettingGroup::Samples, kSampleSettings),
           in_group(SettingGroup::View, kViewSettings), in_group(SettingGroup::Scene, kSceneSettings),
           in_group(SettingGroup::Animation, kAnimationSettings), in_group(SettingGroup::Files, kLayerSettings),
           in_group(SettingGroup::Colour, kColourSettings), in_group(SettingGroup::Files, kMetadataSettings));

}  // namespace

std::span<const Setting> settings_table() {
    return kRows;
}

}  // namespace etendue
