// Reading images of many layers.
#include "image/read_channels.h"

#include "core/error.h"
#include "image_test_files.h"

#include <array>
#include <variant>

#include <gtest/gtest.h>

namespace etendue {

namespace {

using Names = std::vector<std::string>;

ImageF counted(int width, int height, int channels) {
    ImageF image(width, height, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i) + 0.25f;
    return image;
}

float value_of(const ChannelImage& image, const std::string& name, int x, int y) {
    for (std::size_t i = 0; i < image.channel_names.size(); ++i)
        if (image.channel_names[i] == name) return image.pixels.pixel(x, y)[i];
    ADD_FAILURE() << "no channel " << name;
    return 0.0f;
}

TEST(ReadChannels, EveryChannelByItsName) {
    const TemporaryFolder folder;
    const ImageF image = counted(5, 4, 6);
    const Names names{"R", "G", "B", "N.X", "half.R", "light.direct.R"};
    write_image(folder / "a.exr", image, {.depth = PixelDepth::Float, .channel_names = names});
    const ChannelImage read = read_channels(folder / "a.exr");
    ASSERT_EQ(read.channel_names.size(), 6u);
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_EQ(value_of(read, names[i], 3, 2), image.pixel(3, 2)[i]) << names[i];
    EXPECT_EQ(read.depths, std::vector(6, PixelDepth::Float));
    write_image(folder / "b.exr", image, {.depth = PixelDepth::Half, .channel_names = names});
    EXPECT_EQ(read_channels(folder / "b.exr").depths, std::vector(6, PixelDepth::Half));
}

TEST(ReadChannels, PartsStandSideBySide) {
    const TemporaryFolder folder;
    const ImageF color = counted(5, 4, 3);
    ImageF normals = counted(5, 4, 3);
    for (float& value : normals.pixels) value += 100.0f;
    const std::vector<ImagePart> parts{
        {.name = "rgba", .image = &color, .channel_names = {"R", "G", "B"}, .attributes = {{"etendue:a", 1}}},
        {.name = "N",
         .image = &normals,
         .channel_names = {"N.X", "N.Y", "N.Z"},
         .channel_depths = {PixelDepth::Float, PixelDepth::Float, PixelDepth::Float},
         .attributes = {{"etendue:a", 2}, {"etendue:b", 3}}}};
    write_image_parts(folder / "a.exr", parts, {.depth = PixelDepth::Half});
    const ChannelImage read = read_channels(folder / "a.exr");
    EXPECT_EQ(read.channel_names, (Names{"R", "G", "B", "N.X", "N.Y", "N.Z"}));
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_EQ(read.pixels.pixel(x, y)[c], color.pixel(x, y)[c]);
                EXPECT_EQ(read.pixels.pixel(x, y)[3 + c], normals.pixel(x, y)[c]);
            }
    EXPECT_EQ(read.depths, (std::vector{PixelDepth::Half, PixelDepth::Half, PixelDepth::Half, PixelDepth::Float,
                                        PixelDepth::Float, PixelDepth::Float}));
    ASSERT_TRUE(read.find("etendue:a") && read.find("etendue:b"));
    EXPECT_EQ(std::get<int>(read.find("etendue:a")->value), 1) << "the first part goes before others";
    EXPECT_EQ(std::get<int>(read.find("etendue:b")->value), 3);
}

TEST(ReadChannels, PartsOfOtherPixelsAreRefused) {
    const TemporaryFolder folder;
    std::array<OIIO::ImageSpec, 2> specs{OIIO::ImageSpec(5, 4, 3, OIIO::TypeDesc::FLOAT),
                                         OIIO::ImageSpec(4, 4, 1, OIIO::TypeDesc::FLOAT)};
    specs[1].channelnames = {"depth.Z"};
    specs[1].full_width = 5;
    specs[0].attribute("oiio:subimagename", "rgba");
    specs[1].attribute("oiio:subimagename", "depth");
    const std::vector<float> pixels(5 * 4 * 3);
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(folder / "a.exr", 2, specs.data()) &&
                output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
                output->open(folder / "a.exr", specs[1], OIIO::ImageOutput::AppendSubimage) &&
                output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close())
        << output->geterror();
    try {
        (void)read_channels(folder / "a.exr");
        FAIL() << "it has two data windows";
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("'depth'"), std::string::npos) << error.what();
    }
}

TEST(ReadChannels, WhatIsSaidOfTheImageCanBeWrittenAgain) {
    const TemporaryFolder folder;
    Mat4f matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = static_cast<float>(i);
    const std::vector<float> primaries{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    ImageWriteOptions options{.depth = PixelDepth::Float};
    options.attributes = {
        {"worldToCamera", matrix}, {"chromaticities", primaries},         {"etendue:halfShare", 0.25f},
        {"etendue:spp", 64},       {"etendue:scene", std::string("box")}, {"oiio:ColorSpace", std::string("ACEScg")}};
    options.offset_x = 3;
    options.offset_y = 2;
    options.full_width = 20;
    options.full_height = 10;
    write_image(folder / "a.exr", counted(5, 4, 3), options);
    const ChannelImage read = read_channels(folder / "a.exr");
    EXPECT_EQ(read.data_window, (PixelRect{3, 2, 8, 6}));
    EXPECT_EQ(read.display_window, (PixelRect{0, 0, 20, 10}));
    for (const ImageAttribute& attribute : options.attributes) {
        const ImageAttribute* found = read.find(attribute.name);
        ASSERT_TRUE(found) << attribute.name;
        EXPECT_EQ(found->value, attribute.value) << attribute.name;
    }
    EXPECT_FALSE(read.find("compression"));
    options.attributes = read.attributes;
    write_image(folder / "b.exr", read.pixels, options);
    EXPECT_EQ(read_channels(folder / "b.exr").attributes.size(), read.attributes.size());
}

TEST(ReadChannels, IntegersAreRefused) {
    const TemporaryFolder folder;
    write_image(folder / "a.png", ImageF(4, 4, 3), {.depth = PixelDepth::UInt8});
    OIIO::ImageSpec spec(4, 4, 4, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "id.Y"};
    // One by one: g++ 12 warns of a list of them on some processors.
    spec.channelformats.assign(3, OIIO::TypeDesc::FLOAT);
    spec.channelformats.emplace_back(OIIO::TypeDesc::UINT32);
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(folder / "b.exr", spec)) << output->geterror();
    const std::vector<float> pixels(64);
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) << output->geterror();
    output->close();
    for (const auto& [file, channel] : {std::pair{"a.png", "'R'"}, std::pair{"b.exr", "'id.Y'"}}) {
        try {
            (void)read_channels(folder / file);
            ADD_FAILURE() << file;
        } catch (const IoError& error) {
            EXPECT_NE(std::string(error.what()).find(channel), std::string::npos) << error.what();
        }
    }
}

TEST(ReadChannels, BrokenFilesAreNamed) {
    const TemporaryFolder folder;
    write_image(folder / "a.exr", counted(64, 64, 9), {.depth = PixelDepth::Float});
    const std::vector<std::byte> bytes = read_all(folder / "a.exr");
    for (std::size_t size = 0; size < bytes.size(); size += bytes.size() / 23)
        EXPECT_THROW((void)read_channels(std::span(bytes).first(size)), IoError) << size;
    EXPECT_THROW((void)read_channels(folder / "none.exr"), IoError);
}

}  // namespace

}  // namespace etendue
