#include "world/compile.h"

#include "core/byte_size.h"
#include "core/process_time.h"
#include "core/xyz.h"
#include "world/compile_parts.h"
#include "world/embree_scene.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

namespace {

XyzToWorking xyz_to_working(const ColorMatrix& from_rec709) {
    XyzToWorking rows;
    for (std::size_t r = 0; r < 3; ++r) {
        const auto element = [&](std::size_t c) {
            double sum = 0.0;
            for (std::size_t k = 0; k < 3; ++k)
                sum += static_cast<double>(from_rec709.m[3 * r + k]) * kXyzToRec709[k][c];
            return static_cast<float>(sum);
        };
        rows[r] = {element(0), element(1), element(2)};
    }
    return rows;
}

std::uint64_t texture_budget(const SceneDesc& scene) {
    return scene.settings.texture_memory.value_or(default_texture_memory());
}

/// Makes the textures that materials ask for, and again the materials if some do without.
void compile_textures(SceneDesc& scene, TextureCompiler& textures, const ThreadPool& threads, WorldData& data,
                      ProblemList& problems) {
    const std::uint64_t budget = texture_budget(scene);
    for (;;) {
        const std::vector<std::size_t> unreadable = textures.finish(budget, threads, data, problems);
        if (unreadable.empty()) break;
        for (const std::size_t image : unreadable) scene.images[image].unreadable = true;
        leave_out_unreadable_images(scene);
        compile_materials(scene, textures, data);
    }
    data.missing_textures = count_missing_textures(scene);
}

/// Fills in the camera and how it moves.
void compile_view(const SceneDesc& scene, WorldData& data) {
    data.camera = compile_camera(scene);
    data.camera_motion = compile_camera_motion(scene);
}

}  // namespace

std::uint64_t default_texture_memory() {
    return physical_memory() / 2;
}

bool holds_textures_in_memory(const SceneDesc& scene) {
    if (scene.textures.empty()) return true;
    TextureCompiler textures(scene);
    WorldData unused;  // materials say which textures are used, and for what
    compile_materials(scene, textures, unused);
    return textures.bytes_in_memory() <= texture_budget(scene);
}

World compile_world(SceneDesc scene, const ColorConfig& colors, const std::string& working_space,
                    const ThreadPool& threads, ProblemList& problems, const CompileOptions& options) {
    WorldData data;
    auto start = std::chrono::steady_clock::now();
    const auto end_phase = [&](std::string_view name) {
        data.compile_phases.push_back({name, seconds_since(start)});
        start = std::chrono::steady_clock::now();
    };
    data.from_rec709 = colors.matrix(kGltfColorSpace, working_space);
    data.xyz_to_working = xyz_to_working(data.from_rec709);
    data.response = SpectralResponse(data.xyz_to_working);
    data.origin = scene.origin;
    data.accelerator = scene.settings.accelerator;
    compile_view(scene, data);

    TextureCompiler textures(scene);
    compile_materials(scene, textures, data);
    end_phase("materials");
    compile_textures(scene, textures, threads, data, problems);
    find_specular_materials(data);
    end_phase("textures");
    compile_geometry(scene, threads, options.most_copied_triangles, data);
    compile_bodies(scene, data, problems);
    end_phase("geometry");
    build_bvh(threads, data, problems);
    end_phase("BVH");
    compile_lights(scene, threads, data, problems);
    find_planes_of_lamps(data);
    move_camera_off_surfaces(data);
    end_phase("lights");
    return World(std::move(data));
}

World with_camera(World world, const SceneDesc& scene) {
    WorldData data = World::take_data(std::move(world));
    compile_view(scene, data);
    move_camera_off_surfaces(data);
    return World(std::move(data));
}

}  // namespace etendue
