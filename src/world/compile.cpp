#include "world/compile.h"

#include "world/compile_parts.h"
#include "world/embree_scene.h"

#include <algorithm>
#include <utility>

namespace etendue {

World compile_world(SceneDesc scene, const ColorConfig& colors, const std::string& working_space,
                    const ThreadPool& threads, ProblemList& problems) {
    WorldData data;
    data.from_rec709 = colors.matrix(kGltfColorSpace, working_space);
    data.camera = compile_camera(scene);

    TextureCompiler textures(scene);
    data.materials = compile_materials(scene, data.from_rec709, textures);
    data.textures = textures.decode(threads);
    compile_geometry(scene, threads, data);
    compile_lights(scene, data, problems);

    std::vector<bool> has_alpha;
    has_alpha.reserve(data.geometries.size());
    for (const Geometry& geometry : data.geometries)
        has_alpha.push_back(data.materials[geometry.material].alpha_test != AlphaTest::Opaque);
    data.bvh = std::make_unique<EmbreeScene>(data.geometries, data.instances, has_alpha, threads);
    return World(std::move(data));
}

}  // namespace etendue
