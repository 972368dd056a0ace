// A render of a file that Blender 3.4 has written, where the folder with it is present.
#include "image/read_channels.h"
#include "program/run_program.h"
#include "program/small_files.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

// White surfaces under a white sky are as bright as the sky, whatever their normals are. What smooth normals send
// through the faces of these primitives would be missing: 10% of the cube's light, and whole faces of the cylinder.
TEST(RenderedBlenderCases, CoarseSmoothMeshesLoseNoLight) {
    const fs::path from = fs::path(ETENDUE_SHARED_ASSETS) / "../cases/blender/smooth_coarse/scene.glb";
    if (!fs::exists(from)) GTEST_SKIP() << from << " is not there";
    const TestFolder folder;
    const fs::path work = folder / "work";
    fs::create_directories(work);
    fs::create_directories(folder / "case");
    write_file(folder / "case/scene.glb", read_file(from));
    write_file(folder / "case/render.json", R"({
        "environment": {"color": [1, 1, 1]}, "film": {"filter": "box"}, "lights": {"Sun": {"enabled": false}},
        "materials": {"G": {"diffuse": {"albedo": [1, 1, 1]}}, "M": {"diffuse": {"albedo": [1, 1, 1]}},
                      "Met": {"diffuse": {"albedo": [1, 1, 1]}}}})");
    const ProgramResult result =
        run_etendue({"render", (folder / "case").string(), "--size", "64x64", "--spp", "64", "--integrator", "path",
                     "--working-space", "lin_rec709", "--aov", "object_id", "--float", "--quiet", "-o", "a.exr"},
                    work);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ChannelImage image = read_channels(work / "a.exr");
    const auto index_of = [&](const char* channel) {
        const auto found = std::ranges::find(image.channel_names, channel);
        EXPECT_NE(found, image.channel_names.end()) << channel;
        return static_cast<std::size_t>(found - image.channel_names.begin());
    };
    const std::size_t green = index_of("G");
    const std::size_t id = index_of("object_id.X");
    ASSERT_FALSE(HasFailure());
    struct Sum {
        double light = 0.0;
        std::size_t pixels = 0;
    };
    std::map<float, Sum> objects;
    float darkest = 1.0f;
    for (std::size_t p = 0; p < image.pixels.pixels.size(); p += image.channel_names.size()) {
        const float value = image.pixels.pixels[p + green];
        Sum& sum = objects[image.pixels.pixels[p + id]];
        sum.light += static_cast<double>(value);
        ++sum.pixels;
        darkest = std::min(darkest, value);
    }
    EXPECT_GE(objects.size(), 6u) << "the floor and five primitives";
    // Of 64 samples, a pixel's mean is off by less than 0.06 as a standard deviation.
    EXPECT_GT(darkest, 0.7f);
    for (const auto& [object, sum] : objects)
        EXPECT_NEAR(sum.light / static_cast<double>(sum.pixels), 1.0, 0.01) << object << " of " << sum.pixels;
}

}  // namespace

}  // namespace etendue::test
