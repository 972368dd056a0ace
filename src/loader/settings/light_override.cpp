#include "loader/settings/light_override.h"

#include "loader/settings/json_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::array<std::pair<std::string_view, LampKind>, 6> kLampKinds{{
    {"rectangle", LampKind::Rectangle},
    {"disk", LampKind::Disk},
    {"sphere", LampKind::Sphere},
    {"sun", LampKind::Sun},
    {"point", LampKind::Point},
    {"spot", LampKind::Spot},
}};

// Ends in single precision are a little beyond those of what the document may say.
constexpr NumberRange kSunAngle{.min = 0.0, .max = 3.141592};
constexpr NumberRange kSpread{.min = 0.0174532, .max = 3.1415928};
constexpr NumberRange kConeAngle{.min = 0.0, .max = 1.5707964};

/// Bits of a set of kinds; a change of a lamp of the file counts as one more.
constexpr unsigned bit(LampKind kind) {
    return 1u << static_cast<unsigned>(kind);
}
constexpr unsigned kChange = 1u << kLampKinds.size();
constexpr unsigned kFlat = bit(LampKind::Rectangle) | bit(LampKind::Disk);
constexpr unsigned kSurfaces = kFlat | bit(LampKind::Sphere);
constexpr unsigned kAtPoint = bit(LampKind::Point) | bit(LampKind::Spot);
constexpr unsigned kAdded = kChange - 1u;

/// Which lamps have a member.
struct LampMember {
    std::string_view key;
    unsigned kinds;
};
constexpr LampMember kLampMembers[] = {
    {"node", kAdded},
    {"position", kAdded},
    {"rotation", kAdded},
    {"look_at", kAdded},
    {"up", kAdded},
    {"intensity", kAtPoint | bit(LampKind::Sun) | kChange},
    {"power", kSurfaces | kAtPoint | kChange},
    {"irradiance", bit(LampKind::Sun) | kChange},
    {"radiance", kSurfaces},
    {"ies", kAtPoint | kChange},
    {"radius", bit(LampKind::Disk) | bit(LampKind::Sphere) | kAtPoint | kChange},
    {"width", kFlat},
    {"height", kFlat},
    {"angle", bit(LampKind::Sun) | kChange},
    {"spread", kFlat},
    {"inner_cone_angle", bit(LampKind::Spot)},
    {"outer_cone_angle", bit(LampKind::Spot)},
    {"visible_to_camera", kSurfaces | kAtPoint | kChange},
    {"stops_light", kSurfaces | kAtPoint | kChange},
};

constexpr std::string_view kStrengths[] = {"power", "irradiance", "radiance", "intensity"};

/// Reports members that lamps of this kind do not have.
void check_members(const LightOverride& light, JsonObject& object) {
    const unsigned kind = light.kind ? bit(*light.kind) : kChange;
    for (const LampMember& member : kLampMembers) {
        if (!object.has(member.key) || (member.kinds & kind) != 0) continue;
        if (light.kind)
            object.problems().error(
                object.at(member.key),
                fmt::format("a {} has no {}", kLampKinds[static_cast<std::size_t>(*light.kind)].first, member.key));
        else
            object.problems().error(object.at(member.key), "only a light with a \"type\" of its own has one");
    }
}

void check_strength(const LightOverride& light, JsonObject& object) {
    std::vector<std::string_view> said;
    for (const std::string_view key : kStrengths)
        if (object.has(key)) said.push_back(key);
    if (said.size() > 1)
        object.problems().error(object.at(said[1]), fmt::format("{} says the same: leave one of both out", said[0]));
    if (light.kind && said.empty() && light.ies.empty())
        object.problems().error(object.where(), light.has_own_surface() ? "must have a \"power\" or a \"radiance\""
                                                : light.kind == LampKind::Sun
                                                    ? "must have an \"irradiance\" or an \"intensity\""
                                                    : "must have a \"power\" or an \"intensity\"");
    if (!light.ies.empty() && light.power)
        object.problems().error(object.at("power"), "the IES profile says how strong the light is");
}

void check_size(const LightOverride& light, JsonObject& object) {
    const auto refuse = [&](std::string_view key, std::string_view why) {
        object.problems().error(object.at(key), std::string(why));
    };
    if (light.has_own_surface() && light.radius == 0.0f) refuse("radius", "must be above 0");
    if (light.kind == LampKind::Disk) {
        if (light.width && light.radius) refuse("width", "radius says the same: leave one of both out");
        if (light.width.has_value() != light.height.has_value())
            refuse(light.width ? "width" : "height", "an ellipse needs a width and a height");
    }
    if (light.radius.value_or(0.0f) > 0.0f && !light.ies.empty())
        refuse("radius", "a light with an IES profile shines from a point");
    const bool is_point = light.kind == LampKind::Point || light.kind == LampKind::Spot;
    if (is_point && light.visible_to_camera && !(light.radius.value_or(0.0f) > 0.0f))
        refuse("visible_to_camera", "a light without a radius is never seen");
    if (is_point && light.stops_light && !(light.radius.value_or(0.0f) > 0.0f))
        refuse("stops_light", "a light without a radius stops no other light");
    if (light.inner_cone_angle > light.outer_cone_angle || !(light.outer_cone_angle > 0.0f))
        refuse(object.has("outer_cone_angle") ? "outer_cone_angle" : "inner_cone_angle",
               "the outer cone must be above 0, and no narrower than the inner one");
}

}  // namespace

LightOverride read_light(const nlohmann::json& value, const SourceLocation& where, ProblemList& problems) {
    LightOverride light;
    light.location = where;
    JsonObject object(value, where, problems);
    if (LampKind kind{}; object.choice("type", kLampKinds, kind)) light.kind = kind;
    const auto number = [&](std::string_view key, const NumberRange& range, std::optional<float>& out) {
        if (float read = 0.0f; object.number(key, range, read)) out = read;
    };
    if (Rgb color; object.color("color", kNotNegative, color)) light.color = color;
    number("intensity", kNotNegative, light.intensity);
    number("power", kNotNegative, light.power);
    number("irradiance", kNotNegative, light.irradiance);
    number("radiance", kNotNegative, light.radiance);
    object.text("ies", light.ies);
    object.number("scale", kNotNegative, light.scale);
    number("radius", kNotNegative, light.radius);
    number("width", kPositive, light.width);
    number("height", kPositive, light.height);
    number("angle", kSunAngle, light.angle);
    object.number("spread", kSpread, light.spread);
    object.number("inner_cone_angle", kConeAngle, light.inner_cone_angle);
    object.number("outer_cone_angle", kConeAngle, light.outer_cone_angle);
    if (bool visible = true; object.boolean("visible_to_camera", visible)) light.visible_to_camera = visible;
    if (bool stops = true; object.boolean("stops_light", stops)) light.stops_light = stops;
    object.boolean("enabled", light.enabled);
    read_place(object, light.place);
    const std::size_t errors = problems.error_count();
    check_members(light, object);
    if (problems.error_count() == errors && (light.kind || !object.has("type"))) {
        check_strength(light, object);
        check_size(light, object);
    }
    object.finish();
    return light;
}

}  // namespace etendue
