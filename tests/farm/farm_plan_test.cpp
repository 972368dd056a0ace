#include "farm/farm_plan.h"

#include "farm/farm_needs.h"
#include "program/small_files.h"
#include "session/prepared_scene.h"

#include <algorithm>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

FarmImage image(int number, std::uint32_t parts, TaskNeeds needs = {10, 512}) {
    FarmImage result;
    result.job.scene = "/scenes/s";
    result.job.output = fmt::format("/out/s.{:04}.exr", number);
    result.job.frame = number;
    result.render_output = "/out/s.exr";
    if (parts > 1) result.ranges = split_samples(64, parts);
    result.missing = result.ranges;
    result.needs = needs;
    return result;
}

FarmPlan plan(const std::vector<FarmImage>& images, std::size_t max_array_size = 1001) {
    FarmOptions options;
    options.program = "/bin/etendue";
    options.output = "/out";
    options.options = {{"--spp", "64"}};
    options.threads = 8;
    return plan_farm(images, options, max_array_size);
}

/// Each task of each image stands where the plan says, once, and no array is too long.
void expect_consistent(const FarmPlan& plan, const std::vector<FarmImage>& images, std::size_t max_array_size) {
    std::set<std::pair<std::size_t, std::size_t>> used;
    std::size_t tasks = 0;
    for (const JobArray& array : plan.arrays) {
        EXPECT_FALSE(array.commands.empty());
        EXPECT_LE(array.commands.size(), max_array_size);
        tasks += array.commands.size();
    }
    for (std::size_t i = 0; i < images.size(); ++i) {
        EXPECT_EQ(plan.places[i].size(), images[i].missing.size() + 1) << i;
        EXPECT_EQ(plan.places[i].back().makes, images[i].job.output);
        for (const TaskPlace& place : plan.places[i]) {
            EXPECT_TRUE(used.insert({place.array, place.index}).second);
            const std::string& command = plan.arrays[place.array].commands[place.index];
            EXPECT_NE(command.find(fmt::format("s.{:04}.exr", *images[i].job.frame)), std::string::npos) << command;
        }
    }
    EXPECT_EQ(used.size(), tasks);
}

TEST(FarmPlan, AnImageInOnePieceIsOneTask) {
    FarmImage still = image(7, 1);
    still.job.frame.reset();
    const FarmPlan one = plan({still});
    ASSERT_EQ(one.arrays.size(), 1u);
    EXPECT_EQ(one.arrays[0].commands[0],
              "exec '/bin/etendue' render '/scenes/s' -o '/out/s.exr' --resume --checkpoint-every '5' --threads '8' "
              "--quiet --spp '64'");
    const FarmPlan frame = plan({image(7, 1)});
    EXPECT_NE(frame.arrays[0].commands[0].find("--frames '7' -o '/out/s.exr'"), std::string::npos);
}

TEST(FarmPlan, PartsOfOneImageHaveOneIndexAndAreMergedByIt) {
    const std::vector<FarmImage> images{image(0, 2), image(1, 2), image(2, 2)};
    const FarmPlan two = plan(images);
    ASSERT_EQ(two.arrays.size(), 3u);
    for (std::size_t i = 0; i < images.size(); ++i)
        for (const TaskPlace& place : two.places[i]) EXPECT_EQ(place.index, i);
    EXPECT_EQ(two.arrays[2].wait, ArrayWait::SameTask);
    EXPECT_EQ(two.arrays[2].after, (std::vector<std::size_t>{0, 1}));
    const std::string& part = two.arrays[1].commands[2];
    EXPECT_NE(part.find("--frames '2' -o '/out/.etendue/parts/s.0002.exr/32-64.partial' --samples '32:64'"),
              std::string::npos)
        << part;
    EXPECT_EQ(two.arrays[2].commands[2],
              "if [ -e '/out/.etendue/parts/s.0002.exr' ] || ! [ -e '/out/s.0002.json' ]; then "
              "env -u ETENDUE_ISA '/bin/etendue' merge '/out/.etendue/parts/s.0002.exr/0-32.0002.partial' "
              "'/out/.etendue/parts/s.0002.exr/32-64.0002.partial' -o '/out/s.0002.exr' --quiet && "
              "rm -rf -- '/out/.etendue/parts/s.0002.exr.merged' && "
              "mv -T -- '/out/.etendue/parts/s.0002.exr' '/out/.etendue/parts/s.0002.exr.merged'; fi && "
              "rm -rf -- '/out/.etendue/parts/s.0002.exr.merged'");
    EXPECT_EQ(two.places[2][1].makes, "/out/.etendue/parts/s.0002.exr/32-64.0002.partial");
}

TEST(FarmPlan, ArraysAreCutWhereTheClusterEndsThem) {
    std::vector<FarmImage> images;
    images.reserve(25);
    for (int i = 0; i < 25; ++i) images.push_back(image(i, 3));
    const FarmPlan cut = plan(images, 10);
    EXPECT_EQ(cut.arrays.size(), 3u * 4u);
    expect_consistent(cut, images, 10);
    // Merges wait for the parts of their own images.
    for (const JobArray& array : cut.arrays)
        for (const std::size_t other : array.after) EXPECT_EQ(cut.arrays[other].commands.size(), array.commands.size());
}

TEST(FarmPlan, TheNumberOfArraysDoesNotGrowWithThatOfImages) {
    std::vector<FarmImage> few;
    std::vector<FarmImage> many;
    for (int i = 0; i < 900; ++i) {
        const TaskNeeds needs{10 + i % 5, 512 + i % 300};
        if (i < 10) few.push_back(image(i, 4, needs));
        many.push_back(image(i, 4, needs));
    }
    EXPECT_EQ(plan(few).arrays.size(), plan(many).arrays.size());
    expect_consistent(plan(many), many, 1001);
}

TEST(FarmPlan, SmallScenesDoNotAskForWhatLargeOnesNeed) {
    const std::vector<FarmImage> images{image(0, 1, {10, 600}), image(1, 1, {10, 60000}), image(2, 1, {12, 700})};
    const FarmPlan mixed = plan(images);
    ASSERT_EQ(mixed.arrays.size(), 2u);
    EXPECT_EQ(mixed.places[0][0].array, mixed.places[2][0].array);
    EXPECT_EQ(mixed.arrays[mixed.places[0][0].array].needs, (TaskNeeds{12, 700}));
    EXPECT_EQ(mixed.arrays[mixed.places[1][0].array].needs, (TaskNeeds{10, 60000}));
}

TEST(FarmPlan, MergesGetWhatTheyNeedThemselves) {
    std::vector<FarmImage> images{image(0, 2, {10, 60000}), image(1, 2, {10, 60001})};
    images[0].merge_needs = {70, 900};
    images[1].merge_needs = {20, 1000};
    const FarmPlan two = plan(images);
    ASSERT_EQ(two.arrays.size(), 3u);
    EXPECT_EQ(two.arrays[1].needs, (TaskNeeds{10, 60001}));
    EXPECT_EQ(two.arrays[2].needs, (TaskNeeds{70, 1000}));
}

TEST(FarmNeeds, OfMergesGrowWithPixelsAndParts) {
    EXPECT_EQ(merge_needs_of({.pixels = 1000}, 2), (TaskNeeds{kLeastMinutes, kLeastMebibytes}));
    constexpr std::uint64_t kPixels = 100'000'000;
    // By hand: 3 x (0.223 + 100 x (0.32 + 0.122 x 300)) s, and 1.5 x (3 films of 48 bytes a pixel, and 80 to write it).
    EXPECT_EQ(merge_needs_of({.pixels = kPixels}, 300), (TaskNeeds{185, 32044}));
    // Parts are half as large again: 100 x 0.122 x 300 x 24 / 48 s and 1.5 x 3 x 24 bytes more.
    EXPECT_EQ(merge_needs_of({.pixels = kPixels, .splat_pixels = kPixels}, 300), (TaskNeeds{277, 42344}));
}

TEST(FarmNeeds, OfLayersAreThoseOfTheirSumsAndChannels) {
    const TestFolder folder;
    write_scene(folder / "box",
                R"("integrator": {"type": "path"}, "aovs": ["passes", "depth", "variance", "denoising"], )");
    const FilmSize path = film_size_of(prepare_scene(folder / "box", {}).scene);
    EXPECT_TRUE(path.has_second_film);
    // Ten layers of light, seven sums for the variance, two averaged features of three channels; the distance and a
    // number.
    EXPECT_EQ(path.layers.bytes(), 8u * (3 * 10 + 7 + 3 + 3) + 4u * 2);
    EXPECT_EQ(path.bytes(), 16u * 12u * (48 + path.layers.bytes()));
    EXPECT_EQ(path.channels, 2u * (4 + 30 + 1 + 3 + 3 + 3));
    SettingsOverrides bdpt;
    bdpt.give("--integrator", "bdpt");
    const FilmSize splats = film_size_of(prepare_scene(folder / "box", bdpt).scene);
    EXPECT_EQ(splats.bytes() - path.bytes(), 16u * 12u * 24 * (1 + 10 + 1));
    const RenderProbe probe{.render_seconds = 1.0};
    const FilmSize plain{.pixels = 10'000'000};
    FilmSize layered = path;
    layered.pixels = plain.pixels;
    EXPECT_GT(needs_of(probe, layered, 1.0, 1).mebibytes, 5 * needs_of(probe, plain, 1.0, 1).mebibytes);
    EXPECT_GT(merge_needs_of(layered, 2).mebibytes, 5 * merge_needs_of(plain, 2).mebibytes);
    EXPECT_GT(merge_needs_of(layered, 200).minutes, merge_needs_of(plain, 200).minutes);
}

// A second of a long render has met few depths; the file is as large as the film.
TEST(FarmNeeds, OfDeepImagesHaveRoomForTheDepthsThatAreToCome) {
    constexpr std::uint64_t kPixels = 1'000'000;
    const FilmSize path{.pixels = kPixels, .layers = {.is_deep = true}};
    const FilmSize bdpt{.pixels = kPixels, .splat_pixels = kPixels, .layers = {.is_deep = true}};
    EXPECT_EQ(path.deep_bytes(), kPixels * (24 + 16 * 64));
    EXPECT_EQ(bdpt.deep_bytes(), kPixels * (24 + 32 * 64));
    EXPECT_EQ(bdpt.bytes(), kPixels * (48 + 24) + bdpt.deep_bytes());
    FilmSize halves = bdpt;
    halves.has_second_film = true;
    EXPECT_EQ(halves.second_bytes(), kPixels * (48 + 24)) << "half of the samples have no depths";
    const auto mebibytes = [](const FilmSize& size, std::uint64_t deep_bytes) {
        const RenderProbe probe{.peak_memory_bytes = std::uint64_t{1} << 30, .deep_bytes = deep_bytes};
        return needs_of(probe, size, 1.0, 1).mebibytes;
    };
    const int plain = mebibytes({.pixels = kPixels}, 0);
    const double writing = 3.0 * 16 * 24 * kPixels;
    const auto growth = static_cast<double>(path.deep_bytes());
    EXPECT_NEAR(mebibytes(path, 0) - plain, 1.5 * (growth + writing) / (1 << 20), 1.0);
    EXPECT_NEAR(mebibytes(path, path.deep_bytes()) - plain, 1.5 * writing / (1 << 20), 1.0);
    EXPECT_EQ(mebibytes(path, 2 * path.deep_bytes()), mebibytes(path, path.deep_bytes()));
}

TEST(FarmNeeds, OfRendersHaveRoomForWritingAndForASecondFilm) {
    const RenderProbe probe{.render_seconds = 10.0, .peak_memory_bytes = std::uint64_t{1} << 30};
    constexpr std::uint64_t kPixels = 50'000'000;
    const TaskNeeds none = needs_of(probe, {}, 1.0, 1);
    const TaskNeeds some = needs_of(probe, {.pixels = kPixels}, 1.0, 1);
    const TaskNeeds two = needs_of(probe, {.pixels = kPixels, .has_second_film = true}, 1.0, 1);
    EXPECT_EQ(none.mebibytes, 1536);
    EXPECT_GT(some.mebibytes, none.mebibytes);
    EXPECT_NEAR(two.mebibytes - some.mebibytes, 1.5 * 48.0 * kPixels / (1 << 20), 1.0);
}

TEST(FarmNeeds, WarningsAreLongEnoughToWriteTheFilms) {
    constexpr std::uint64_t kPixels = 100'000'000;
    EXPECT_EQ(warning_seconds_for({.pixels = 1000}), kLeastWarningSeconds);
    // By hand: 48 bytes a pixel and film, 50 MB a second.
    EXPECT_EQ(warning_seconds_for({.pixels = kPixels}), 60 + 96);
    EXPECT_EQ(warning_seconds_for({.pixels = kPixels, .has_second_film = true}), 60 + 192);
    EXPECT_EQ(warning_seconds_for({.pixels = 1000 * kPixels}), 65535) << "Slurm takes no more";
    std::vector<FarmImage> images{image(0, 2), image(1, 2)};
    images[1].needs.warning_seconds = 156;
    const FarmPlan two = plan(images);
    ASSERT_EQ(two.arrays.size(), 3u);
    EXPECT_EQ(two.arrays[1].needs.warning_seconds, 156);
    EXPECT_EQ(two.arrays[2].needs.warning_seconds, kLeastWarningSeconds) << "a merge has no checkpoint";
}

TEST(FarmPlan, OnlyMissingPartsAreMended) {
    std::vector<FarmImage> images{image(0, 4), image(1, 4), image(2, 4), image(3, 4)};
    images[1].missing = {images[1].ranges[2]};
    images[2].missing = {images[2].ranges[0], images[2].ranges[3]};
    images[3].missing = {};
    const FarmPlan mended = plan(images);
    expect_consistent(mended, images, 1001);
    // Four arrays of parts and one of merges for the first, one of each for the others.
    ASSERT_EQ(mended.arrays.size(), 7u);
    EXPECT_EQ(mended.arrays[5].commands.size(), 3u);
    EXPECT_EQ(mended.arrays[6].commands.size(), 3u);
    EXPECT_EQ(mended.arrays[6].wait, ArrayWait::AllTasks);
    const FarmPlan merge = plan({images[3]});
    ASSERT_EQ(merge.arrays.size(), 1u);
    EXPECT_EQ(merge.arrays[0].wait, ArrayWait::No);
    expect_consistent(plan(images, 2), images, 2);
}

}  // namespace

}  // namespace etendue::test
