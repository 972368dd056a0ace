// What is suggested where a name is not known, at little cost however many unknown names there are.
#pragma once

#include "core/error.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

/// Returns the distinct names that `things` have, sorted.
template <typename Thing>
[[nodiscard]] std::vector<std::string_view> names_of(const std::vector<Thing>& things) {
    std::vector<std::string_view> names;
    for (const Thing& thing : things)
        if (!thing.name.empty()) names.push_back(thing.name);
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

/// Suggests one of the names that there are, which are collected once. They must stay where they are.
class KnownNames {
  public:
    explicit KnownNames(std::function<std::vector<std::string_view>()> collect) : collect_(std::move(collect)) {}

    /// Returns the `name_hint` for `name`, or nothing where `problems` would not keep it.
    [[nodiscard]] std::string hint(std::string_view name, const ProblemList& problems) {
        if (problems.is_full()) return {};
        if (!names_) names_ = collect_();
        return name_hint(name, *names_);
    }

  private:
    std::function<std::vector<std::string_view>()> collect_;
    std::optional<std::vector<std::string_view>> names_;
};

}  // namespace etendue
