#include "loader/gltf/gltf_builder.h"

#include <functional>
#include <tuple>

#include <gtest/gtest.h>

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
    const LoadedScene loaded =
        textured({{"uri",
                   "data:image/png;base64,"
                   "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}})
            .load();
    EXPECT_EQ(only_image(loaded).encoded.size(), png_bytes().size());
    EXPECT_EQ(only_image(loaded).width, 1);
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

TEST(Textures, BadFilesAreErrors) {
    const auto expect_error = [](const nlohmann::json& image, const std::string& content, const char* expected) {
        const LoadedScene loaded = load_with_file(textured(image), "a.png", content);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Error, expected, "/images/0")) << listing(loaded.problems);
    };
    expect_error({{"uri", "b.png"}}, png_bytes(), "'b.png': the file does not exist");
    expect_error({{"uri", "../a.png"}}, png_bytes(), "'..'");
    expect_error({{"uri", "https://example.com/a.png"}}, png_bytes(), "other URIs");
    expect_error({{"uri", "a.png"}}, "", "a.png");
    expect_error({{"uri", "a.png"}}, "not an image at all", "a.png");
    expect_error({{"uri", "a.png"}}, png_bytes().substr(0, 20), "a.png");
    expect_error({{"uri", "data:image/png;base64,AAAA"}}, png_bytes(), "");

    std::string absurd = png_bytes();
    absurd.replace(16, 8, std::string("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8));
    expect_error({{"uri", "a.png"}}, absurd, "a.png");
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

TEST(Textures, OnlyFromAnUnsupportedExtensionIsAnError) {
    GltfBuilder builder = textured({{"uri", "a.ktx2"}});
    builder.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    EXPECT_TRUE(has_problem(builder.load().problems, Severity::Error, "KHR_texture_basisu", "/textures/0"));
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
