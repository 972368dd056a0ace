#include "loader/gltf/gltf_animation_pointer.h"

#include "core/shown_text.h"
#include "loader/gltf/gltf_shape.h"
#include "loader/json_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

constexpr const char* kLights = "KHR_lights_punctual";
constexpr const char* kVisibility = "KHR_node_visibility";
constexpr const char* kMeasuredLights = "EXT_lights_ies";
constexpr const char* kEnvironments = "EXT_lights_image_based";

/// The tokens of a JSON pointer, unescaped (RFC 6901); empty if it is none.
std::vector<std::string> split_pointer(std::string_view pointer) {
    std::vector<std::string> tokens;
    if (!pointer.starts_with('/')) return tokens;
    for (std::size_t i = 0; i < pointer.size(); ++i) {
        const char next = i + 1 < pointer.size() ? pointer[i + 1] : '\0';
        if (pointer[i] == '/') {
            tokens.emplace_back();
        } else if (pointer[i] == '~' && (next == '0' || next == '1')) {
            tokens.back() += next == '0' ? '~' : '/';
            ++i;
        } else {
            tokens.back() += pointer[i];
        }
    }
    return tokens;
}

std::optional<std::size_t> to_index(const std::string& token) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), index);
    const bool has_leading_zero = token.size() > 1 && token.front() == '0';
    if (token.empty() || has_leading_zero || error != std::errc() || end != token.data() + token.size())
        return std::nullopt;
    return index;
}

/// Returns the shape that stands one step below `shape`: of any element of an array, or of the member `token` of an
/// object; null if no such member is known.
const Shape* step_down(const Shape& shape, const std::string& token) {
    if (shape.kind == Shape::Kind::Array) return shape.element;
    if (shape.kind != Shape::Kind::Object) return nullptr;
    const std::span fields(shape.fields, shape.field_count);
    const auto field = std::ranges::find(fields, token, &ShapeField::key);
    return field == fields.end() ? nullptr : &field->shape;
}

/// Returns the shape that stands where the pointer of these `tokens` leads; null if the pointer leads to no place in
/// materials, cameras or extensions that `document` has or could have.
const Shape* find_shape(const Json& document, const std::vector<std::string>& tokens) {
    constexpr std::array kRoots{"materials", "cameras", "extensions"};
    if (tokens.empty() || std::ranges::find(kRoots, tokens.front()) == kRoots.end()) return nullptr;
    const Shape* shape = &gltf_shape();
    const Json* place = &document;  // null below what is not there and has its default
    for (const std::string& token : tokens) {
        if (shape->kind == Shape::Kind::Array) {
            const std::optional<std::size_t> index = to_index(token);
            if (!index || place == nullptr || *index >= place->size()) return nullptr;
            place = &(*place)[*index];
        } else {
            place = place != nullptr && place->contains(token) ? &(*place)[token] : nullptr;
        }
        shape = step_down(*shape, token);
        if (shape == nullptr) return nullptr;
        // An object that is made for the value alone would lack members that it must have: the index of a texture.
        if (place == nullptr &&
            std::ranges::any_of(std::span(shape->fields, shape->field_count), &ShapeField::required))
            return nullptr;
    }
    return shape;
}

/// `numbers` as `shape` holds them, one or a list, each kept within its range. Nothing if it does not hold as many.
std::optional<std::vector<double>> fit_numbers(std::vector<double> numbers, const Shape& shape) {
    const bool is_list = shape.kind == Shape::Kind::Array;
    const Shape& element = is_list ? *shape.element : shape;
    const std::size_t least = is_list ? shape.min_length : 1;
    const std::size_t most = is_list ? shape.max_length : 1;
    if (element.kind != Shape::Kind::Number || numbers.size() < least || numbers.size() > most) return std::nullopt;
    for (double& number : numbers) number = std::clamp(number, element.min, element.max);
    return numbers;
}

/// The light whose member `tokens` lead to, among those that the model keeps as the extension has them: the measured
/// lamps of nodes, and environments. Null if there is none.
tinygltf::Value* find_light(const std::vector<std::string>& tokens, tinygltf::Model& model) {
    if (tokens.size() != 5) return nullptr;
    if (tokens[0] == "nodes" && tokens[2] == "extensions" && tokens[3] == kMeasuredLights) {
        const std::optional<std::size_t> node = to_index(tokens[1]);
        if (!node || *node >= model.nodes.size()) return nullptr;
        const auto lamp = model.nodes[*node].extensions.find(kMeasuredLights);
        return lamp == model.nodes[*node].extensions.end() ? nullptr : &lamp->second;
    }
    if (tokens[0] != "extensions" || tokens[1] != kEnvironments || tokens[2] != "lights") return nullptr;
    const auto environments = model.extensions.find(kEnvironments);
    const std::optional<std::size_t> index = to_index(tokens[3]);
    if (environments == model.extensions.end() || !index) return nullptr;
    auto& lights = environments->second.Get<tinygltf::Value::Object>().at("lights").Get<tinygltf::Value::Array>();
    return *index < lights.size() ? &lights[*index] : nullptr;
}

/// False if the member of `light` that `tokens` lead to is not known, or holds no such value.
bool write_to_light(const std::vector<std::string>& tokens, const std::vector<double>& numbers,
                    tinygltf::Value& light) {
    const Shape* shape = &gltf_shape();
    for (const std::string& token : tokens) {
        shape = step_down(*shape, token);
        if (shape == nullptr) return false;
    }
    const std::optional<std::vector<double>> fitted = fit_numbers(numbers, *shape);
    if (!fitted) return false;
    light.Get<tinygltf::Value::Object>()[tokens.back()] =
        shape->kind == Shape::Kind::Number ? tinygltf::Value(fitted->front())
                                           : tinygltf::Value(tinygltf::Value::Array(fitted->begin(), fitted->end()));
    return true;
}

/// Weights of the morph targets of `mesh`: all if `tokens`, which lead on from "weights", are none, else one. False if
/// it has no such targets, or the value does not fit. Throws SceneError if many weights are more than `budget` holds.
bool write_weights(std::span<const std::string> tokens, const PointerValue& value, const tinygltf::Mesh& mesh,
                   std::vector<double>& weights, DecodeBudget& budget) {
    const std::vector<double>& numbers = value.numbers;
    const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
    if (tokens.empty()) {
        if (numbers.size() != targets || targets == 0) return false;
        weights = numbers;
        return true;
    }
    const std::optional<std::size_t> target = to_index(tokens.front());
    if (tokens.size() != 1 || numbers.size() != 1 || !target || *target >= targets) return false;
    const std::size_t taken = std::max(targets, mesh.weights.size());
    if (weights.size() < targets && !budget.take(taken * sizeof(double)))
        throw SceneError(value.where, DecodeBudget::kExceeded);
    if (weights.empty()) weights = mesh.weights;
    weights.resize(targets);
    weights[*target] = numbers.front();
    return true;
}

/// Values that are not in the JSON that is read again: measured lamps, environments, whether nodes are visible, and
/// weights of morph targets. False if the pointer leads to none of these, or the value does not fit.
bool write_to_model(const PointerValue& value, GltfDocument& document) {
    tinygltf::Model& model = document.model;
    const std::vector<std::string> tokens = split_pointer(value.pointer);
    if (tinygltf::Value* light = find_light(tokens, model)) return write_to_light(tokens, value.numbers, *light);
    const std::optional<std::size_t> index = tokens.size() > 2 ? to_index(tokens[1]) : std::nullopt;
    if (!index) return false;
    const bool is_weight = tokens[2] == "weights";
    const auto rest = std::span(tokens).subspan(3);
    if (tokens[0] == "meshes" && *index < model.meshes.size() && is_weight) {
        tinygltf::Mesh& mesh = model.meshes[*index];
        return write_weights(rest, value, mesh, mesh.weights, document.budget);
    }
    if (tokens[0] != "nodes" || *index >= model.nodes.size()) return false;
    tinygltf::Node& node = model.nodes[*index];
    if (is_weight && node.mesh >= 0)
        return write_weights(rest, value, model.meshes[static_cast<std::size_t>(node.mesh)], node.weights,
                             document.budget);
    const bool is_visibility = tokens[2] == "extensions" && rest.size() == 2 && rest[0] == kVisibility;
    if (!is_visibility || rest[1] != "visible" || value.numbers.size() != 1) return false;
    node.extensions[kVisibility] =
        tinygltf::Value(tinygltf::Value::Object{{"visible", tinygltf::Value(value.numbers.front() != 0.0)}});
    return true;
}

/// False if the pointer leads to nothing that holds such a value.
bool write_value(const PointerValue& value, Json& document) {
    const Shape* shape = find_shape(document, split_pointer(value.pointer));
    if (shape == nullptr) return false;
    const std::optional<std::vector<double>> fitted = fit_numbers(value.numbers, *shape);
    if (!fitted) return false;
    document[Json::json_pointer(value.pointer)] =
        shape->kind == Shape::Kind::Number ? Json(fitted->front()) : Json(*fitted);
    return true;
}

}  // namespace

std::optional<GltfAnimation::Channel> node_channel(const std::string& pointer, std::size_t node_count) {
    const std::vector<std::string> tokens = split_pointer(pointer);
    constexpr std::array kPaths{"translation", "rotation", "scale", "weights"};
    if (tokens.size() != 3 || tokens[0] != "nodes" || std::ranges::find(kPaths, tokens[2]) == kPaths.end())
        return std::nullopt;
    const std::optional<std::size_t> node = to_index(tokens[1]);
    if (!node || *node >= node_count) return std::nullopt;
    return GltfAnimation::Channel{0, static_cast<int>(*node), tokens[2], {}};
}

std::string animatable_json(const Json& document) {
    Json reduced = Json::object();
    for (const char* member : {"asset", "extensionsUsed", "materials", "cameras"})
        if (document.contains(member)) reduced[member] = document[member];
    // Other extensions of the root refer to what is not here.
    if (document.contains("extensions") && document["extensions"].contains(kLights))
        reduced["extensions"][kLights] = document["extensions"][kLights];
    // Only how many textures there are counts: materials refer to them.
    if (document.contains("textures")) reduced["textures"] = Json(document["textures"].size(), Json::object());
    return reduced.dump();
}

void apply_pointers(std::span<const PointerValue> values, GltfDocument& document, ProblemList& problems) {
    if (values.empty()) return;
    Json json = parse_json(document.animatable, document.at(""));
    for (const PointerValue& value : values)
        if (!write_to_model(value, document) && !write_value(value, json))
            problems.warning(value.where, fmt::format("'{}' cannot be animated with {} numbers; the channel is ignored",
                                                      shown(value.pointer), value.numbers.size()));
    ProblemList found;
    check_shape(json, gltf_shape(), document.at(""), found);
    if (found.has_errors()) throw SceneError(found);

    const std::string text = json.dump();
    tinygltf::TinyGLTF loader;
    loader.RemoveImageLoader();
    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    if (!loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(), static_cast<unsigned int>(text.size()),
                                    ""))
        throw SceneError(document.at("/animations"), "the animated document cannot be read: " + errors.substr(0, 500));
    document.model.materials = std::move(model.materials);
    document.model.cameras = std::move(model.cameras);
    document.model.lights = std::move(model.lights);
}

void show_animated_nodes(std::span<const PointerValue> values, GltfDocument& document) {
    for (const PointerValue& value : values) {
        const std::vector<std::string> tokens = split_pointer(value.pointer);
        if (tokens.size() != 5 || tokens[0] != "nodes" || tokens[3] != kVisibility) continue;
        const std::optional<std::size_t> index = to_index(tokens[1]);
        if (index && *index < document.model.nodes.size()) document.model.nodes[*index].extensions.erase(kVisibility);
    }
}

}  // namespace etendue
