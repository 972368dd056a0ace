// What a layer can be made of, by the names that render.json and --aov have for it. To add a layer of light or of first
// hits, see CONTRIBUTING.md (Smaller things).
#pragma once

#include "picture/matte_names.h"
#include "scene/scene_desc.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Describes sources that are neither expressions nor values of first hits.
struct OtherSource {
    std::string_view name;
    std::string_view summary;
};

/// Describes a Cryptomatte: by what its ids are told apart, and the layer that it is unless named otherwise.
struct MatteSource {
    std::string_view name;
    std::string_view layer;
    std::string_view summary;
    std::vector<std::string> (*names)(const SceneDesc&);
    bool by_material;
};

namespace aov_source {

inline constexpr std::string_view kExpression = "lpe:";
inline constexpr std::string_view kLight = "light:";

inline constexpr OtherSource kSamples{"samples", "samples of each pixel"};
inline constexpr OtherSource kVariance{"variance", "variance of each pixel's mean, as if its samples were independent"};
inline constexpr OtherSource kRays{"rays", "rays per sample of each pixel"};
inline constexpr OtherSource kMean{"mean", "mean of the samples, which the image is without --robust"};
inline constexpr OtherSource kRemoved{"clamped", "light that --clamp-indirect took away"};
inline constexpr OtherSource kDeep{"deep", "a deep image, IMAGE.deep.exr, as --deep writes it"};
// They stand for several layers.
inline constexpr OtherSource kPasses{"passes", "the light in ten layers that add up to the image"};
inline constexpr OtherSource kLights{"lights", "the light of each lamp, emitting object and the environment, by name"};
inline constexpr OtherSource kDenoising{"denoising",
                                        "what 'etendue denoise' needs: albedo, N, depth, and half of the samples"};

inline constexpr std::array kMattes{
    MatteSource{"cryptomatte_object", "CryptoObject", "ids of objects and their coverage, by Cryptomatte", object_names,
                false},
    MatteSource{"cryptomatte_material", "CryptoMaterial", "the same of materials", material_names, true},
    MatteSource{"cryptomatte_asset", "CryptoAsset", "the same of the topmost nodes", asset_names, false},
};
inline constexpr OtherSource kCryptomatte{
    "cryptomatte", "the three that follow; :RANKS behind one of them for another number of ids a pixel than 6"};

}  // namespace aov_source

/// Returns the names of all sources, for hints.
[[nodiscard]] std::vector<std::string_view> aov_source_names();

/// Returns all sources with what they are, a line each, for --help.
[[nodiscard]] std::string list_aov_sources();

}  // namespace etendue
