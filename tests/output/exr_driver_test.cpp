#include "output/exr_driver.h"

#include "core/error.h"
#include "image/read.h"
#include "output/cryptomatte.h"
#include "output/shot_attributes.h"
#include "output/software_name.h"
#include "test_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <utility>
#include <variant>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

namespace etendue {

namespace {

OIIO::ImageSpec spec_of(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    EXPECT_TRUE(input) << OIIO::geterror();
    return input ? input->spec() : OIIO::ImageSpec();
}

Mat4f matrix_of(const OIIO::ImageSpec& spec, const char* name) {
    const auto* attribute = spec.find_attribute(name, OIIO::TypeMatrix);
    EXPECT_TRUE(attribute) << name;
    Mat4f matrix;
    if (attribute) std::memcpy(matrix.getValue(), attribute->data(), 16 * sizeof(float));
    return matrix;
}

Vec3f project(const Mat4f& matrix, const Vec3f& point) {
    Vec3f result;
    matrix.multVecMatrix(point, result);
    return result;
}

TEST(ExrDriver, FloatReadsBackExactly) {
    const TestFolder folder;
    const OutputFrame frame = make_test_frame();
    ExrDriver(folder / "a.exr", ColorConfig::built_in(), PixelDepth::Float).write(frame);
    EXPECT_EQ(read_image_float(folder / "a.exr").pixels, frame.pixels.pixels);
}

TEST(ExrDriver, HalfReadsBackWithinHalfPrecision) {
    const TestFolder folder;
    const OutputFrame frame = make_test_frame();
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(frame);
    const ImageF back = read_image_float(folder / "a.exr");
    ASSERT_EQ(back.channels, 4);
    ASSERT_EQ(back.pixels.size(), frame.pixels.pixels.size());
    for (std::size_t i = 0; i < back.pixels.size(); ++i) {
        const float expected = frame.pixels.pixels[i];
        EXPECT_NEAR(back.pixels[i], expected, std::abs(expected) * std::exp2(-11.0f)) << i;
    }
}

TEST(ExrDriver, CarriesAllMetadata) {
    const TestFolder folder;
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(make_test_frame());
    const OIIO::ImageSpec spec = spec_of(folder / "a.exr");
    EXPECT_EQ(spec.get_string_attribute("Software"), std::string(software_name()));
    EXPECT_EQ(spec.get_string_attribute("Software").substr(0, 8), "Etendue ");
    EXPECT_EQ(spec.get_string_attribute("oiio:ColorSpace"), "ACEScg");
    EXPECT_EQ(spec.get_float_attribute("PixelAspectRatio"), 1.25f);
    EXPECT_EQ(spec.get_string_attribute("etendue:scene"), "cornell-box");
    EXPECT_EQ(spec.get_string_attribute("etendue:integrator"), "path");
    EXPECT_EQ(spec.get_string_attribute("etendue:sampler"), "sobol");
    EXPECT_EQ(spec.get_int_attribute("etendue:spp"), 64);
    EXPECT_EQ(spec.get_string_attribute("etendue:seed"), "4000000000");
    EXPECT_EQ(spec.get_float_attribute("etendue:renderTime"), 12.5f);
    EXPECT_EQ(spec.get_int_attribute("etendue:complete", -1), 0);
    EXPECT_EQ(spec.get_string_attribute("etendue:haltReason"), "interrupted");

    const auto* found = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    ASSERT_TRUE(found);
    const std::vector<float> ap1{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    EXPECT_TRUE(std::ranges::equal(std::span(static_cast<const float*>(found->data()), 8), ap1));
}

// Names as OpenImageIO has them: Copyright is owner, ImageDescription comments, FNumber aperture.
TEST(ExrDriver, CarriesStandardAttributesOfShots) {
    const TestFolder folder;
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(make_test_frame());
    const OIIO::ImageSpec spec = spec_of(folder / "a.exr");
    EXPECT_EQ(spec.get_string_attribute("Copyright"), "Jo");
    EXPECT_EQ(spec.get_string_attribute("ImageDescription"), "For Sam.");
    EXPECT_EQ(spec.get_string_attribute("cameraLabel"), "Hero");
    EXPECT_EQ(spec.get_float_attribute("nominalFocalLength"), 50.0f);
    EXPECT_EQ(spec.get_float_attribute("FNumber"), 2.0f);
    EXPECT_EQ(spec.get_float_attribute("focus"), 3.5f);
    EXPECT_NE(spec.find_attribute("utcOffset", OIIO::TypeDesc::FLOAT), nullptr);
    EXPECT_EQ(spec.get_int_attribute("imageCounter"), 1450);
    const auto* rate = spec.find_attribute("framesPerSecond", OIIO::TypeRational);
    ASSERT_TRUE(rate);
    EXPECT_EQ(static_cast<const int*>(rate->data())[0], 24);
    EXPECT_EQ(static_cast<const int*>(rate->data())[1], 1);
    const auto* code = spec.find_attribute("smpte:TimeCode", OIIO::TypeTimeCode);
    ASSERT_TRUE(code);
    EXPECT_EQ(static_cast<const std::uint32_t*>(code->data())[0], 0x00010010u) << "00:01:00:10";
    OutputFrame still = make_test_frame();
    still.frame.reset();
    still.owner.clear();
    ExrDriver(folder / "b.exr", ColorConfig::built_in()).write(still);
    EXPECT_EQ(spec_of(folder / "b.exr").find_attribute("smpte:TimeCode"), nullptr);
    EXPECT_EQ(spec_of(folder / "b.exr").find_attribute("imageCounter"), nullptr);
    EXPECT_EQ(spec_of(folder / "b.exr").find_attribute("Copyright"), nullptr);
}

TEST(ShotAttributes, RatesAndTimeCodes) {
    const auto rate = [](double fps) {
        const std::optional<ImageRational> ratio = frames_per_second(fps);
        return ratio ? std::pair(ratio->numerator, ratio->denominator) : std::pair(0, 0);
    };
    EXPECT_EQ(rate(25.0), std::pair(25, 1));
    EXPECT_EQ(rate(23.976), std::pair(24000, 1001));
    EXPECT_EQ(rate(29.97), std::pair(30000, 1001));
    EXPECT_EQ(rate(12.5), std::pair(12500, 1000));
    EXPECT_EQ(rate(1e-3), std::pair(1, 1000));
    EXPECT_EQ(rate(5e-4), std::pair(0, 0));
    EXPECT_EQ(rate(1e12), std::pair(0, 0));
    EXPECT_EQ(time_code(0, 24.0)->digits, 0u);
    EXPECT_EQ(time_code((11 * 3600 + 59 * 60 + 58) * 30 + 29, 29.97)->digits, 0x11595829u);
    EXPECT_FALSE(time_code(-1, 24.0));
    EXPECT_FALSE(time_code(1, 60.0));
    EXPECT_FALSE(time_code(999'999, 1.0));
}

// Blender looks for Cryptomattes in the first part of a file.
TEST(ExrDriver, TellsCryptomattesInTheFirstPart) {
    const TestFolder folder;
    OutputFrame frame = make_test_frame();
    frame.layers.push_back({.name = "CryptoObject",
                            .channels = "RGBA",
                            .is_float = true,
                            .is_matte = true,
                            .attributes = matte_attributes("CryptoObject", "{}"),
                            .pixels = frame.pixels});
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write_layers_as_parts(frame);
    const auto input = OIIO::ImageInput::open((folder / "a.exr").string());
    ASSERT_TRUE(input);
    for (int part = 0; part < 2; ++part) {
        ASSERT_TRUE(input->seek_subimage(part, 0));
        for (const ImageAttribute& attribute : frame.layers[0].attributes)
            EXPECT_EQ(input->spec().get_string_attribute(attribute.name), std::get<std::string>(attribute.value))
                << part;
    }
}

TEST(ExrDriver, PlacesTheCropWindow) {
    const TestFolder folder;
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(make_test_frame());
    const OIIO::ImageSpec spec = spec_of(folder / "a.exr");
    EXPECT_EQ(spec.x, 5);
    EXPECT_EQ(spec.y, 7);
    EXPECT_EQ(spec.width, 3);
    EXPECT_EQ(spec.height, 2);
    EXPECT_EQ(spec.full_width, 40);
    EXPECT_EQ(spec.full_height, 30);
}

// The camera of the test frame stands at (0, 0, 4) and looks along -Z; at distance 4 it sees x in ±2 and y in ±4/3.
TEST(ExrDriver, MatricesFollowTheConventionsOfOpenExr) {
    const TestFolder folder;
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(make_test_frame());
    const OIIO::ImageSpec spec = spec_of(folder / "a.exr");
    const Vec3f in_camera = project(matrix_of(spec, "worldToCamera"), {0.5f, 0.25f, 0.0f});
    EXPECT_NEAR(in_camera.x, 0.5f, 1e-6f) << "x is right";
    EXPECT_NEAR(in_camera.y, 0.25f, 1e-6f) << "y is up";
    EXPECT_NEAR(in_camera.z, 4.0f, 1e-6f) << "what is in front has positive z";

    const Mat4f to_ndc = matrix_of(spec, "worldToNDC");
    const Vec3f center = project(to_ndc, {0.0f, 0.0f, 0.0f});
    EXPECT_NEAR(center.x, 0.5f, 1e-6f);
    EXPECT_NEAR(center.y, 0.5f, 1e-6f);
    const Vec3f upper_left = project(to_ndc, {-2.0f, 4.0f / 3.0f, 0.0f});
    EXPECT_NEAR(upper_left.x, 0.0f, 1e-6f);
    EXPECT_NEAR(upper_left.y, 0.0f, 1e-6f);
    const Vec3f lower_right = project(to_ndc, {1.0f, -2.0f / 3.0f, 2.0f});
    EXPECT_NEAR(lower_right.x, 1.0f, 1e-6f);
    EXPECT_NEAR(lower_right.y, 1.0f, 1e-6f);
}

TEST(ExrDriver, NamesTheSpaceCanonically) {
    const TestFolder folder;
    OutputFrame frame = make_test_frame();
    frame.working_space = "lin_rec709";
    ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(frame);
    EXPECT_EQ(spec_of(folder / "a.exr").get_string_attribute("oiio:ColorSpace"), "Linear Rec.709 (sRGB)");
}

TEST(ExrDriver, WorksWithConfigsThatHideTheirPrimaries) {
    const TestFolder folder;
    std::ofstream(folder / "config.ocio") << "ocio_profile_version: 1\nsearch_path: \"\"\n"
                                             "roles: {default: linear, scene_linear: linear}\n"
                                             "displays:\n  s:\n    - !<View> {name: v, colorspace: linear}\n"
                                             "colorspaces:\n  - !<ColorSpace>\n    name: linear\n";
    OutputFrame frame = make_test_frame();
    frame.working_space = "linear";
    ExrDriver(folder / "a.exr", ColorConfig::from_file(folder / "config.ocio")).write(frame);
    EXPECT_EQ(spec_of(folder / "a.exr").find_attribute("chromaticities"), nullptr);
    EXPECT_EQ(spec_of(folder / "a.exr").get_string_attribute("oiio:ColorSpace"), "linear");
}

TEST(ExrDriver, ReportsFailures) {
    const TestFolder folder;
    OutputFrame frame = make_test_frame();
    EXPECT_THROW(ExrDriver(folder / "missing/a.exr", ColorConfig::built_in()).write(frame), IoError);
    frame.working_space = "no such space";
    EXPECT_THROW(ExrDriver(folder / "a.exr", ColorConfig::built_in()).write(frame), SceneError);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

}  // namespace

}  // namespace etendue
