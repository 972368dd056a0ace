#include "color/config_files.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <system_error>

#include <fmt/format.h>

namespace OCIO = OCIO_NAMESPACE;

namespace etendue {

namespace {

/// Limits how deep transforms are nested or refer to each other: a config that is made by hand has a few levels, and
/// OpenColorIO's stack has room for many more.
constexpr int kMostLevels = 64;
/// Limits the transforms that one conversion expands to.
constexpr std::uint64_t kMostSteps = 100'000;

/// Counts the transforms that a transform expands to, and their levels.
struct Expansion {
    std::uint64_t steps = 1;
    int levels = 1;

    void add(const Expansion& other) {
        steps = std::min(steps + other.steps, kMostSteps + 1);
        levels = std::max(levels, other.levels + 1);
    }
};

class Follower {
  public:
    explicit Follower(const OCIO::Config& config) : config_(config), context_(config.getCurrentContext()) {}

    const ConfigReferences& follow() {
        for (int i = 0; i < config_.getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL); ++i) {
            const char* const name =
                config_.getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, i);
            check(fmt::format("colour space '{}'", name), of_space(name));
        }
        for (int i = 0; i < config_.getNumLooks(); ++i) {
            const auto look = config_.getLook(config_.getLookNameByIndex(i));
            check(fmt::format("look '{}'", look->getName()), of_look(look));
        }
        for (int i = 0; i < config_.getNumViewTransforms(); ++i) {
            const char* const name = config_.getViewTransformNameByIndex(i);
            check(fmt::format("view transform '{}'", name), of_view_transform(name));
        }
        for (int i = 0; i < config_.getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL); ++i) {
            const char* const name = config_.getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, i);
            check(fmt::format("named transform '{}'", name), of_named(name));
        }
        return found_;
    }

  private:
    void check(const std::string& what, const Expansion& expansion) {
        if (!found_.problem.empty()) return;
        if (expansion.levels > kMostLevels)
            found_.problem = fmt::format("{} refers to itself, or to others more than {} deep", what, kMostLevels);
        else if (expansion.steps > kMostSteps)
            found_.problem = fmt::format("{} is made of more than {} transforms", what, kMostSteps);
    }
    /// Returns what `expand` finds of the thing that is called `key`, which it looks at once; a thing that refers to
    /// itself is too deep.
    Expansion once(const std::string& key, const auto& expand) {
        const Expansion too_deep{.levels = kMostLevels + 1};
        if (const auto known = known_.find(key); known != known_.end()) return known->second;
        known_[key] = too_deep;
        if (depth_ >= kMostLevels) return too_deep;
        ++depth_;
        const Expansion result = expand();
        --depth_;
        return known_[key] = result;
    }

    /// Expands a thing's transforms of both ways: OpenColorIO looks at both, whichever is wanted.
    Expansion of_both(const std::string& key, const OCIO::ConstTransformRcPtr& one,
                      const OCIO::ConstTransformRcPtr& other) {
        return once(key, [&] {
            Expansion sum = of_transform(one);
            sum.add(of_transform(other));
            return sum;
        });
    }
    Expansion of_space(const char* name) {
        const auto space = config_.getColorSpace(context_->resolveStringVar(name));
        if (!space) return {};
        return of_both(fmt::format("space {}", space->getName()),
                       space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE),
                       space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
    }
    Expansion of_spaces(const char* from, const char* to) {
        Expansion sum = of_space(from);
        sum.add(of_space(to));
        return sum;
    }
    Expansion of_named(const char* name) {
        const auto named = config_.getNamedTransform(name);
        if (!named) return {};
        return of_both(fmt::format("named {}", name), named->getTransform(OCIO::TRANSFORM_DIR_FORWARD),
                       named->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
    }
    Expansion of_view_transform(const char* name) {
        const auto view = config_.getViewTransform(name);
        if (!view) return {};
        return of_both(fmt::format("view {}", name), view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE),
                       view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
    }
    Expansion of_look(const OCIO::ConstLookRcPtr& look) {
        if (!look) return {};
        return once(fmt::format("look {}", look->getName()), [&] {
            Expansion sum = of_transform(look->getTransform());
            sum.add(of_transform(look->getInverseTransform()));
            sum.add(of_space(look->getProcessSpace()));
            return sum;
        });
    }
    /// Names of looks with signs, commas and bars around them: whichever of them appear.
    Expansion of_looks(const std::string& names) {
        Expansion sum;
        for (std::size_t begin = 0; begin < names.size();) {
            const std::size_t end = std::min(names.find_first_of(",|:", begin), names.size());
            const std::size_t first = std::min(names.find_first_not_of(" +-", begin), end);
            const std::size_t last = names.find_last_not_of(' ', end == 0 ? 0 : end - 1);
            if (first < end) sum.add(of_look(config_.getLook(names.substr(first, last + 1 - first).c_str())));
            begin = end + 1;
        }
        return sum;
    }
    Expansion of_display(const OCIO::DisplayViewTransform& transform) {
        const char* const display = transform.getDisplay();
        const char* const view = transform.getView();
        const std::string space = config_.getDisplayViewColorSpaceName(display, view);
        const bool is_of_display = space == OCIO::OCIO_VIEW_USE_DISPLAY_NAME;
        Expansion sum = of_spaces(transform.getSrc(), is_of_display ? display : space.c_str());
        sum.add(of_looks(config_.getDisplayViewLooks(display, view)));
        sum.add(of_view_transform(config_.getDisplayViewTransformName(display, view)));
        return sum;
    }

    Expansion of_transform(const OCIO::ConstTransformRcPtr& transform) {
        if (!transform) return {};
        if (const auto file = OCIO_DYNAMIC_POINTER_CAST<const OCIO::FileTransform>(transform)) {
            add_file(file->getSrc());
        } else if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const OCIO::GroupTransform>(transform)) {
            Expansion sum;
            for (int i = 0; i < group->getNumTransforms(); ++i) sum.add(of_transform(group->getTransform(i)));
            return sum;
        } else if (const auto to = OCIO_DYNAMIC_POINTER_CAST<const OCIO::ColorSpaceTransform>(transform)) {
            return of_spaces(to->getSrc(), to->getDst());
        } else if (const auto look = OCIO_DYNAMIC_POINTER_CAST<const OCIO::LookTransform>(transform)) {
            Expansion sum = of_spaces(look->getSrc(), look->getDst());
            sum.add(of_looks(look->getLooks()));
            return sum;
        } else if (const auto shown = OCIO_DYNAMIC_POINTER_CAST<const OCIO::DisplayViewTransform>(transform)) {
            return of_display(*shown);
        }
        return {};
    }

    void add_file(const std::string& source) {
        if (!seen_.insert(source).second) return;
        std::filesystem::path file;
        try {
            file = context_->resolveFileLocation(source.c_str());
        } catch (const OCIO::Exception&) {
            return;  // there is none, which OpenColorIO says of the conversions that ask for it
        }
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) return;
        if (const std::string why = why_not_read(file); !why.empty() && found_.problem.empty())
            found_.problem = fmt::format("its table {} cannot be read: {}", file.string(), why);
        if (std::ranges::find(found_.files, file) == found_.files.end()) found_.files.push_back(file);
    }

    const OCIO::Config& config_;
    OCIO::ConstContextRcPtr context_;
    ConfigReferences found_;
    std::set<std::string> seen_;
    std::map<std::string, Expansion> known_;
    int depth_ = 0;
};

}  // namespace

ConfigReferences find_references(const OCIO::Config& config) {
    return Follower(config).follow();
}

std::string why_not_read(const std::filesystem::path& file) {
    constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) return "there is no such file";
    if (!std::filesystem::is_regular_file(status)) return "it is no regular file";
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) return error.message();
    if (size > kMostBytes) return fmt::format("it is larger than {} MiB", kMostBytes >> 20u);
    return {};
}

}  // namespace etendue
