#include "loader/gltf/glb.h"

#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

std::span<const unsigned char> bytes_of(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::string triangle_glb() {
    GltfBuilder builder;
    builder.add_triangle();
    return builder.glb();
}

std::string failure(const std::string& glb) {
    try {
        static_cast<void>(split_glb(bytes_of(glb), {"f", ""}));
        return "";
    } catch (const SceneError& error) {
        return error.what();
    }
}

TEST(SplitGlb, FindsBothChunks) {
    const std::string glb = triangle_glb();
    const GlbChunks chunks = split_glb(bytes_of(glb), {"f", ""});
    EXPECT_EQ(chunks.json.front(), '{');
    ASSERT_TRUE(chunks.bin);
    EXPECT_EQ(chunks.bin->size(), 36u);
}

TEST(SplitGlb, RefusesEveryTruncation) {
    const std::string glb = triangle_glb();
    for (std::size_t length = 0; length < glb.size(); ++length) EXPECT_NE(failure(glb.substr(0, length)), "") << length;
    EXPECT_EQ(failure(glb), "");
}

TEST(SplitGlb, RefusesWrongNumbers) {
    const auto with = [](std::size_t offset, const std::string& bytes) {
        std::string glb = triangle_glb();
        return glb.replace(offset, bytes.size(), bytes);
    };
    EXPECT_NE(failure(with(0, "glTX")).find("does not start"), std::string::npos);
    EXPECT_NE(failure(with(4, std::string("\1\0\0\0", 4))).find("version 1"), std::string::npos);
    EXPECT_NE(failure(with(8, "\xff\xff\xff\xff")).find("says that it has 4294967295"), std::string::npos);
    EXPECT_NE(failure(with(8, std::string("\4\0\0\0", 4))).find("says that it has 4 "), std::string::npos);
    EXPECT_NE(failure(with(12, "\xff\xff\xff\xff")).find("claims 4294967295"), std::string::npos);
    EXPECT_NE(failure(with(16, "BIN ")).find("not JSON"), std::string::npos);
}

TEST(LoadGlb, GivesTheSameAsText) {
    GltfBuilder builder;
    builder.add_triangle();
    const TempDir dir;
    dir.write("a.glb", builder.glb());
    const LoadedScene loaded = inspect_scene(dir.path() / "a.glb");
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).positions,
              builder.load().scene.meshes.at(0).primitives.at(0).positions);
}

TEST(LoadGlb, BufferMustFitTheChunk) {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["buffers"] = {{{"byteLength", 1000}}};
    const TempDir dir;
    dir.write("a.glb", builder.glb());
    EXPECT_TRUE(
        has_problem(inspect_scene(dir.path() / "a.glb").problems, Severity::Error, "binary chunk", "/buffers/0"));
}

TEST(LoadGlb, EveryTruncationOfAFileIsAnError) {
    const std::string glb = triangle_glb();
    const TempDir dir;
    for (std::size_t length = 0; length < glb.size(); length += 7) {
        dir.write("a.glb", glb.substr(0, length));
        EXPECT_TRUE(inspect_scene(dir.path() / "a.glb").problems.has_errors()) << length;
    }
}

}  // namespace
}  // namespace etendue
