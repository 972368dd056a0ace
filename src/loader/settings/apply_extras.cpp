#include "loader/settings/apply_extras.h"

#include "core/shown_text.h"
#include "loader/json_text.h"
#include "loader/settings/light_override.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using ExtrasJson = nlohmann::json;

/// Members that may be 0 or 1, as exporters write what is true or false.
constexpr std::string_view kExtraFlags[] = {"visible_to_camera", "shadow_catcher", "holdout", "stops_light",
                                            "enabled",           "solid",          "clip"};
/// Members of lights that say the same in different words: of each group render.json has all or nothing.
constexpr std::string_view kExtraStrengths[] = {"power", "irradiance", "radiance", "intensity"};
constexpr std::string_view kExtraPlaces[] = {"node", "position", "rotation", "look_at", "up"};

/// Adds the problems of `found` to `problems`, none as more than a warning.
void warn_of(const ProblemList& found, ProblemList& problems) {
    for (Problem problem : found.all()) {
        problem.severity = std::min(problem.severity, Severity::Warning);
        problems.add(std::move(problem));
    }
}

/// Returns the object that `extras` hold, which may be one or the text of one; none, and a warning, if they hold
/// something else.
std::optional<ExtrasJson> object_of(const ExtrasDesc& extras, ProblemList& problems) {
    try {
        ExtrasJson value = parse_json(extras.json, extras.location);
        if (value.is_string()) value = parse_json(value.get<std::string>(), extras.location);
        if (!value.is_object()) {
            problems.warning(extras.location, fmt::format("must be an object, but is {}", json_kind(value)));
            return std::nullopt;
        }
        for (const std::string_view flag : kExtraFlags)
            if (const auto found = value.find(flag); found != value.end() && (*found == 0 || *found == 1))
                *found = *found == 1;
        return value;
    } catch (const SceneError& error) {
        warn_of(error.problems(), problems);
        return std::nullopt;
    }
}

/// Takes out of `value` the members that `read(value, problems)` finds errors in, with a warning each. Returns false if
/// the errors are of no member.
bool leave_out_wrong(ExtrasJson& value, const SourceLocation& where, const auto& read, ProblemList& problems) {
    while (true) {
        ProblemList found;
        read(value, found);
        warn_of(found, problems);
        if (!found.has_errors()) return true;
        bool is_less = false;
        for (auto member = value.begin(); member != value.end();) {
            const std::string pointer = child_pointer(where.pointer, member.key());
            const bool is_wrong = std::ranges::any_of(found.all(), [&](const Problem& problem) {
                return problem.severity == Severity::Error &&
                       (problem.where.pointer == pointer || problem.where.pointer.starts_with(pointer + "/"));
            });
            is_less = is_less || is_wrong;
            member = is_wrong ? value.erase(member) : std::next(member);
        }
        if (!is_less) return false;
        if (value.empty()) return false;
    }
}

/// Takes the members of `group` out of `value` if `given` has one of them.
void yield_to(const ExtrasJson& given, std::span<const std::string_view> group, ExtrasJson& value) {
    const bool is_given = std::ranges::any_of(group, [&](std::string_view key) { return given.contains(key); });
    if (is_given)
        for (const std::string_view key : group) value.erase(std::string(key));
}

/// Merges the extras of `scene` with the members of render.json.
class ExtrasMerger {
  public:
    ExtrasMerger(RenderJson& json, ProblemList& problems) : json_(json), problems_(problems) {
        if (!json.document.empty()) document_ = parse_json(json.document, json.location);
    }

    void merge(const ExtrasDesc& extras) {
        std::optional<ExtrasJson> value = object_of(extras, problems_);
        if (!value) return;
        if (extras.of == ExtrasDesc::Of::Scene) {
            merge_scene(extras, *value);
            return;
        }
        if (extras.name.empty()) {
            problems_.warning(extras.location, "what these extras are of has no name, by which settings find it");
            return;
        }
        if (extras.of == ExtrasDesc::Of::Material)
            merge_into(json_.materials, "materials", extras, *value, read_material);
        else if (extras.of == ExtrasDesc::Of::Camera)
            merge_into(json_.cameras, "cameras", extras, *value, read_camera_change);
        else
            merge_into(json_.lights, "lights", extras, *value, read_light);
    }

  private:
    /// Merges the sections `cameras`, `environment`, `lights` and `materials`. Others cannot be used: the render's
    /// settings are fixed before the scene file is read.
    void merge_scene(const ExtrasDesc& extras, const ExtrasJson& sections) {
        for (const auto& [key, section] : sections.items()) {
            const SourceLocation where{extras.location.file, child_pointer(extras.location.pointer, key)};
            if (key == "environment")
                merge_environment(section, where);
            else if (key == "cameras")
                merge_section(ExtrasDesc::Of::Camera, section, where);
            else if (key == "lights")
                merge_section(ExtrasDesc::Of::Light, section, where);
            else if (key == "materials")
                merge_section(ExtrasDesc::Of::Material, section, where);
            else
                problems_.warning(where,
                                  "is not read here: it belongs in render.json; a scene's extras may have "
                                  "cameras, environment, lights and materials");
        }
    }
    void merge_section(ExtrasDesc::Of of, const ExtrasJson& section, const SourceLocation& where) {
        if (!section.is_object()) {
            problems_.warning(where, fmt::format("must be an object, but is {}", json_kind(section)));
            return;
        }
        for (const auto& [name, said] : section.items())
            merge({of, name, said.dump(), {where.file, child_pointer(where.pointer, name)}});
    }
    void merge_environment(const ExtrasJson& said, const SourceLocation& where) {
        std::optional<ExtrasJson> value = object_of({ExtrasDesc::Of::Scene, {}, said.dump(), where}, problems_);
        if (!value) return;
        const auto try_reading = [&](const ExtrasJson& what, ProblemList& found) {
            static_cast<void>(read_environment(what, where, found));
        };
        if (!leave_out_wrong(*value, where, try_reading, problems_)) return;
        ProblemList known;  // already reported when the parts were read
        const auto given = document_.find("environment");
        if (given == document_.end()) {
            json_.environment = read_environment(*value, where, known);
        } else if (given->is_object() && json_.environment) {
            // An image that is missing is a mistake of whoever names it.
            const SourceLocation at = given->contains("image") ? json_.environment->location : where;
            value->update(*given);
            json_.environment = read_environment(*value, at, known);
        }
    }

    template <typename Override, typename Read>
    void merge_into(std::map<std::string, Override>& overrides, const char* section, const ExtrasDesc& extras,
                    ExtrasJson& value, const Read& read) {
        const auto try_reading = [&](const ExtrasJson& what, ProblemList& found) {
            static_cast<void>(read(what, extras.location, found));
        };
        ExtrasJson& known = known_[section][extras.name];
        if (!leave_out_wrong(value, extras.location, try_reading, problems_)) return;
        // Of what shares a name, the last goes first.
        if (known.is_object()) {
            yield_to(value, kExtraStrengths, known);
            yield_to(value, kExtraPlaces, known);
            known.update(value);
            value = known;
        } else {
            known = value;
        }
        const auto of_section = document_.find(section);
        const ExtrasJson* given = nullptr;
        if (of_section != document_.end() && of_section->is_object())
            if (const auto found = of_section->find(extras.name); found != of_section->end()) given = &*found;
        if (given == nullptr) {
            ProblemList none;
            Override change = read(value, extras.location, none);
            change.is_from_extras = true;
            overrides[extras.name] = change;
            return;
        }
        if (!given->is_object()) return;  // that has been said
        yield_to(*given, kExtraStrengths, value);
        yield_to(*given, kExtraPlaces, value);
        value.update(*given);
        ProblemList found;
        Override change = read(value, overrides.at(extras.name).location, found);
        if (found.has_errors())
            problems_.warning(extras.location, fmt::format("does not go with what render.json says of '{}', and is "
                                                           "ignored",
                                                           shown(extras.name)));
        else
            overrides[extras.name] = change;
    }

    RenderJson& json_;
    ProblemList& problems_;
    ExtrasJson document_ = ExtrasJson::object();
    std::map<std::string, std::map<std::string, ExtrasJson>> known_;  ///< extras so far, by section and name
};

}  // namespace

RenderJson with_extras(RenderJson json, const SceneDesc& scene, ProblemList& problems) {
    ExtrasMerger merger(json, problems);
    for (const ExtrasDesc& extras : scene.extras) merger.merge(extras);
    return json;
}

}  // namespace etendue
