#include "loader/gltf/gltf_document.h"

#include "core/shown_text.h"
#include "loader/files.h"
#include "loader/gltf/glb.h"
#include "loader/gltf/gltf_animation_pointer.h"
#include "loader/gltf/gltf_buffers.h"
#include "loader/gltf/gltf_draco.h"
#include "loader/gltf/gltf_extras.h"
#include "loader/gltf/gltf_meshopt.h"
#include "loader/gltf/gltf_rules.h"
#include "loader/gltf/gltf_shape.h"
#include "loader/gltf/repair_log.h"
#include "loader/json_text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// To support another extension, see CONTRIBUTING.md (Smaller things; A layer of glTF's material).
constexpr std::array<std::string_view, 28> kSupportedExtensions{
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_roughness",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_transform",
};

/// Metadata, and what belongs to interaction.
constexpr std::array<std::string_view, 3> kIrrelevantExtensions{
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_xmp_json_ld",
};

bool is_supported(std::string_view extension) {
    return std::ranges::binary_search(kSupportedExtensions, extension);
}

bool is_irrelevant(std::string_view extension) {
    return std::ranges::binary_search(kIrrelevantExtensions, extension);
}

void throw_if_errors(const ProblemList& problems) {
    if (problems.has_errors()) throw SceneError(problems);
}

/// The strings of a top-level array, if it is one; what else stands in it is the shape check's business.
std::vector<std::string> string_array(const Json& document, const char* key) {
    std::vector<std::string> result;
    if (!document.is_object() || !document.contains(key) || !document[key].is_array()) return result;
    for (const Json& element : document[key]) {
        if (element.is_string()) result.push_back(element.get<std::string>());
    }
    return result;
}

/// Comes before every other check: a file that needs an unknown extension need not look like plain glTF.
void check_extensions(const Json& document, GltfDocument& result, ProblemList& problems) {
    const std::vector<std::string> required = string_array(document, "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (is_supported(required[i]) || is_irrelevant(required[i])) continue;
        problems.error(result.at(child_pointer("/extensionsRequired", i)),
                       fmt::format("the file requires the extension {}, which is not supported", shown(required[i])));
    }
    throw_if_errors(problems);

    for (const std::string& used : string_array(document, "extensionsUsed")) {
        if (is_irrelevant(used)) continue;
        (is_supported(used) ? result.extensions_used : result.extensions_ignored).push_back(shown(used));
    }
    if (!result.extensions_ignored.empty()) {
        problems.warning(result.at("/extensionsUsed"),
                         fmt::format("extensions that are not supported and are ignored: {}",
                                     fmt::join(result.extensions_ignored, ", ")));
    }
}

void check_version(const Json& document, const GltfDocument& result, ProblemList& problems) {
    const std::string version = document["asset"]["version"].get<std::string>();
    const bool is_second = version.size() > 2 && version.starts_with("2.") &&
                           std::all_of(version.begin() + 2, version.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!is_second) {
        problems.error(result.at("/asset/version"), fmt::format("glTF {} is not supported, only 2.0", shown(version)));
    }
    const std::string least = document["asset"].value("minVersion", "2.0");
    if (least != "2.0") {
        problems.error(result.at("/asset/minVersion"),
                       fmt::format("the file needs glTF {}; 2.0 is what is supported", shown(least)));
    }
}

/// The index accessor of a primitive.
struct PrimitiveIndices {
    std::size_t mesh;
    std::size_t primitive;
    int accessor;
};

/// Takes the indices out of the document: tinygltf refuses accessors whose elements are all sparse, and says of none
/// where it is. Compressed primitives have their indices elsewhere, whatever accessor they name.
std::vector<PrimitiveIndices> take_indices(Json& document, const GltfDocument& result, ProblemList& problems) {
    std::vector<PrimitiveIndices> taken;
    if (!document.contains("meshes")) return taken;
    Json& meshes = document["meshes"];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        Json& primitives = meshes[m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            Json& primitive = primitives[p];
            if (!primitive.contains("indices")) continue;
            const auto index = primitive["indices"].get<std::size_t>();
            primitive.erase("indices");
            if (primitive.contains("extensions") && primitive["extensions"].contains(kDracoExtension)) continue;
            taken.push_back({m, p, static_cast<int>(index)});
            const Json& accessor = document["accessors"][index];
            if (accessor.contains("bufferView") || accessor.contains("sparse")) continue;
            problems.error(
                result.at(fmt::format("/meshes/{}/primitives/{}/indices", m, p)),
                fmt::format("accessor {} has no buffer view: indices that are all zero make no triangles", index));
        }
    }
    return taken;
}

/// Takes the strides of the buffer views out of the document, by view: tinygltf refuses those that are no multiple of 4
/// up to 252, and says of none where it is.
std::vector<std::size_t> take_strides(Json& document) {
    std::vector<std::size_t> taken;
    if (!document.contains("bufferViews")) return taken;
    for (Json& view : document["bufferViews"]) {
        taken.push_back(view.value("byteStride", std::size_t{0}));
        view.erase("byteStride");
    }
    return taken;
}

/// Gives spots that do not describe their cones a description without numbers: tinygltf refuses the file otherwise, and
/// does not say where.
void complete_spots(Json& document, const GltfDocument& result, ProblemList& problems) {
    const std::string pointer = "/extensions/KHR_lights_punctual/lights";
    if (!document.contains(Json::json_pointer(pointer))) return;
    Json& lights = document[Json::json_pointer(pointer)];
    RepairLog repairs;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        Json& light = lights[i];
        if (light["type"].get<std::string>() != "spot" || light.contains("spot")) continue;
        light["spot"] = Json::object();
        repairs.add(Repair::NoCones, 1, result.at(child_pointer(pointer, i)));
    }
    repairs.report(problems);
}

/// Takes the images out of the document: their pixels are decoded elsewhere, and tinygltf shall not touch their files.
void take_images(Json& document, GltfDocument& result, ProblemList& problems) {
    if (!document.contains("images")) return;
    const Json& images = document["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
        const Json& json = images[i];
        GltfImage image{json.value("name", ""), json.value("mimeType", ""), json.value("uri", ""), std::nullopt};
        if (json.contains("bufferView")) image.buffer_view = json["bufferView"].get<int>();
        if (image.buffer_view && !image.uri.empty())
            problems.warning(result.at(child_pointer("/images", i)),
                             "has both a URI and a buffer view; the buffer view is used");
        result.images.push_back(std::move(image));
    }
    document.erase("images");
}

std::uint64_t total_size(const GltfBuffers& buffers) {
    std::uint64_t size = 0;
    for (const auto& [name, content] : buffers) size += content.size();
    return size;
}

/// Lists the files of all images, even of images that nothing shows: no output may replace them.
void list_images(GltfDocument& result) {
    std::set<std::filesystem::path> listed;
    for (const GltfImage& image : result.images) {
        if (image.uri.empty() || is_data_uri(image.uri)) continue;
        try {
            listed.insert(resolve_uri(result.directory, image.uri));
        } catch (const IoError&) {
            // The code that reads the image reports what is wrong.
        }
    }
    result.images_of_file.assign(listed.begin(), listed.end());
}

/// Removes bounds of accessors that are no lists of numbers: some exporters write NaN as null.
void drop_bad_bounds(Json& document) {
    const auto accessors = document.find("accessors");
    if (accessors == document.end() || !accessors->is_array()) return;
    for (Json& accessor : *accessors)
        for (const char* const key : {"min", "max"}) {
            const auto bounds = accessor.is_object() ? accessor.find(key) : accessor.end();
            if (bounds == accessor.end()) continue;
            const auto is_number = [](const Json& value) { return value.is_number(); };
            if (!bounds->is_array() || !std::ranges::all_of(*bounds, is_number)) accessor.erase(bounds);
        }
}

/// Where a channel leads, without its sampler.
GltfAnimation::Channel read_target(const Json& target, std::size_t node_count) {
    const std::string path = target["path"].get<std::string>();
    const Json extensions = target.value("extensions", Json::object());
    if (path != "pointer" || !extensions.contains("KHR_animation_pointer"))
        return {0, target.value("node", -1), shown(path), {}};
    const std::string pointer = extensions["KHR_animation_pointer"]["pointer"].get<std::string>();
    return node_channel(pointer, node_count).value_or(GltfAnimation::Channel{0, -1, path, pointer});
}

GltfAnimation read_animation(const Json& json, std::string pointer, std::size_t node_count) {
    GltfAnimation animation{json.value("name", ""), std::move(pointer), {}, {}};
    for (const Json& sampler : json["samplers"]) {
        const std::string interpolation = sampler.value("interpolation", "LINEAR");
        animation.samplers.push_back({sampler["input"].get<int>(), sampler["output"].get<int>(),
                                      interpolation == "STEP"          ? Interpolation::Step
                                      : interpolation == "CUBICSPLINE" ? Interpolation::CubicSpline
                                                                       : Interpolation::Linear});
    }
    for (const Json& channel : json["channels"]) {
        animation.channels.push_back(read_target(channel["target"], node_count));
        animation.channels.back().sampler = channel["sampler"].get<std::size_t>();
    }
    return animation;
}

/// Takes animations and skins out of the document: they are simple, and tinygltf asks more of them than glTF does.
void take_animations_and_skins(Json& document, GltfDocument& result) {
    if (document.contains("animations")) {
        const Json& animations = document["animations"];
        const std::size_t node_count = document.contains("nodes") ? document["nodes"].size() : 0;
        for (std::size_t i = 0; i < animations.size(); ++i)
            result.animations.push_back(read_animation(animations[i], child_pointer("/animations", i), node_count));
        const bool has_pointers = std::ranges::any_of(result.animations, [](const GltfAnimation& animation) {
            return std::ranges::any_of(animation.channels, [](const auto& c) { return !c.pointer.empty(); });
        });
        if (has_pointers) result.animatable = animatable_json(document);
    }
    if (document.contains("skins")) {
        for (const Json& json : document["skins"]) {
            GltfSkin& skin = result.skins.emplace_back();
            skin.joints = json["joints"].get<std::vector<int>>();
            if (json.contains("inverseBindMatrices"))
                skin.inverse_bind_matrices = json["inverseBindMatrices"].get<int>();
        }
    }
    document.erase("animations");
    document.erase("skins");
    document.erase("extras");
}

/// Callbacks that serve the buffers which are already in memory and know no file. tinygltf 2.9 added one to the struct.
template <typename Callbacks>
Callbacks buffer_callbacks(GltfBuffers& buffers) {
    Callbacks callbacks{};
    callbacks.FileExists = [](const std::string& name, void* user) {
        return static_cast<GltfBuffers*>(user)->contains(name);
    };
    callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
        const auto found = static_cast<GltfBuffers*>(user)->find(name);
        if (found == static_cast<GltfBuffers*>(user)->end()) return false;
        *out = std::move(found->second);
        return true;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    if constexpr (requires { callbacks.GetFileSizeInBytes; }) {
        callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string& name, void* user) {
            const auto found = static_cast<GltfBuffers*>(user)->find(name);
            if (found == static_cast<GltfBuffers*>(user)->end()) return false;
            *size = found->second.size();
            return true;
        };
    }
    callbacks.user_data = &buffers;
    return callbacks;
}

/// Lifts tinygltf 2.9's limit on file sizes; ours has already been applied.
template <typename Loader>
void lift_size_limit(Loader& loader) {
    if constexpr (requires { loader.SetMaxExternalFileSize(std::size_t{}); }) {
        loader.SetMaxExternalFileSize(std::numeric_limits<std::size_t>::max());
    }
}

tinygltf::Model parse_model(const Json& document, GltfBuffers& buffers, const GltfDocument& result) {
    const std::string text = document.dump();
    if (text.size() > std::numeric_limits<unsigned int>::max()) throw SceneError(result.at(""), "the JSON is too long");

    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(buffer_callbacks<tinygltf::FsCallbacks>(buffers));
    loader.RemoveImageLoader();
    lift_size_limit(loader);

    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    bool loaded = false;
    try {
        loaded = loader.LoadASCIIFromString(&model, &errors, &warnings, text.data(),
                                            static_cast<unsigned int>(text.size()), "");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        errors += error.what();
    }
    if (loaded) return model;
    while (!errors.empty() && errors.back() == '\n') errors.pop_back();
    throw SceneError(result.at(""), "the glTF parser refuses the file: " + errors.substr(0, 500));
}

Json parse_file(const std::filesystem::path& file, std::vector<unsigned char>& bytes, const GltfDocument& result,
                std::optional<std::span<const unsigned char>>& bin) {
    try {
        bytes = read_bytes(file, kMaxBufferBytes);
    } catch (const IoError& error) {
        throw SceneError(result.at(""), error.what());
    }
    std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    if (is_glb(bytes) || lower_extension(file) == ".glb") {
        const GlbChunks chunks = split_glb(bytes, result.at(""));
        text = chunks.json;
        bin = chunks.bin;
    }
    if (text.size() > kMaxJsonBytes) {
        throw SceneError(result.at(""),
                         fmt::format("{} bytes of JSON are more than the limit of {}", text.size(), kMaxJsonBytes));
    }
    return parse_json(text, result.at(""));
}

}  // namespace

std::span<const std::string_view> supported_gltf_extensions() {
    return kSupportedExtensions;
}

std::span<const std::string_view> irrelevant_gltf_extensions() {
    return kIrrelevantExtensions;
}

GltfDocument read_gltf_document(const std::filesystem::path& file, ProblemList& problems) {
    GltfDocument result;
    result.directory = file.parent_path();
    result.file = file.string();
    result.inputs.push_back(file);

    std::vector<unsigned char> bytes;
    std::optional<std::span<const unsigned char>> bin;
    Json document = parse_file(file, bytes, result, bin);

    // A list of its own: what the caller has found before must not end this.
    ProblemList found;
    check_extensions(document, result, found);
    drop_bad_bounds(document);
    check_shape(document, gltf_shape(), result.at(""), found);
    throw_if_errors(found);
    check_version(document, result, found);
    check_rules(document, result.at(""), found);
    complete_spots(document, result, found);
    const std::vector<PrimitiveIndices> indices = take_indices(document, result, found);
    take_extras(document, result, found);
    take_animations_and_skins(document, result);
    GltfBuffers buffers = load_gltf_buffers(document, bin, result.directory, result.inputs, result.absent_buffers);
    result.budget = DecodeBudget(bytes.size() + total_size(buffers));
    bytes = {};
    expand_meshopt_views(document, buffers, result.absent_buffers, result.budget, result.at(""), found);
    take_images(document, result, found);
    list_images(result);
    throw_if_errors(found);

    const std::vector<std::size_t> strides = take_strides(document);
    result.model = parse_model(document, buffers, result);
    for (const PrimitiveIndices& taken : indices)
        result.model.meshes[taken.mesh].primitives[taken.primitive].indices = taken.accessor;
    for (std::size_t i = 0; i < strides.size(); ++i) result.model.bufferViews[i].byteStride = strides[i];
    for (const Problem& problem : found.all()) problems.add(problem);
    return result;
}

}  // namespace etendue
