#include "session/checkpoint_files.h"

#include "core/error.h"
#include "program/small_files.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

const RenderIdentity kIdentity{{"seed", "1"}};
constexpr PixelRect kWindow{0, 0, 4, 3};

/// Of a render with so many samples, none of which has any light.
RenderState state_of(std::uint32_t spp) {
    return {.film = Film(4, 3, kWindow), .spp_done = spp};
}

CheckpointFiles::Expected expected() {
    return {.identity = kIdentity, .window = kWindow, .splat_window = kWindow};
}

/// What `step` complains of.
template <typename Error>
std::string message_of(const std::function<void()>& step) {
    try {
        step();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(CheckpointFiles, AnImageAndAPartOfOneNameHaveTheirOwn) {
    const TestFolder folder;
    CheckpointFiles(folder / "a.exr").write(kIdentity, "", state_of(1));
    CheckpointFiles(folder / "a.partial").write(kIdentity, "", state_of(2));
    EXPECT_EQ(list(folder.path()), (Names{"a.checkpoint", "a.partial.checkpoint"}));
    EXPECT_EQ(CheckpointFiles(folder / "a.exr").read(expected(), true)->state.spp_done, 1u);
    EXPECT_EQ(CheckpointFiles(folder / "a.partial").read(expected(), true)->state.spp_done, 2u);
    CheckpointFiles(folder / "a.partial").write(kIdentity, "", state_of(3));
    CheckpointFiles(folder / "a.exr").remove();
    EXPECT_EQ(list(folder.path()), (Names{"a.partial.checkpoint", "a.partial.checkpoint.previous"}));
    CheckpointFiles(folder / "a.partial").remove();
    EXPECT_TRUE(list(folder.path()).empty());
}

TEST(CheckpointFiles, WhatCannotBeRenamedIsAnErrorOfWriting) {
    const TestFolder folder;
    const CheckpointFiles files(folder / "a.exr");
    files.write(kIdentity, "", state_of(1));
    fs::create_directories(folder / "a.checkpoint.previous/taken");
    EXPECT_NE(message_of<IoError>([&] { files.write(kIdentity, "", state_of(2)); }).find("cannot rename"),
              std::string::npos);
    EXPECT_EQ(files.read(expected(), true)->state.spp_done, 1u) << "the one before stays";
}

/// As where the disk has an error: a directory in its place opens, but has no bytes.
TEST(CheckpointFiles, WhatCannotBeReadIsNoReasonToDoWithoutThePrevious) {
    const TestFolder folder;
    const CheckpointFiles files(folder / "a.exr");
    files.write(kIdentity, "", state_of(1));
    fs::rename(folder / "a.checkpoint", folder / "a.checkpoint.previous");
    fs::create_directories(folder / "a.checkpoint");
    EXPECT_EQ(files.read(expected(), true)->state.spp_done, 1u);
    EXPECT_EQ(files.read(expected(), true)->state.spp_done, 1u) << "and again";
    fs::remove(folder / "a.checkpoint.previous");
    EXPECT_NE(message_of<IoError>([&] { (void)files.read(expected(), true); }).find("cannot read"), std::string::npos)
        << "it may be readable the next time";
    fs::remove(folder / "a.checkpoint");
    EXPECT_EQ(files.read(expected(), true), std::nullopt);
}

TEST(CheckpointFiles, SayWhatToDoWithoutWhatTheLimitOfErrorNeeds) {
    const TestFolder folder;
    const CheckpointFiles files(folder / "a.exr");
    files.write(kIdentity, "", state_of(1));
    CheckpointFiles::Expected with_error = expected();
    with_error.every_other_pass = true;
    const std::string message = message_of<SceneError>([&] { (void)files.read(with_error, true); });
    EXPECT_NE(message.find("begun without --error"), std::string::npos) << message;
    EXPECT_NE(message.find("leave them out, or start anew without --resume"), std::string::npos) << message;
}

TEST(CheckpointFiles, AreNotGoneOnWithUniformlyIfTheyAreAdaptive) {
    const TestFolder folder;
    const CheckpointFiles files(folder / "a.exr");
    RenderState state = state_of(2);
    state.adaptive = {.passes = 1, .samples = std::vector<std::uint32_t>(kWindow.area(), 2)};
    state.adaptive.samples.back() = 18;
    files.write(kIdentity, "", state);
    const std::string message = message_of<SceneError>([&] { (void)files.read(expected(), true); });
    EXPECT_NE(message.find("is of an adaptive render"), std::string::npos) << message;
    CheckpointFiles::Expected adaptive = expected();
    adaptive.adaptive = true;
    EXPECT_EQ(files.read(adaptive, true)->state.adaptive.samples, state.adaptive.samples);
}

TEST(ReadPart, RefusesMoreSamplesThanAreAskedForAndThoseOfAPassUnderWay) {
    const TestFolder folder;
    RenderState state = state_of(6);
    CheckpointFiles::Expected eight = expected();
    eight.most_spp = 8;
    write_checkpoint(folder / "a.partial", kIdentity, "", state);
    EXPECT_EQ(read_part(folder / "a.partial", eight, true)->state.spp_done, 6u);
    state.pass_size = 3;
    state.tiles_done = {0};
    write_checkpoint(folder / "a.partial", kIdentity, "", state);
    const std::string message = message_of<SceneError>([&] { (void)read_part(folder / "a.partial", eight, true); });
    EXPECT_NE(message.find("has 9 samples of each pixel, and no more than 8"), std::string::npos) << message;
    EXPECT_EQ(read_part(folder / "b.partial", eight, true), std::nullopt);
}

}  // namespace

}  // namespace etendue::test
