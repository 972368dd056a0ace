#include "loader/gltf/gltf_builder.h"

#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace etendue {
namespace {

/// A textured triangle whose image the test describes.
GltfBuilder textured(nlohmann::json image) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    primitive["attributes"]["TEXCOORD_0"] = builder.floats({0, 0, 1, 0, 0, 1}, 2);
    primitive["material"] = 0;
    builder.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.json["images"] = nlohmann::json::array({std::move(image)});
    return builder;
}

LoadedScene load_with_file(const GltfBuilder& builder, const std::string& name, const std::string& content) {
    const TempDir dir;
    builder.write(dir);
    dir.write(name, content);
    return inspect_scene(dir.path() / "scene.gltf");
}

const ImageDesc& only_image(const LoadedScene& loaded) {
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    return loaded.scene.images.at(0);
}

TEST(Textures, FromAFile) {
    const LoadedScene loaded =
        load_with_file(textured({{"uri", "my%20image.png"}, {"name", "n"}}), "my image.png", png_bytes());
    EXPECT_EQ(only_image(loaded).path.filename(), "my image.png");
    EXPECT_TRUE(only_image(loaded).encoded.empty());
    EXPECT_EQ(only_image(loaded).width, 1);
    EXPECT_EQ(only_image(loaded).name, "n");
    EXPECT_EQ(loaded.scene.inputs.size(), 3u);
}

TEST(Textures, FromABufferView) {
    GltfBuilder builder = textured({{"mimeType", "image/png"}});
    const std::vector<char> bytes(png_bytes().begin(), png_bytes().end());
    builder.json["images"][0]["bufferView"] = builder.view(bytes);
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(only_image(loaded).encoded.size(), png_bytes().size());
    EXPECT_EQ(only_image(loaded).encoded[1], std::byte{'P'});
    EXPECT_EQ(only_image(loaded).mime_type, "image/png");
    EXPECT_TRUE(loaded.problems.all().empty()) << listing(loaded.problems);
    EXPECT_TRUE(only_image(loaded).path.empty());
    EXPECT_EQ(only_image(loaded).height, 1);
}

TEST(Textures, TheBytesCountWhateverTheMimeType) {
    GltfBuilder builder = textured({{"mimeType", "image/jpeg"}});
    const std::vector<char> bytes(png_bytes().begin(), png_bytes().end());
    builder.json["images"][0]["bufferView"] = builder.view(bytes);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "is png, whatever", "/images/0"))
        << listing(loaded.problems);
    EXPECT_EQ(only_image(loaded).height, 1);
}

TEST(Textures, FromADataUri) {
    for (const std::string head :
         {"data:image/png;base64,", "data:image/png; base64,", "data:image/png ;charset=x; base64 ,"}) {
        const LoadedScene loaded =
            textured(
                {{"uri", head + "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJ"
                                "RU5ErkJggg=="}})
                .load();
        EXPECT_EQ(only_image(loaded).encoded.size(), png_bytes().size()) << head;
        EXPECT_EQ(only_image(loaded).width, 1) << head;
    }
}

TEST(Textures, SamplersAreRead) {
    GltfBuilder builder = textured({{"uri", "a.png"}});
    builder.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9987}}};
    builder.json["textures"][0]["sampler"] = 0;
    const LoadedScene loaded = load_with_file(builder, "a.png", png_bytes());
    const TextureDesc& texture = loaded.scene.textures.at(0);
    EXPECT_EQ(texture.wrap_u, TextureWrap::ClampToEdge);
    EXPECT_EQ(texture.wrap_v, TextureWrap::MirroredRepeat);
    EXPECT_EQ(texture.filter, TextureFilter::Nearest);

    const LoadedScene plain = load_with_file(textured({{"uri", "a.png"}}), "a.png", png_bytes());
    EXPECT_EQ(plain.scene.textures.at(0).wrap_u, TextureWrap::Repeat);
    EXPECT_EQ(plain.scene.textures.at(0).filter, TextureFilter::Linear);
}

TEST(Textures, MinificationFiltersSayHowToReadWithinLevelsAndBetweenThem) {
    using Within = TextureFilter;
    using Between = TextureMipFilter;
    const std::tuple<int, Within, Between> codes[] = {
        {9728, Within::Nearest, Between::None},    {9729, Within::Linear, Between::None},
        {9984, Within::Nearest, Between::Nearest}, {9985, Within::Linear, Between::Nearest},
        {9986, Within::Nearest, Between::Linear},  {9987, Within::Linear, Between::Linear}};
    for (const auto& [code, within, between] : codes) {
        GltfBuilder builder = textured({{"uri", "a.png"}});
        builder.json["samplers"] = {{{"minFilter", code}}};
        builder.json["textures"][0]["sampler"] = 0;
        const LoadedScene loaded = load_with_file(builder, "a.png", png_bytes());
        const TextureDesc& texture = loaded.scene.textures.at(0);
        EXPECT_EQ(texture.min_filter, within) << code;
        EXPECT_EQ(texture.mip_filter, between) << code;
        EXPECT_EQ(texture.filter, TextureFilter::Linear);
    }
    const LoadedScene plain = load_with_file(textured({{"uri", "a.png"}}), "a.png", png_bytes());
    EXPECT_EQ(plain.scene.textures.at(0).min_filter, Within::Linear);
    EXPECT_EQ(plain.scene.textures.at(0).mip_filter, Between::Linear);
}

TEST(Textures, FormatsThatGltfDoesNotNameAreReadWithAWarning) {
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n";
    hdr.append(4, '\1');
    const LoadedScene loaded = load_with_file(textured({{"uri", "a.png"}}), "a.png", hdr);
    EXPECT_EQ(only_image(loaded).width, 1);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "this one is hdr", "/images/0"))
        << listing(loaded.problems);
}

/// A texture that cannot be read, and what is said of it.
struct BadImage {
    nlohmann::json image;
    std::string content;  ///< of a.png
    const char* message;
};

std::vector<BadImage> unreadable_images() {
    return {{{{"uri", "b.png"}}, png_bytes(), "'b.png': the file does not exist"},
            {{{"uri", "a.png"}}, "", "'a.png': the file is empty"},
            {{{"uri", "a.png"}}, "not an image at all", "'a.png': not an image of a known format"},
            {{{"uri", "a.png"}}, png_bytes().substr(0, 20), "a.png"},
            {{{"uri", "%zz.png"}}, png_bytes(), "'%' is not followed"},
            {{{"uri", ""}}, png_bytes(), "the file name is empty"},
            {{{"name", "nothing"}}, png_bytes(), "the file name is empty"},
            {{{"uri", "directory"}}, png_bytes(), "'directory': this is not a regular file"},
            {{{"uri", "."}}, png_bytes(), "'.': this is not a regular file"},
            {{{"uri", "A.PNG"}}, png_bytes(), "did you mean 'a.png'?"},
            {{{"uri", "pipe"}}, png_bytes(), "'pipe': this is not a regular file"},
            {{{"uri", "data:image/png;base64,AAAA"}}, png_bytes(), "not an image of a known format"},
            {{{"uri", "data:image/png;base64,%zz"}}, png_bytes(), "'%' is not followed"},
            {{{"uri", "data:image/png,xyz"}}, png_bytes(), "the data URI is empty or not base64"}};
}

/// Loads what `bad` describes beside a directory and a pipe without a writer.
LoadedScene load_bad_image(const BadImage& bad, const LoadOptions& options) {
    const TempDir dir;
    textured(bad.image).write(dir);
    dir.write("a.png", bad.content);
    std::filesystem::create_directory(dir.path() / "directory");
    EXPECT_EQ(mkfifo((dir.path() / "pipe").c_str(), 0600), 0);
    return inspect_scene(dir.path() / "scene.gltf", options);
}

TEST(Textures, WhatCannotBeReadIsLeftOutWithAWarning) {
    for (const BadImage& bad : unreadable_images()) {
        const LoadedScene loaded = load_bad_image(bad, {});
        EXPECT_FALSE(loaded.problems.has_errors()) << bad.message << listing(loaded.problems);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, bad.message, "/images/0"))
            << bad.message << listing(loaded.problems);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "materials do without it", "/images/0"));
        EXPECT_EQ(count_missing_textures(loaded.scene), 1u) << bad.message;
        EXPECT_EQ(loaded.scene.inputs.size(), 2u) << "what is not read is no input: " << bad.message;
        EXPECT_FALSE(loaded.scene.materials.at(0).emissive_texture.valid());
    }
}

TEST(Textures, WhatCannotBeReadIsAnErrorWhereThatIsAskedFor) {
    for (const BadImage& bad : unreadable_images()) {
        const LoadedScene loaded = load_bad_image(bad, {.settings = R"({"missing_textures": "error"})"});
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, bad.message, "/images/0"))
            << bad.message << listing(loaded.problems);
    }
}

TEST(Textures, WhatMayNotBeReadIsAlwaysAnError) {
    const std::string huge = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 70000 +X 70000\n";
    const BadImage refused[] = {{{{"uri", "../a.png"}}, png_bytes(), "'..'"},
                                {{{"uri", "/a.png"}}, png_bytes(), "absolute"},
                                {{{"uri", "https://example.com/a.png"}}, png_bytes(), "other URIs"},
                                {{{"uri", "a.png"}}, huge, "more than are allowed"}};
    for (const BadImage& bad : refused) {
        const LoadedScene loaded = load_bad_image(bad, {});
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, bad.message, "/images/0"))
            << bad.message << listing(loaded.problems);
    }
}

// Factors stand alone, but a lamp that the map was to choose from a surface is none, and no surface becomes a mirror.
TEST(Textures, AMaterialWithoutItsTexturesIsPlain) {
    GltfBuilder builder = textured({{"uri", "missing.png"}});
    builder.json["materials"] = nlohmann::json::parse(R"([{
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.5], "baseColorTexture": {"index": 0},
            "roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 0}, "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0}}}},
        {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"specularGlossinessTexture": {"index": 0}}}}])");
    const LoadedScene loaded = builder.load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const MaterialDesc& m = loaded.scene.materials.at(0);
    EXPECT_EQ(m.base_color, Rgb(0.5f, 0.25f, 1.0f));
    EXPECT_EQ(m.base_alpha, 0.5f);
    EXPECT_EQ(m.roughness, 0.5f);
    EXPECT_EQ(m.clearcoat.factor, 0.5f);
    EXPECT_TRUE(is_black(m.emissive));
    for (const TextureRef* ref : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                                  &m.emissive_texture, &m.clearcoat.texture})
        EXPECT_FALSE(ref->valid());
    const MaterialDesc& glossy = loaded.scene.materials.at(1);
    EXPECT_LT(max_component(glossy.specular_color), 0.1f);
    EXPECT_EQ(glossy.glossiness, 0.0f);
    EXPECT_EQ(count_missing_textures(loaded.scene), 1u) << "one image, however many show it";
}

TEST(Textures, RenderJsonSaysWhetherMissingOnesAreErrors) {
    const TempDir dir;
    textured({{"uri", "missing.png"}}).write(dir);
    dir.write("render.json", R"({"missing_textures": "error"})");
    EXPECT_TRUE(inspect_scene(dir.path()).problems.has_errors());
    EXPECT_FALSE(inspect_scene(dir.path(), {.settings = R"({"missing_textures": "warn"})"}).problems.has_errors());
    dir.write("render.json", R"({"missing_textures": "warn"})");
    EXPECT_FALSE(inspect_scene(dir.path()).problems.has_errors());
}

TEST(Textures, FilesBehindLinksOutsideAreErrors) {
    const TempDir outside;
    outside.write("a.png", png_bytes());
    const TempDir dir;
    textured({{"uri", "a.png"}}).write(dir);
    std::filesystem::create_symlink(outside.path() / "a.png", dir.path() / "a.png");
    const LoadedScene loaded = inspect_scene(dir.path() / "scene.gltf");
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, "link leads out", "/images/0"));
}

TEST(Textures, ViewsOutsideTheBufferAreErrors) {
    GltfBuilder builder = textured({{"mimeType", "image/png"}});
    builder.json["images"][0]["bufferView"] = builder.view(std::vector<char>(8));
    builder.json["bufferViews"].back()["byteLength"] = 1'000'000'000;
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "covers 1000000000", "/images/0"));
}

TEST(Textures, OnlyFromAnUnsupportedExtensionTheyAreMissing) {
    GltfBuilder builder = textured({{"uri", "a.ktx2"}});
    builder.json["extensionsUsed"] = {"KHR_texture_basisu"};
    builder.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "KHR_texture_basisu", "/textures/0"));
    EXPECT_FALSE(loaded.problems.has_errors());
    EXPECT_EQ(count_missing_textures(loaded.scene), 1u);
    const LoadedScene strict = builder.load({.settings = R"({"missing_textures": "error"})"});
    EXPECT_TRUE(has_problem(strict.problems, Severity::Error, "KHR_texture_basisu", "/textures/0"));
}

TEST(Textures, WithoutAnImageTheyAreLeftOut) {
    GltfBuilder builder = textured({{"uri", "a.png"}});
    builder.json["textures"][0] = nlohmann::json::object();
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "no image", "/textures/0"));
    EXPECT_FALSE(loaded.problems.has_errors());
    EXPECT_TRUE(loaded.scene.textures.empty());
}

TEST(Textures, FallbackBesideAnUnsupportedExtensionIsUsed) {
    GltfBuilder builder = textured({{"uri", "a.png"}});
    builder.json["extensionsUsed"] = {"KHR_texture_basisu"};
    builder.json["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 0}}}};
    EXPECT_EQ(only_image(load_with_file(builder, "a.png", png_bytes())).width, 1);
}

TEST(Textures, WebpComesBeforeItsFallback) {
    GltfBuilder builder = textured({{"uri", "missing.png"}});
    builder.json["images"].push_back(
        {{"uri", "data:image/webp;base64,UklGRiYAAABXRUJQVlA4IBoAAAAwAQCdASoBAAEAAAAAJaQAA3AA/v/fbtQAAA=="}});
    builder.json["extensionsUsed"] = {"EXT_texture_webp"};
    builder.json["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", 1}}}};
    EXPECT_EQ(only_image(builder.load()).width, 1);
    builder.json["textures"][0].erase("source");
    EXPECT_EQ(only_image(builder.load()).width, 1);
}

TEST(Textures, UnusedImagesAreNotOpened) {
    GltfBuilder builder = textured({{"uri", "a.png"}});
    builder.json["images"].push_back({{"uri", "missing.png"}});
    const LoadedScene loaded = load_with_file(builder, "a.png", png_bytes());
    EXPECT_EQ(only_image(loaded).width, 1);
    EXPECT_EQ(loaded.scene.images.size(), 1u);
}

}  // namespace
}  // namespace etendue
