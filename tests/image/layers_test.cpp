#include "image/layers.h"

#include "core/error.h"
#include "image/write.h"
#include "image_test_files.h"

#include <algorithm>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

namespace etendue {

namespace {

using Names = std::vector<std::string>;

/// 3 x 2 pixels; channel i of pixel p is 10 i + p, whatever order the file keeps the channels in.
std::filesystem::path write_channels(const std::filesystem::path& path, const Names& names,
                                     OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
    OIIO::ImageSpec spec(3, 2, static_cast<int>(names.size()), type);
    spec.channelnames = names;
    std::vector<float> pixels;
    for (int p = 0; p < 6; ++p)
        for (std::size_t i = 0; i < names.size(); ++i)
            pixels.push_back(10.0f * static_cast<float>(i) + static_cast<float>(p));
    return write_reference(path, spec, pixels);
}

std::string described(const LayeredImage& image) {
    std::string text;
    for (const ImageLayer& layer : image.layers) {
        text += layer.name + ":";
        for (const std::string& channel : layer.channels) text += " " + channel;
        text += "; ";
    }
    return text;
}

/// Channel `channel` of the first pixel.
float first(const std::filesystem::path& path, const std::string& layer, std::size_t channel) {
    const LayeredImage image = read_layers(path);
    const auto found = find_layer(image, layer);
    EXPECT_TRUE(found) << layer;
    return found ? read_layer(path, *found).pixels.at(channel) : -1.0f;
}

TEST(Layers, AreChannelsWithOneNameBeforeTheDot) {
    const TemporaryFolder folder;
    const auto path = write_channels(folder / "a.exr",
                                     {"R",           "G",    "B",    "A",     "Z",       "diffuse.R",   "diffuse.G",
                                      "diffuse.B",   "N.X",  "N.Y",  "N.Z",   "depth.Z", "light.key.R", "light.key.G",
                                      "light.key.B", "uv.U", "uv.V", "odd.a", "odd.q",   "motion.X",    "motion.Y"});
    const LayeredImage image = read_layers(path);
    std::vector<std::pair<std::string, LayerKind>> found;
    for (const ImageLayer& layer : image.layers) found.emplace_back(layer.name, layer.kind);
    std::ranges::sort(found);
    EXPECT_EQ(found, (std::vector<std::pair<std::string, LayerKind>>{{"", LayerKind::Color},
                                                                     {"N", LayerKind::Vector},
                                                                     {"Z", LayerKind::Single},
                                                                     {"depth", LayerKind::Single},
                                                                     {"diffuse", LayerKind::Color},
                                                                     {"light.key", LayerKind::Color},
                                                                     {"motion", LayerKind::Vector},
                                                                     {"odd.a", LayerKind::Single},
                                                                     {"odd.q", LayerKind::Single},
                                                                     {"uv", LayerKind::Vector}}))
        << described(image);
    EXPECT_EQ(main_layer(image)->channels, (Names{"R", "G", "B", "A"}));
    EXPECT_EQ(first(path, "", 3), 30.0f);
    EXPECT_EQ(first(path, "Z", 0), 40.0f);
    EXPECT_EQ(first(path, "diffuse", 0), 50.0f) << "red first, although the file has blue first";
    EXPECT_EQ(first(path, "diffuse", 2), 70.0f);
    EXPECT_EQ(first(path, "N", 2), 100.0f);
    EXPECT_EQ(first(path, "depth", 0), 110.0f);
    EXPECT_EQ(first(path, "N.Y", 0), 90.0f) << "a channel by its whole name";
    EXPECT_FALSE(find_layer(image, "no such"));
}

TEST(Layers, LuminanceIsOneToo) {
    const TemporaryFolder folder;
    const auto path = write_channels(folder / "a.exr", {"Y", "A"});
    const auto layer = main_layer(read_layers(path));
    EXPECT_EQ(layer->kind, LayerKind::Luminance);
    EXPECT_EQ(layer->channels, (Names{"Y", "A"}));
    EXPECT_EQ(first(path, "", 1), 10.0f);
}

TEST(Layers, CountsAreToldFromFloats) {
    const TemporaryFolder folder;
    const auto ids = write_channels(folder / "ids.exr", {"id"}, OIIO::TypeDesc::UINT);
    EXPECT_TRUE(main_layer(read_layers(ids))->is_integer);
    const auto depth = write_channels(folder / "depth.exr", {"Z"}, OIIO::TypeDesc::HALF);
    EXPECT_FALSE(main_layer(read_layers(depth))->is_integer);
}

TEST(Layers, PartsAreLayersByTheirNames) {
    const TemporaryFolder folder;
    ImageF beauty(3, 2, 3);
    ImageF normal(3, 2, 3);
    std::ranges::fill(normal.pixels, 0.5f);
    const std::vector<ImagePart> parts{{"beauty", &beauty}, {"N", &normal}};
    write_image_parts(folder / "a.exr", parts, {.depth = PixelDepth::Float});
    const LayeredImage image = read_layers(folder / "a.exr");
    EXPECT_EQ(described(image), "beauty: R G B; N: R G B; ");
    EXPECT_EQ(main_layer(image)->name, "beauty");
    EXPECT_EQ(first(folder / "a.exr", "N", 0), 0.5f);
}

TEST(Layers, OtherFormatsHaveOne) {
    const TemporaryFolder folder;
    write_image(folder / "a.png", ImageF(3, 2, 3), {.depth = PixelDepth::UInt8});
    EXPECT_EQ(described(read_layers(folder / "a.png")), ": R G B; ");
}

TEST(Layers, ManyChannelsAreReadWithoutRoomForAll) {
    const TemporaryFolder folder;
    Names names{"B", "R"};
    for (int i = 0; i < 300; ++i) names.push_back(fmt::format("C{}", i));
    names.emplace_back("G");
    const auto path = write_channels(folder / "a.exr", names);
    EXPECT_EQ(first(path, "", 0), 10.0f);
    EXPECT_EQ(first(path, "", 1), 3020.0f);
    EXPECT_EQ(first(path, "C7", 0), 90.0f);
}

TEST(Layers, AbsurdHeadersAreTold) {
    const TemporaryFolder folder;
    const auto path = write_channels(folder / "a.exr", {"R", "G", "B"});
    std::vector<std::byte> bytes = read_all(path);
    const std::string name = "dataWindow";
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const std::size_t at = std::string_view(text, bytes.size()).find(name) + name.size() + 1 + 6 + 4;
    bytes[at + 10] = std::byte{0x10};  // a width of a million
    std::ofstream(folder / "b.exr", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    try {
        const LayeredImage image = read_layers(folder / "b.exr");
        ASSERT_FALSE(image.layers.empty());
        EXPECT_NE(image.layers.front().problem, "");
        EXPECT_THROW((void)read_layer(folder / "b.exr", image.layers.front()), IoError);
    } catch (const IoError&) {
        // The library has seen it before us.
    }
    EXPECT_THROW((void)read_layers(folder / "missing.exr"), IoError);
}

/// Nothing but an IoError may come of a damaged file.
TEST(Layers, DamagedFilesAreRefusedOrRead) {
    const TemporaryFolder folder;
    const auto path = write_channels(folder / "a.exr", {"R", "G", "B", "N.X", "N.Y", "N.Z", "id"});
    const std::vector<std::byte> whole = read_all(path);
    std::mt19937 random(5);
    for (int round = 0; round < 60; ++round) {
        std::vector<std::byte> bytes = whole;
        for (int i = 0; i < 4; ++i) bytes[random() % bytes.size()] = static_cast<std::byte>(random() & 0xffu);
        if (round % 3 == 0) bytes.resize(random() % bytes.size() + 1);
        try {
            const LayeredImage image = read_layers(std::span<const std::byte>(bytes));
            for (const ImageLayer& layer : image.layers)
                if (layer.problem.empty()) (void)read_layer(std::span<const std::byte>(bytes), layer);
        } catch (const IoError&) {
            continue;
        }
    }
}

}  // namespace

}  // namespace etendue
