// The steps of compile_world, one file each. Each reads the description and fills its part of the WorldData.
#pragma once

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "image/finite.h"
#include "image/read.h"
#include "scene/scene_desc.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

/// Returns where the bytes of `image` are.
[[nodiscard]] inline ImageSource source_of(const ImageDesc& image) {
    return image.path.empty() ? ImageSource(std::span<const std::byte>(image.encoded)) : ImageSource(image.path);
}

/// Says how a texture is used, which decides how it is decoded and averaged.
enum class TextureUse {
    Color,
    ColorByAlpha,  ///< colour that shows as far as its alpha says
    Data,
    NormalMap,
};

/// Hands out indices of textures and loads each once per use.
class TextureCompiler {
  public:
    TextureCompiler(const SceneDesc& scene) : scene_(scene) {}

    /// The slot for `ref`; invalid if `ref` is.
    [[nodiscard]] TextureSlot slot(const TextureRef& ref, TextureUse use);
    /// Makes the textures asked for: in memory if all of them fit into `budget` bytes, which is known from the images'
    /// headers, else through a cache of that size. If images cannot be read, nothing is made and nothing asked for any
    /// more, and it returns them, with a warning each. Throws SceneError if that is an error, or one takes too much
    /// memory.
    [[nodiscard]] std::vector<std::size_t> finish(std::uint64_t budget, const ThreadPool& threads, WorldData& data,
                                                  ProblemList& problems);
    /// Returns the bytes that the textures asked for take in memory. Throws SceneError if an image cannot be read.
    [[nodiscard]] std::uint64_t bytes_in_memory() const;

  private:
    using Request = std::pair<std::size_t, TextureUse>;  ///< texture of the scene, and its use
    /// A decoded texture, and what of its image was put right.
    struct Loaded {
        Texture texture;
        RepairedValues repaired;
        int whole_rows;  ///< before the first that is broken
    };
    [[nodiscard]] const ImageDesc& image_of(const Request& request) const;
    [[nodiscard]] ImageInfo info_of(const Request& request) const;
    /// Calls `step(i)` for each request, and returns the images that could not be read.
    template <typename Step>
    [[nodiscard]] std::vector<std::size_t> for_each_request(const ThreadPool& threads, ProblemList& problems,
                                                            const Step& step) const;
    void warn_of_cut_images(std::span<const std::uint8_t> is_cut, ProblemList& problems) const;
    [[nodiscard]] Loaded load(const Request& request, const ImageInfo& info) const;
    [[nodiscard]] std::vector<std::size_t> load_resident(std::span<const ImageInfo> infos, const ThreadPool& threads,
                                                         WorldData& data, ProblemList& problems);
    void open_cached(std::span<const ImageInfo> infos, std::uint64_t budget, WorldData& data,
                     ProblemList& problems) const;

    const SceneDesc& scene_;
    std::vector<Request> requests_;
    std::map<Request, std::size_t> index_of_;
    std::map<Request, Loaded> loaded_;  ///< by rounds that came to nothing
};

/// Materials and what fills their bodies, in place of those that are there. Needs the working space in `data`.
void compile_materials(const SceneDesc& scene, TextureCompiler& textures, WorldData& data);

/// Tells which materials mirror or refract without roughness, by the least of their textures; of textures that come
/// through a cache nothing is known, so that they may. Needs materials and textures in `data`.
void find_specular_materials(WorldData& data);

/// Returns what fills the closed surfaces of a material, if it has such.
[[nodiscard]] std::optional<Filling> compile_filling(const MaterialDesc& desc, const ColorMatrix& from_rec709);

/// Moves the meshes of `scene` into `data`: bakes those that are placed once and stay there, and copies of small ones
/// at all of their places, together at most `most_copied` triangles more; keeps the others for instancing. Needs the
/// materials in `data`, which say what needs tangents.
void compile_geometry(SceneDesc& scene, const ThreadPool& threads, std::size_t most_copied, WorldData& data);

/// Numbers the bodies by precedence, and warns of those that have holes or are inside out. Needs materials and geometry
/// in `data`.
void compile_bodies(const SceneDesc& scene, WorldData& data, ProblemList& problems);

/// The BVHs of all surfaces and of clear ones, and where surfaces touch: thin sheets are moved apart, the others are
/// for `Contacts`. Needs materials, geometry and bodies in `data`.
void build_bvh(const ThreadPool& threads, WorldData& data, ProblemList& problems);

/// The environment, which must be enabled; `problems` gets a warning of values that are no radiance. Throws SceneError
/// if an image cannot be decoded.
[[nodiscard]] Light compile_environment(const SceneDesc& scene, const ColorMatrix& from_rec709,
                                        const ThreadPool& threads, ProblemList& problems);

/// Emissive triangles that get an entry in a light's table, all instances together: at 76 bytes each, 1.2 GiB. What is
/// beyond is found by chance only, which is slower but not wrong.
inline constexpr std::size_t kMaxLightTriangles = std::size_t{1} << 24;

/// Punctual lights, emissive meshes of at most `most_triangles` and the environment. Needs materials, textures,
/// geometry and its contacts in `data`.
void compile_lights(const SceneDesc& scene, const ThreadPool& threads, WorldData& data, ProblemList& problems,
                    std::size_t most_triangles = kMaxLightTriangles);

/// Finds the surfaces that lamps at a point lie in. Needs lights and the BVH in `data`.
void find_planes_of_lamps(WorldData& data);

/// Puts a camera that stands in surfaces, and still, before them: on the side to which it looks.
void move_camera_off_surfaces(WorldData& data);

/// Throws SceneError if the camera that the settings name does not exist.
[[nodiscard]] Camera compile_camera(const SceneDesc& scene);
/// How that camera moves; empty if it stands still.
[[nodiscard]] TransformMotion compile_camera_motion(const SceneDesc& scene);

}  // namespace etendue
