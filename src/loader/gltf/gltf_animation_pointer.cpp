#include "loader/gltf/gltf_animation_pointer.h"

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

const ShapeField* find_field(const Shape& shape, const std::string& key) {
    for (std::size_t i = 0; i < shape.field_count; ++i)
        if (shape.fields[i].key == key) return &shape.fields[i];
    return nullptr;
}

/// What must stand where the pointer leads; null if that is no place that `document` has or could have.
const Shape* find_shape(const Json& document, const std::vector<std::string>& tokens) {
    constexpr std::array kRoots{"materials", "cameras", "extensions"};
    if (tokens.empty() || std::ranges::find(kRoots, tokens.front()) == kRoots.end()) return nullptr;
    const Shape* shape = &gltf_shape();
    const Json* place = &document;  // null below what is not there and has its default
    for (const std::string& token : tokens) {
        if (shape->kind == Shape::Kind::Array) {
            const std::optional<std::size_t> index = to_index(token);
            if (!index || place == nullptr || *index >= place->size()) return nullptr;
            shape = shape->element;
            place = &(*place)[*index];
            continue;
        }
        const ShapeField* field = shape->kind == Shape::Kind::Object ? find_field(*shape, token) : nullptr;
        if (field == nullptr) return nullptr;
        shape = &field->shape;
        place = place != nullptr && place->contains(token) ? &(*place)[token] : nullptr;
    }
    return shape;
}

/// Weights of the morph targets of `mesh`: all if `tokens`, which lead on from "weights", are none, else one. False if
/// it has no such targets, or the value does not fit.
bool write_weights(std::span<const std::string> tokens, const std::vector<double>& numbers, const tinygltf::Mesh& mesh,
                   std::vector<double>& weights) {
    const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
    if (tokens.empty()) {
        if (numbers.size() != targets || targets == 0) return false;
        weights = numbers;
        return true;
    }
    const std::optional<std::size_t> target = to_index(tokens.front());
    if (tokens.size() != 1 || numbers.size() != 1 || !target || *target >= targets) return false;
    if (weights.empty()) weights = mesh.weights;
    weights.resize(targets);
    weights[*target] = numbers.front();
    return true;
}

/// Values that are not in the JSON that is read again: whether nodes are visible, and weights of morph targets. False
/// if the pointer leads to none of these, or the value does not fit.
bool write_to_model(const PointerValue& value, tinygltf::Model& model) {
    const std::vector<std::string> tokens = split_pointer(value.pointer);
    const std::optional<std::size_t> index = tokens.size() > 2 ? to_index(tokens[1]) : std::nullopt;
    if (!index) return false;
    const bool is_weight = tokens[2] == "weights";
    const auto rest = std::span(tokens).subspan(3);
    if (tokens[0] == "meshes" && *index < model.meshes.size() && is_weight) {
        tinygltf::Mesh& mesh = model.meshes[*index];
        return write_weights(rest, value.numbers, mesh, mesh.weights);
    }
    if (tokens[0] != "nodes" || *index >= model.nodes.size()) return false;
    tinygltf::Node& node = model.nodes[*index];
    if (is_weight && node.mesh >= 0)
        return write_weights(rest, value.numbers, model.meshes[static_cast<std::size_t>(node.mesh)], node.weights);
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
    const std::vector<double>& numbers = value.numbers;
    const bool is_number = shape->kind == Shape::Kind::Number && numbers.size() == 1;
    const bool is_list = shape->kind == Shape::Kind::Array && shape->element->kind == Shape::Kind::Number &&
                         numbers.size() >= shape->min_length && numbers.size() <= shape->max_length;
    if (!is_number && !is_list) return false;
    Json& place = document[Json::json_pointer(value.pointer)];
    if (is_number) {
        place = std::clamp(numbers[0], shape->min, shape->max);
        return true;
    }
    place = Json::array();
    for (const double number : numbers) place.push_back(std::clamp(number, shape->element->min, shape->element->max));
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
        if (!write_to_model(value, document.model) && !write_value(value, json))
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

}  // namespace etendue
