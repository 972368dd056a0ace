#include "session/render_identity.h"

#include "image/write.h"
#include "processor/ray_code.h"
#include "program/small_files.h"
#include "session/input_files.h"
#include "session/prepared_scene.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

RenderIdentity identity_of(const SceneDesc& scene, const std::string& working_space) {
    std::vector<InputFile> inputs = stamp_inputs(scene, fs::file_time_type::clock::now());
    hash_inputs(scene, inputs);
    return render_identity(scene, inputs, working_space);
}

SceneDesc scene_at(const fs::path& directory) {
    return prepare_scene(directory, {}).scene;
}

// The test of the table has every setting.
TEST(RenderIdentity, NamesWhatIsDifferent) {
    const TestFolder folder;
    write_scene(folder / "box");
    const SceneDesc scene = scene_at(folder / "box");
    const RenderIdentity identity = identity_of(scene, "ACEScg");
    SceneDesc other = scene;
    other.settings.integrator.light_samples = 3;
    EXPECT_EQ(difference(identity, identity_of(other, "ACEScg")), "integrator.light_samples: '1' there, '3' here");
    other = scene;
    other.environment.scale *= 2.0f;
    EXPECT_EQ(difference(identity, identity_of(other, "ACEScg")).substr(0, 7), "scene: ");
    EXPECT_EQ(difference(identity, identity_of(scene, "lin_rec709")).substr(0, 20), "color.working_space:");
    EXPECT_EQ(identity.at("instruction set"), instruction_set_name(ray_code().instruction_set));
}

TEST(RenderIdentity, HowLongAndHowItIsShownIsNoPartOfIt) {
    const TestFolder folder;
    write_scene(folder / "box");
    const SceneDesc scene = scene_at(folder / "box");
    SceneDesc other = scene;
    other.settings.spp = 99;
    other.settings.time_limit = 5.0;
    other.settings.relative_error = 0.1;
    other.settings.film.crop = std::array{0, 0, 4, 4};
    other.settings.color.exposure = 2.0f;
    other.settings.brightest = 3;
    other.settings.texture_memory = 1u << 20;  // there are no textures
    EXPECT_EQ(difference(identity_of(scene, "ACEScg"), identity_of(other, "ACEScg")), "");
}

TEST(RenderIdentity, IsTheSameWhereverTheSceneLies) {
    const TestFolder folder;
    for (const char* place : {"box", "elsewhere/deep/box"}) write_scene(folder / place);
    const RenderIdentity identity = identity_of(scene_at(folder / "box"), "ACEScg");
    EXPECT_TRUE(identity.contains("content of triangle.bin"));
    EXPECT_EQ(difference(identity, identity_of(scene_at(folder / "elsewhere/deep/box"), "ACEScg")), "");
    const fs::path relative = fs::relative(folder / "box");
    EXPECT_EQ(difference(identity, identity_of(scene_at(relative), "ACEScg")), "");
    fs::create_directory_symlink(folder / "elsewhere/deep/box", folder / "box-link");
    SceneDesc linked = scene_at(folder / "box-link");
    linked.name = "box";
    EXPECT_EQ(difference(identity, identity_of(linked, "ACEScg")), "");
}

// Look-ups in both give slightly different values.
TEST(RenderIdentity, TexturesInACacheAreOthersThanTexturesInMemory) {
    const TestFolder folder;
    write_scene(folder / "box");
    SceneDesc scene = scene_at(folder / "box");
    const std::vector<unsigned char> png = encode_png(ImageF(64, 64, 3));
    ImageDesc& image = scene.images.emplace_back();
    for (const unsigned char byte : png) image.encoded.push_back(static_cast<std::byte>(byte));
    scene.textures.emplace_back().image.index = 0;
    scene.materials.front().base_color_texture.texture.index = 0;
    const RenderIdentity in_memory = identity_of(scene, "ACEScg");
    scene.settings.texture_memory = 64 * 64;  // less than its three channels
    const RenderIdentity cached = identity_of(scene, "ACEScg");
    EXPECT_EQ(difference(in_memory, cached), "textures: 'in memory' there, 'in a cache (--texture-memory)' here");
    scene.settings.texture_memory = 1u << 20;
    EXPECT_EQ(difference(in_memory, identity_of(scene, "ACEScg")), "") << "how much memory there is is no matter";
}

TEST(RenderIdentity, MemoryForTexturesMakesNoOtherImage) {
    const TestFolder folder;
    write_scene(folder / "box");
    SceneDesc scene = scene_at(folder / "box");
    const std::string without = settings_hash(scene, PixelDepth::Half);
    scene.settings.texture_memory = 1u << 20;
    EXPECT_EQ(settings_hash(scene, PixelDepth::Half), without);
    scene.settings.seed = 7;
    EXPECT_NE(settings_hash(scene, PixelDepth::Half), without);
}

TEST(RenderIdentity, FilesElsewhereGoByTheirNames) {
    const TestFolder folder;
    write_scene(folder / "box");
    SceneDesc scene = scene_at(folder / "box");
    for (const char* place : {"one", "two"}) {
        fs::create_directories(folder / place);
        write_file(folder / place / "sky.exr", place);
        scene.inputs.push_back(folder / place / "sky.exr");
    }
    const RenderIdentity identity = identity_of(scene, "ACEScg");
    EXPECT_TRUE(identity.contains("content of sky.exr"));
    EXPECT_TRUE(identity.contains("content of sky.exr (2)"));
    EXPECT_NE(identity.at("content of sky.exr"), identity.at("content of sky.exr (2)"));
}

}  // namespace

}  // namespace etendue::test
