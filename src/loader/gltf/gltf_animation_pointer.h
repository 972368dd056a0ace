// KHR_animation_pointer: animations of anything that the file's JSON says, by its JSON pointer.
//
// Pointers to what nodes animate anyway become ordinary channels. The others put their values into the JSON of
// materials, cameras and punctual lights, which is then checked and read again: those who read these see the values as
// if they had stood in the file. Measured lamps, environments, whether nodes are visible, and weights of morph targets
// that no ordinary channel animates go straight into the model. While the shutter is open they have their values in the
// middle of it.
#pragma once

#include "loader/gltf/gltf_animation.h"
#include "loader/gltf/gltf_document.h"

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// The channel to a node that `pointer` stands for: "/nodes/3/translation", and the same for rotation, scale and
/// weights. Nothing if it stands for something else.
[[nodiscard]] std::optional<GltfAnimation::Channel> node_channel(const std::string& pointer, std::size_t node_count);

/// The members of a checked glTF document that pointers can change, as text.
[[nodiscard]] std::string animatable_json(const nlohmann::json& document);

/// Puts `values` into the materials, cameras, lights, environments, nodes and meshes of `document`. Numbers are kept
/// within the ranges of the specification, which splines may leave. Warnings for pointers to what cannot be animated;
/// throws SceneError if the result is no valid document.
void apply_pointers(std::span<const PointerValue> values, GltfDocument& document, ProblemList& problems);

/// Makes the nodes visible whose visibility `values` animate.
void show_animated_nodes(std::span<const PointerValue> values, GltfDocument& document);

}  // namespace etendue
