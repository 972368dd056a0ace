#include "loader/settings/apply_lights.h"

#include "core/shown_text.h"
#include "image/read.h"
#include "loader/files.h"
#include "loader/ies/ies_file.h"
#include "loader/json_text.h"
#include "loader/settings/json_object.h"
#include "loader/settings/known_names.h"
#include "loader/settings/lamp_surface.h"
#include "scene/transform.h"
#include "scene/validate_parts.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Reads each IES file once, however many lights name it.
class ProfileFiles {
  public:
    ProfileFiles(SceneDesc& scene, ProblemList& problems) : scene_(scene), problems_(problems) {}

    /// The profile in the file `name`; an invalid handle, reported at `where` with this severity, if it cannot be used.
    Handle<IesProfileDesc> profile(const std::string& name, const SourceLocation& where, Severity severity) {
        const auto [entry, is_new] = handles_.try_emplace(name);
        if (is_new) entry->second = read(name, where, severity);
        return entry->second;
    }

  private:
    Handle<IesProfileDesc> read(const std::string& name, const SourceLocation& where, Severity severity) {
        try {
            const std::filesystem::path file = resolve_name(scene_.directory, name);
            // One file may be named in several ways: "a.ies" and "./a.ies".
            if (const auto known = by_file_.find(file.string()); known != by_file_.end()) return known->second;
            const std::vector<unsigned char> bytes = read_bytes(file, kMaxIesBytes);
            scene_.ies_profiles.push_back(
                parse_ies({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, {file.string(), {}}));
            scene_.inputs.push_back(file);
            return by_file_[file.string()] = {static_cast<std::int32_t>(scene_.ies_profiles.size()) - 1};
        } catch (const IoError& error) {
            problems_.add({severity, where, fmt::format("'{}': {}", shown(name), error.what())});
        } catch (const SceneError& error) {
            for (Problem problem : error.problems().all()) {
                problem.severity = std::min(problem.severity, severity);
                problems_.add(std::move(problem));
            }
        }
        return {};
    }

    SceneDesc& scene_;
    ProblemList& problems_;
    std::map<std::string, Handle<IesProfileDesc>> handles_;
    std::map<std::string, Handle<IesProfileDesc>> by_file_;
};

/// Returns how many units of lamps (candela, lux) make one of the image.
float lamp_units(const SceneDesc& scene) {
    return scene.settings.light_units == LightUnits::Radiometric ? kLumensPerWatt : 1.0f;
}

constexpr float kFullSphere = 4.0f * kPi;

/// Gives `light` the colour, the profile and the strength of `change`.
void apply_strength(const LightOverride& change, Handle<IesProfileDesc> profile, const SceneDesc& scene,
                    LightDesc& light) {
    light.color = change.color.value_or(light.color);
    if (profile) {
        light.profile = profile;
        light.intensity = 1.0f;  // as measured
    }
    if (change.intensity) {
        // Of a lamp with a profile it is the peak's, if that is not dark anyway.
        const float peak =
            light.profile ? peak_candela(scene.ies_profiles[static_cast<std::size_t>(light.profile.index)]) : 1.0f;
        light.intensity = peak > 0.0f ? *change.intensity / peak : 0.0f;
    }
    if (change.power) light.intensity = *change.power / kFullSphere * lamp_units(scene);
    if (change.irradiance) light.intensity = *change.irradiance * lamp_units(scene);
    light.intensity *= change.scale;
}

/// Returns the surface of a lamp that has one of its own.
ShapeDesc shape_of(const LightOverride& lamp) {
    const Vec3f radius(lamp.radius.value_or(0.5f));
    if (lamp.kind == LampKind::Sphere) return {ShapeKind::Sphere, radius};
    const Vec3f half(0.5f * lamp.width.value_or(1.0f), 0.5f * lamp.height.value_or(1.0f), 1.0f);
    if (lamp.kind == LampKind::Rectangle) return {ShapeKind::Rectangle, half};
    return {ShapeKind::Disk, lamp.width ? half : radius};
}

/// Applies what the document says of lamps.
class LightChanges {
  public:
    LightChanges(SceneDesc& scene, ProblemList& problems)
        : scene_(scene),
          problems_(problems),
          files_(scene, problems),
          softening_(scene.lights.size()),
          known_lights_([this] { return names_of_lights(); }),
          known_nodes_([this] { return names_of(scene_.nodes); }) {
        for (const std::string_view name : node_names_of_lights(scene)) node_names_.emplace_back(name);
    }

    void apply(const std::map<std::string, LightOverride>& changes) {
        // What is said of one node comes after what is said of all that share its lamp.
        for (const bool of_lamps : {true, false})
            for (const auto& [name, change] : changes)
                if (!change.kind && is_of_lamp(name) == of_lamps) apply_to_those(name, change);
        std::vector<LampToAdd> added;
        for (const auto& [name, change] : changes)
            if (change.kind) prepare(name, change, added);
        remove_or_soften();
        for (const LampToAdd& lamp : added) add(lamp);
    }

  private:
    /// Says what becomes of a lamp of the file.
    struct Softening {
        bool is_left_out = false;
        float radius = 0.0f;
        bool visible_to_camera = true;
        bool stops_light = true;
        SourceLocation location;
    };

    /// A lamp of the document in one place.
    struct LampToAdd {
        const std::string* name;
        const LightOverride* lamp;
        Mat4f to_world{};
        std::uint32_t node = NodeDesc::kNone;
        TransformMotion motion{};
    };

    [[nodiscard]] static SourceLocation at(const LightOverride& change, std::string_view key) {
        return {change.location.file, child_pointer(change.location.pointer, key)};
    }

    /// Adds an error of `change`, which is a warning where the scene file's extras say it.
    void report(const LightOverride& change, const SourceLocation& where, std::string message) {
        ++reported_;
        problems_.add({severity_of(change), where, std::move(message)});
    }
    [[nodiscard]] static Severity severity_of(const LightOverride& change) {
        return change.is_from_extras ? Severity::Warning : Severity::Error;
    }

    [[nodiscard]] bool is_of_lamp(const std::string& name) const {
        return !name.empty() && std::ranges::find(scene_.lights, name, &LightDesc::name) != scene_.lights.end();
    }

    /// Returns the lamps of this name, or those whose nodes have it.
    [[nodiscard]] std::vector<std::size_t> lamps_of(const std::string& name) const {
        std::vector<std::size_t> found;
        const bool by_lamp = is_of_lamp(name);
        for (std::size_t i = 0; i < scene_.lights.size() && !name.empty(); ++i)
            if ((by_lamp ? scene_.lights[i].name : node_names_[i]) == name) found.push_back(i);
        return found;
    }

    [[nodiscard]] std::uint32_t node_of(const std::string& name) const {
        const auto found = std::ranges::find(scene_.nodes, name, &NodeDesc::name);
        return found == scene_.nodes.end() || name.empty() ? NodeDesc::kNone
                                                           : static_cast<std::uint32_t>(found - scene_.nodes.begin());
    }

    void report_unknown(const std::string& name, const LightOverride& change) {
        if (node_of(name) != NodeDesc::kNone) {
            report(change, change.location,
                   fmt::format("the node '{}' has no light: give it one by a \"type\"", shown(name)));
            return;
        }
        report(change, change.location,
               fmt::format("the scene has no light '{}'; {}", shown(name), known_lights_.hint(name, problems_)));
    }

    /// Returns the names of the lamps of the file and of their nodes, sorted.
    [[nodiscard]] std::vector<std::string_view> names_of_lights() const {
        std::set<std::string_view> names;
        for (const LightDesc& light : scene_.lights) names.insert(light.name);
        names.insert(node_names_.begin(), node_names_.end());
        names.erase(std::string_view());
        return {names.begin(), names.end()};
    }

    [[nodiscard]] Handle<IesProfileDesc> profile_of(const LightOverride& change) {
        return change.ies.empty() ? Handle<IesProfileDesc>{}
                                  : files_.profile(change.ies, at(change, "ies"), severity_of(change));
    }

    void apply_to_those(const std::string& name, const LightOverride& change) {
        const std::vector<std::size_t> lamps = lamps_of(name);
        if (lamps.empty()) return report_unknown(name, change);
        const Handle<IesProfileDesc> profile = profile_of(change);
        for (const std::size_t i : lamps) {
            LightDesc& light = scene_.lights[i];
            Softening& softening = softening_[i];
            softening.is_left_out = softening.is_left_out || !change.enabled;
            if (!fits(change, light)) continue;
            apply_strength(change, profile, scene_, light);
            light.angle = change.angle.value_or(light.angle);
            softening.radius = change.radius.value_or(softening.radius);
            softening.visible_to_camera = change.visible_to_camera.value_or(softening.visible_to_camera);
            softening.stops_light = change.stops_light.value_or(softening.stops_light);
            softening.location = change.location;
            if (softening.radius > 0.0f && light.profile)
                report(change, at(change, "radius"), "a light with an IES profile shines from a point");
            if (softening.radius > 0.0f) continue;
            if (change.visible_to_camera)
                report(change, at(change, "visible_to_camera"), "a light without a radius is never seen");
            if (change.stops_light)
                report(change, at(change, "stops_light"), "a light without a radius stops no other light");
        }
    }

    /// False, and an error, for what a lamp of the type of `light` does not have.
    bool fits(const LightOverride& change, const LightDesc& light) {
        const std::size_t before = reported_;
        const auto refuse = [&](bool is_said, std::string_view key, std::string_view why) {
            if (is_said) report(change, at(change, key), std::string(why));
        };
        if (light.type == LightType::Directional) {
            refuse(!change.ies.empty(), "ies",
                   "a directional light has no position from which an IES profile could shine");
            refuse(change.radius.has_value(), "radius", "a directional light has an angle, but no radius");
            refuse(change.power.has_value(), "power", "a directional light has an irradiance, but no power");
            refuse(change.visible_to_camera.has_value(), "visible_to_camera",
                   "a directional light is never seen directly");
            refuse(change.stops_light.has_value(), "stops_light", "a directional light stops no other light");
        } else {
            refuse(change.angle.has_value(), "angle", "a light at a point has a radius, but no angle");
            refuse(change.irradiance.has_value(), "irradiance", "a light at a point has a power, but no irradiance");
            refuse(change.power && light.profile, "power", "the IES profile says how strong the light is");
        }
        return reported_ == before;
    }

    /// Leaves out the lamps of the file whose place that of the document takes, and finds where that is.
    void prepare(const std::string& name, const LightOverride& lamp, std::vector<LampToAdd>& added) {
        const std::vector<std::size_t> replaced = lamps_of(name);
        for (const std::size_t i : replaced) softening_[i].is_left_out = true;
        if (!lamp.enabled) return;
        LampToAdd one{&name, &lamp};
        if (lamp.place.position) {
            one.to_world = placed(lamp.place, scene_.origin);
            added.push_back(one);
        } else if (lamp.place.node.empty() && !replaced.empty()) {
            for (const std::size_t i : replaced) {
                one.to_world = scene_.lights[i].to_world;
                one.node = node_of(scene_.lights[i].node);
                one.motion = scene_.lights[i].motion;
                added.push_back(one);
            }
        } else {
            const std::string& node = lamp.place.node.empty() ? name : lamp.place.node;
            one.node = node_of(node);
            if (one.node == NodeDesc::kNone) return report_unknown_node(node, lamp);
            one.to_world = scene_.nodes[one.node].to_world;
            one.motion = scene_.nodes[one.node].motion;
            added.push_back(one);
        }
    }

    void report_unknown_node(const std::string& name, const LightOverride& lamp) {
        const std::string hint = known_nodes_.hint(name, problems_);
        if (lamp.place.node.empty())
            report(lamp, lamp.location,
                   fmt::format("nothing says where the light is: give it a \"position\" or a \"node\", or the "
                               "name of one; {}",
                               hint));
        else
            report(lamp, at(lamp, "node"), fmt::format("the scene has no node '{}'; {}", shown(name), hint));
    }

    /// Returns the rigid parts of the steps of `motion`; `to_world` stands in for a step that has none.
    [[nodiscard]] static TransformMotion rigid_steps(TransformMotion motion, const Mat4f& to_world) {
        for (Mat4f& step : motion) step = rigid_part(step).value_or(to_world);
        return motion;
    }

    /// Puts surfaces in place of points that have a radius, and leaves out what is not wanted.
    void remove_or_soften() {
        for (std::size_t i = 0; i < softening_.size(); ++i) {
            const Softening& softening = softening_[i];
            if (softening.is_left_out || !(softening.radius > 0.0f)) continue;
            const LightDesc light = scene_.lights[i];
            add_soft(light, softening, node_of(light.node));
        }
        std::size_t next = 0;
        std::erase_if(scene_.lights, [&](const LightDesc&) {
            const Softening& softening = softening_[next++];
            return softening.is_left_out || softening.radius > 0.0f;
        });
    }

    /// Adds a sphere in place of a point, or a disk in place of a spot, with the intensity that `light` has.
    void add_soft(const LightDesc& light, const Softening& softening, std::uint32_t node) {
        const bool is_spot = light.type == LightType::Spot;
        SurfaceLamp lamp{.shape = {is_spot ? ShapeKind::Disk : ShapeKind::Sphere, Vec3f(softening.radius)},
                         .name = light.node.empty() ? light.name : light.node,
                         .data_name = light.name,
                         .node = node,
                         .to_world = light.to_world,
                         .motion = light.motion,
                         .color = light.color,
                         .visible_to_camera = softening.visible_to_camera,
                         .stops_light = softening.stops_light,
                         .location = softening.location};
        const auto area = static_cast<float>(lamp.shape.area(lamp.to_world));
        const float intensity = light.intensity / lamp_units(scene_);
        // Of a convex surface a quarter is seen from each side, in the mean over all.
        lamp.radiance = is_spot ? intensity / area : 4.0f * intensity / area;
        if (is_spot) {
            lamp.beam.kind = BeamDesc::Kind::Spot;
            lamp.beam.inner_cone_angle = light.inner_cone_angle;
            lamp.beam.outer_cone_angle = light.outer_cone_angle;
        }
        add_shining(lamp);
    }

    void add(const LampToAdd& added) {
        const LightOverride& lamp = *added.lamp;
        if (lamp.has_own_surface())
            add_surface(added);
        else
            add_punctual(added);
    }

    void add_punctual(const LampToAdd& added) {
        const LightOverride& lamp = *added.lamp;
        const std::optional<Mat4f> rigid = rigid_part(added.to_world);
        if (!rigid) {
            report(lamp, lamp.location, "the light's place is singular");
            return;
        }
        LightDesc light;
        light.name = *added.name;
        if (added.node != NodeDesc::kNone) light.node = scene_.nodes[added.node].name;
        light.type = lamp.kind == LampKind::Sun    ? LightType::Directional
                     : lamp.kind == LampKind::Spot ? LightType::Spot
                                                   : LightType::Point;
        light.inner_cone_angle = lamp.inner_cone_angle;
        light.outer_cone_angle = lamp.outer_cone_angle;
        light.angle = lamp.angle.value_or(0.0f);
        light.to_world = *rigid;
        light.motion = rigid_steps(added.motion, *rigid);
        light.location = lamp.location;
        apply_strength(lamp, profile_of(lamp), scene_, light);
        if (const float radius = lamp.radius.value_or(0.0f); radius > 0.0f)
            add_soft(light,
                     {.radius = radius,
                      .visible_to_camera = lamp.visible_to_camera.value_or(true),
                      .stops_light = lamp.stops_light.value_or(true),
                      .location = lamp.location},
                     added.node);
        else
            scene_.lights.push_back(std::move(light));
    }

    void add_surface(const LampToAdd& added) {
        const LightOverride& change = *added.lamp;
        SurfaceLamp lamp{.shape = shape_of(change),
                         .name = *added.name,
                         .data_name = *added.name,
                         .node = added.node,
                         .to_world = added.to_world,
                         .motion = added.motion,
                         .color = change.color.value_or(Rgb(1.0f)),
                         .visible_to_camera = change.visible_to_camera.value_or(true),
                         .stops_light = change.stops_light.value_or(true),
                         .location = change.location};
        const double area = lamp.shape.area(lamp.to_world);
        lamp.radiance =
            change.scale * change.radiance.value_or(change.power.value_or(0.0f) / (kPi * static_cast<float>(area)));
        if (change.spread < kPi) {
            lamp.beam.kind = BeamDesc::Kind::Panel;
            lamp.beam.spread = change.spread;
        }
        add_shining(lamp);
    }

    /// Adds `lamp` unless it is dark. A dark one must not be too large either: it may be dark for its size.
    void add_shining(const SurfaceLamp& lamp) {
        if (lamp.radiance > 0.0f && max_component(lamp.color) > 0.0f) return add_surface_lamp(lamp, scene_);
        SceneDesc alone;
        add_surface_lamp(lamp, alone);
        validate_extent(alone, problems_);
    }

    SceneDesc& scene_;
    ProblemList& problems_;
    ProfileFiles files_;
    std::vector<std::string> node_names_;  ///< by lamp, as `node_names_of_lights` has them
    std::vector<Softening> softening_;     ///< by lamp of the file
    KnownNames known_lights_;              ///< asked before lamps are added or removed
    KnownNames known_nodes_;
    std::size_t reported_ = 0;  ///< how often `report` was called
};

}  // namespace

void apply_lights(const std::map<std::string, LightOverride>& changes, SceneDesc& scene, ProblemList& problems) {
    LightChanges(scene, problems).apply(changes);
}

}  // namespace etendue
