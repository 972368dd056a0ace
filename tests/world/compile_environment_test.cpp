// Cube maps; constant and latitude-longitude environments are tested with the other lights.

#include "image/write.h"
#include "world/test_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr int kSide = 4;

/// A scene in a cube map whose face f is `colors[f]`, rgba from 0 to 255.
class CubeScene {
  public:
    explicit CubeScene(const std::array<std::array<int, 4>, 6>& colors) {
        scene.environment.enabled = true;
        scene.environment.cube.emplace();
        for (std::size_t f = 0; f < 6; ++f) {
            files_.push_back(temporary_file("etendue-cube-" + std::to_string(f) + ".png"));
            (void)add_texture(scene, files_.back(), kSide, std::vector(kSide * kSide, colors[f]));
            scene.environment.cube->faces[f].index = static_cast<std::int32_t>(f);
        }
    }
    ~CubeScene() {
        for (const std::filesystem::path& file : files_) std::filesystem::remove(file);
    }
    CubeScene(const CubeScene&) = delete;
    CubeScene& operator=(const CubeScene&) = delete;

    SceneDesc scene = empty_scene();

  private:
    std::vector<std::filesystem::path> files_;
};

const Vec3f kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Under the sRGB curve 255 is 1 and 188 is nearly a half.
constexpr float kHalf = 0.502886f;

TEST(CubeEnvironment, FacesLieAroundTheScene) {
    const CubeScene cube({{{255, 0, 0, 255},
                           {0, 255, 0, 255},
                           {0, 0, 255, 255},
                           {255, 255, 0, 255},
                           {0, 255, 255, 255},
                           {188, 188, 188, 255}}});
    const World world = compile(cube.scene);
    const Rgb expected[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, Rgb(kHalf)};
    for (std::size_t f = 0; f < 6; ++f) {
        const Rgb found = world.environment().radiance(world.environment().light(), kAxes[f]);
        EXPECT_NEAR(found.r, expected[f].r, 1e-5f) << f;
        EXPECT_NEAR(found.g, expected[f].g, 1e-5f) << f;
        EXPECT_NEAR(found.b, expected[f].b, 1e-5f) << f;
    }
    EXPECT_GT(world.environment().emission_pdf_solid_angle(world.environment().light(), {1, 0, 0}), 0.0f);
}

TEST(CubeEnvironment, AlphaDividesRadiance) {
    std::array<std::array<int, 4>, 6> colors;
    colors.fill({188, 255, 0, 51});
    colors[1] = {255, 255, 255, 0};
    CubeScene cube(colors);
    cube.scene.environment.cube->intensity = 3.0f;
    cube.scene.environment.scale = 2.0f;
    const World world = compile(cube.scene);
    const Rgb found = world.environment().radiance(world.environment().light(), {0, 1, 0});
    EXPECT_NEAR(found.r, kHalf * 5.0f * 6.0f, 1e-3f);
    EXPECT_NEAR(found.g, 30.0f, 1e-3f);
    EXPECT_EQ(found.b, 0.0f);
    EXPECT_TRUE(is_black(world.environment().radiance(world.environment().light(), {-1, 0, 0})))
        << "nothing can be divided by an alpha of 0";
}

TEST(CubeEnvironment, TurnsWithItsTransform) {
    std::array<std::array<int, 4>, 6> colors{};
    for (auto& color : colors) color = {0, 0, 0, 255};
    colors[0] = {255, 255, 255, 255};
    CubeScene cube(colors);
    Random random(3);
    for (int i = 0; i < 4; ++i) {
        Mat4f rotation;
        rotation.rotate(Vec3f(random.next(), random.next(), random.next()) * 6.0f);
        cube.scene.environment.cube->to_world = rotation;
        const World world = compile(cube.scene);
        EXPECT_NEAR(world.environment().radiance(world.environment().light(), transform_vector(rotation, {1, 0, 0})).g,
                    1.0f, 1e-5f);
        EXPECT_NEAR(world.environment().radiance(world.environment().light(), transform_vector(rotation, {-1, 0, 0})).g,
                    0.0f, 1e-5f);
        EXPECT_NEAR(
            world.environment().radiance(world.environment().light(), transform_vector(rotation, {0.1f, 0, 1})).g, 0.0f,
            1e-5f);
    }
}

TEST(CubeEnvironment, UnreadableFacesAreErrors) {
    CubeScene cube({});
    std::filesystem::remove(cube.scene.images[4].path);
    EXPECT_THROW((void)compile(cube.scene), SceneError);
}

// What half precision makes of a sun: it was bright, and is not to be black. The rest is no light.
TEST(EnvironmentImage, InfinitiesAreBrightAndWhatIsNoNumberIsDark) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const std::filesystem::path file = temporary_file("etendue-infinite-sun.exr");
    ImageF image(4, 2, 3);
    std::ranges::fill(image.pixels, 0.25f);
    std::ranges::fill(image.pixel(1, 0), kInfinity);
    std::ranges::fill(image.pixel(2, 0), kNan);
    image.pixel(3, 0)[1] = -kInfinity;
    write_image(file, image, {.depth = PixelDepth::Float});
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.image = file;
    ProblemList problems;
    const World world = compile(scene, kGltfColorSpace, problems);
    std::filesystem::remove(file);
    const auto told = [&](const char* text) {
        return std::ranges::any_of(problems.all(), [&](const Problem& problem) {
            return problem.severity == Severity::Warning && problem.message.find(text) != std::string::npos;
        });
    };
    EXPECT_TRUE(told("3 values of the environment image '"));
    EXPECT_TRUE(told("are infinite, and are taken for 65504"));
    EXPECT_TRUE(told("4 values of the environment image '"));
    EXPECT_TRUE(told("are no numbers, and are taken for 0"));
    float brightest = 0.0f;
    for (int i = 0; i < 64; ++i) {
        const float angle = static_cast<float>(i) * kPi / 32.0f;
        const Rgb seen = world.environment().radiance(world.environment().light(),
                                                      normalize(Vec3f(std::cos(angle), 1.0f, std::sin(angle))));
        EXPECT_TRUE(is_finite(seen));
        brightest = std::max(brightest, seen.r);
    }
    EXPECT_GT(brightest, 3e4f);
}

}  // namespace

}  // namespace etendue::test
