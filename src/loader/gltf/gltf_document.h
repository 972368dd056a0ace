// A glTF file, parsed and checked, with its buffers in memory.
#pragma once

#include "core/error.h"
#include "loader/gltf/gltf_buffers.h"
#include "scene/scene_desc.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

namespace etendue {

/// Where the encoded pixels of one glTF image are.
struct GltfImage {
    std::string name;
    std::string mime_type;
    std::string uri;                 ///< as it stood in the file; empty if there is a buffer view
    std::optional<int> buffer_view;  ///< index; checked
};

enum class Interpolation { Linear, Step, CubicSpline };

/// An animation as it stands in the file; accessors are checked, samplers of channels are not.
struct GltfAnimation {
    struct Sampler {
        int input = -1;   ///< accessor of the keys' times
        int output = -1;  ///< accessor of their values
        Interpolation interpolation = Interpolation::Linear;
    };
    struct Channel {
        std::size_t sampler = 0;
        int node = -1;  ///< none: the target is an extension's
        std::string path;
        std::string pointer;  ///< KHR_animation_pointer: what is animated, if it is no node's
    };
    std::string name;
    std::string pointer;
    std::vector<Sampler> samplers;
    std::vector<Channel> channels;
};

struct GltfSkin {
    std::optional<int> inverse_bind_matrices;  ///< accessor; none for identities
    std::vector<int> joints;                   ///< nodes
};

/// Holds the text that the extras of one thing have under the name "etendue".
struct GltfExtras {
    ExtrasDesc::Of of = ExtrasDesc::Of::Node;
    std::size_t index = 0;  ///< index of the thing among those of its kind
    std::string json;
    std::string pointer;
};

struct GltfDocument {
    tinygltf::Model model;  ///< without images, animations and skins
    std::vector<GltfImage> images;
    std::vector<GltfAnimation> animations;
    std::vector<GltfSkin> skins;
    std::vector<GltfExtras> extras;
    std::string animatable;  ///< JSON of what animations point to; empty if none does
    std::filesystem::path directory;
    std::string file;                                   ///< for messages
    DecodeBudget budget{0};                             ///< what may be decoded besides what is in the model
    std::vector<std::string> extensions_used;           ///< and supported
    std::vector<std::string> extensions_ignored;        ///< used, not supported, not required
    std::vector<std::filesystem::path> inputs;          ///< the file and the buffers it names
    std::vector<std::filesystem::path> images_of_file;  ///< files of images, shown or not
    AbsentBuffers absent_buffers;

    [[nodiscard]] SourceLocation at(std::string pointer) const { return {file, std::move(pointer)}; }
};

/// The extensions that are read, sorted.
[[nodiscard]] std::span<const std::string_view> supported_gltf_extensions();

/// The extensions that no image depends on, sorted: nothing is said of them, and files may require them.
[[nodiscard]] std::span<const std::string_view> irrelevant_gltf_extensions();

/// Reads `file`, a .gltf or .glb, and the buffers it names inside its directory.
///
/// After it, every index in the model refers to something that exists and every value has the type and the range of the
/// specification's schema, but that lengths and counts may be 0; what the bytes say (indices, sizes of views,
/// coordinates) is not checked yet. Warnings go to `problems`, or all of them into the SceneError that is thrown if
/// there is an error.
[[nodiscard]] GltfDocument read_gltf_document(const std::filesystem::path& file, ProblemList& problems);

}  // namespace etendue
