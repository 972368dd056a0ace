// What the library is told, by a stand-in for it: Debian 12 has no package of the real one.
#include "denoise/oidn.h"

#include "core/error.h"

#include <OpenImageDenoise/oidn.hpp>
#include <gtest/gtest.h>

namespace etendue {

namespace {

class Oidn : public testing::Test {
  protected:
    void SetUp() override { oidn::told() = {}; }
};

ImageF filled(float value) {
    ImageF image(4, 3, 3);
    for (float& v : image.pixels) v = value;
    return image;
}

TEST_F(Oidn, ReturnsWhatTheFilterMakesOfTheLight) {
    const ImageF light = filled(1.5f);
    const auto denoised = denoise_oidn(light, {}, {.threads = 3, .stop = nullptr});
    ASSERT_TRUE(denoised);
    EXPECT_EQ(denoised->width, 4);
    EXPECT_EQ(denoised->height, 3);
    EXPECT_EQ(denoised->pixels, filled(3.0f).pixels);
    const oidn::Told& told = oidn::told();
    EXPECT_EQ(told.executions, 1);
    EXPECT_TRUE(told.flags.at("hdr"));
    EXPECT_FALSE(told.was_committed_late);
    EXPECT_EQ(told.numbers.at("numThreads"), 3);
    EXPECT_EQ(told.images.size(), 2u) << "color and output";
    EXPECT_EQ(told.images.at("color").pixels, light.pixels.data());
    EXPECT_EQ(told.images.at("color").format, oidn::Format::Float3);
    EXPECT_EQ(told.images.at("color").width, 4u);
    EXPECT_EQ(told.images.at("color").height, 3u);
}

TEST_F(Oidn, NormalsGoBesideAnAlbedoOnly) {
    const OidnFeatures both{filled(0.5f), filled(1.0f)};
    ASSERT_TRUE(denoise_oidn(filled(1.0f), both, {}));
    EXPECT_EQ(oidn::told().images.at("albedo").pixels, both.albedo.pixels.data());
    EXPECT_EQ(oidn::told().images.at("normal").pixels, both.normal.pixels.data());
    oidn::told() = {};
    ASSERT_TRUE(denoise_oidn(filled(1.0f), {{}, filled(1.0f)}, {}));
    EXPECT_FALSE(oidn::told().images.contains("normal"));
    EXPECT_FALSE(oidn::told().numbers.contains("numThreads")) << "the library's own choice";
}

TEST_F(Oidn, SaysWhatTheLibrarySays) {
    oidn::told().error = oidn::Error::OutOfMemory;
    try {
        (void)denoise_oidn(filled(1.0f), {}, {});
        FAIL() << "the library reported an error";
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("the stand-in's reason"), std::string::npos);
    }
}

TEST_F(Oidn, CanBeStopped) {
    std::atomic<bool> stop = true;
    EXPECT_FALSE(denoise_oidn(filled(1.0f), {}, {.threads = 0, .stop = &stop}));
    oidn::told() = {};
    stop = false;
    EXPECT_TRUE(denoise_oidn(filled(1.0f), {}, {.threads = 0, .stop = &stop}));
}

}  // namespace

}  // namespace etendue
