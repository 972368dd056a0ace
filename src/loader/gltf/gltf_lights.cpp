#include "loader/gltf/gltf_lights.h"

#include "core/shown_text.h"
#include "loader/files.h"
#include "loader/gltf/gltf_buffers.h"
#include "loader/gltf/gltf_value.h"
#include "loader/ies/ies_file.h"
#include "loader/json_text.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr const char* kPunctual = "KHR_lights_punctual";
constexpr const char* kMeasured = "EXT_lights_ies";

constexpr double kWidestCone = 0.5 * std::numbers::pi;

/// Returns whether a spot's cone may have that `angle`, as single precision has it.
bool is_cone(double angle) {
    constexpr double kRounding = 1e-6;
    return angle >= 0.0 && angle <= kWidestCone + kRounding;
}

float clamp_cone(double angle) {
    return static_cast<float>(std::clamp(angle, 0.0, kWidestCone));
}

std::string text_or_empty(const tinygltf::Value& object, const std::string& key) {
    return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>() : std::string();
}

}  // namespace

LightReader::LightReader(const GltfDocument& document, AccessorReader& accessors, SceneDesc& scene,
                         ProblemList& problems)
    : document_(document), accessors_(accessors), scene_(scene), problems_(problems) {}

bool LightReader::has_light(const tinygltf::Node& node) {
    return find_extension(node.extensions, kPunctual) != nullptr ||
           find_extension(node.extensions, kMeasured) != nullptr;
}

std::size_t LightReader::longest_name(const GltfDocument& document) {
    std::size_t longest = 0;
    for (const tinygltf::Light& light : document.model.lights) longest = std::max(longest, light.name.size());
    const tinygltf::Value* measured = find_extension(document.model.extensions, kMeasured);
    if (measured == nullptr) return longest;
    for_each_element(*measured, "lights", [&](const tinygltf::Value& light) {
        longest = std::max(longest, text_or_empty(light, "name").size());
    });
    return longest;
}

void LightReader::place(const tinygltf::Node& node, const Mat4f& to_world, const SourceLocation& where) {
    if (const tinygltf::Value* light = find_extension(node.extensions, kPunctual))
        place_punctual(node, static_cast<std::size_t>(integer_or(*light, "light", 0)), to_world);
    if (const tinygltf::Value* light = find_extension(node.extensions, kMeasured))
        place_measured(node, *light, to_world, where);
}

void LightReader::place_punctual(const tinygltf::Node& node, std::size_t index, const Mat4f& to_world) {
    const tinygltf::Light& source = document_.model.lights[index];
    LightDesc& light = scene_.lights.emplace_back();
    light.name = source.name.empty() ? node.name : source.name;
    light.node = node.name;
    // The document's shape allows these names alone.
    const auto* const type = std::ranges::find(kLightTypeNames, source.type);
    light.type = static_cast<LightType>(type - kLightTypeNames.begin());
    if (source.color.size() == 3) {
        light.color = {static_cast<float>(source.color[0]), static_cast<float>(source.color[1]),
                       static_cast<float>(source.color[2])};
    }
    light.intensity = static_cast<float>(source.intensity);
    const tinygltf::SpotLight& spot = source.spot;
    light.inner_cone_angle = clamp_cone(spot.innerConeAngle);
    light.outer_cone_angle = clamp_cone(spot.outerConeAngle);
    light.to_world = to_world;
    light.location = document_.at(fmt::format("/extensions/KHR_lights_punctual/lights/{}", index));
    if (light.type != LightType::Spot) return;
    const bool is_first = seen_spots_.insert(index).second;
    if (is_first && !(is_cone(spot.innerConeAngle) && is_cone(spot.outerConeAngle)))
        problems_.warning(light.location,
                          fmt::format("the spot's cone angles of {:.4g} and {:.4g} are not in [0, pi/2] and are moved "
                                      "to its ends",
                                      spot.innerConeAngle, spot.outerConeAngle));
    const bool is_closed = light.outer_cone_angle == 0.0f;
    // Exporters write single precision, also of the default for the outer cone, which is not.
    const bool has_ramp = spot.innerConeAngle != spot.outerConeAngle;
    if (!is_closed && has_ramp && light.inner_cone_angle <= light.outer_cone_angle) return;
    if (is_first)
        problems_.warning(
            light.location,
            is_closed ? "the spot's outer cone has the angle 0, so that it lights nothing: it is left out"
                      : fmt::format("the spot's inner cone of {:.4g} should be narrower than the outer one of {:.4g}: "
                                    "the light ends at a hard edge",
                                    light.inner_cone_angle, light.outer_cone_angle));
    light.inner_cone_angle = light.outer_cone_angle;
    if (is_closed) scene_.lights.pop_back();
}

void LightReader::place_measured(const tinygltf::Node& node, const tinygltf::Value& extension, const Mat4f& to_world,
                                 const SourceLocation& where) {
    const int index = integer_or(extension, "light", 0);
    LightDesc light;
    light.profile = profile(index);
    if (!light.profile) return;
    const std::string& name = scene_.ies_profiles[static_cast<std::size_t>(light.profile.index)].name;
    light.name = name.empty() ? node.name : name;
    light.node = node.name;
    // The extension clamps colours, which are factors, to one.
    const auto channel = [&](int c) {
        return static_cast<float>(std::clamp(element_or(extension, "color", c, 1.0), 0.0, 1.0));
    };
    light.color = {channel(0), channel(1), channel(2)};
    light.intensity = static_cast<float>(number_or(extension, "multiplier", 1.0));
    light.to_world = to_world;
    light.location = where;
    scene_.lights.push_back(std::move(light));
}

Handle<IesProfileDesc> LightReader::profile(int index) {
    const auto [entry, is_new] = profiles_.try_emplace(index);
    if (is_new) {
        const tinygltf::Value& lights = document_.model.extensions.at(kMeasured).Get("lights");
        entry->second =
            read_profile(lights.Get(index), document_.at(fmt::format("/extensions/{}/lights/{}", kMeasured, index)));
    }
    return entry->second;
}

Handle<IesProfileDesc> LightReader::read_profile(const tinygltf::Value& source, const SourceLocation& where) {
    try {
        const std::vector<unsigned char> bytes = profile_bytes(source, where);
        // Undoing the symmetries quadruples what is at least two characters and becomes four bytes.
        if (bytes.empty() || !accessors_.allocate(bytes.size(), 8, where)) return {};
        scene_.ies_profiles.push_back(parse_ies({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                                text_or_empty(source, "name"), where));
        return {static_cast<std::int32_t>(scene_.ies_profiles.size()) - 1};
    } catch (const IoError& error) {
        problems_.error(where, fmt::format("'{}': {}", shown(text_or_empty(source, "uri")), error.what()));
    } catch (const SceneError& error) {
        for (const Problem& problem : error.problems().all()) problems_.add(problem);
    }
    return {};
}

/// Empty after errors, which have been reported.
std::vector<unsigned char> LightReader::profile_bytes(const tinygltf::Value& source, const SourceLocation& where) {
    const std::string uri = text_or_empty(source, "uri");
    if (uri.empty() != source.Has("bufferView")) {
        problems_.error(where, "a light profile needs either a URI or a buffer view");
        return {};
    }
    if (uri.empty()) {
        const auto view = accessors_.copyable_view(integer_or(source, "bufferView", -1), where);
        if (view && view->empty()) throw SceneError(where, "the buffer view is empty");
        return view ? std::vector<unsigned char>(view->begin(), view->end()) : std::vector<unsigned char>();
    }
    if (is_data_uri(uri)) {
        std::optional<std::vector<unsigned char>> bytes = decode_data_uri(uri);
        if (!bytes) throw SceneError(where, "the data URI is empty or not base64");
        return std::move(*bytes);
    }
    const std::filesystem::path file = resolve_uri(document_.directory, uri);
    std::vector<unsigned char> bytes = read_bytes(file, kMaxIesBytes);
    if (bytes.empty()) throw IoError("the file is empty");
    if (std::ranges::find(scene_.inputs, file) == scene_.inputs.end()) scene_.inputs.push_back(file);
    return bytes;
}

}  // namespace etendue
