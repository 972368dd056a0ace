// Renders that are stopped and gone on with, and parts that are merged, from outside.
#include "process/run_command.h"
#include "program/run_program.h"
#include "program/small_files.h"
#include "render/checkpoint.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;
using Arguments = std::vector<std::string>;

void sleep_ms(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

class Continuation : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult run(Arguments arguments, const std::function<void(int pid)>& while_running = {}) const {
        return run_etendue(arguments, work_, while_running);
    }
    /// A render of `spp` samples per pixel to `output`.
    [[nodiscard]] Arguments render(int spp, const std::string& output, const Arguments& more = {}) const {
        Arguments arguments{"render", (folder_ / "box").string(), "--size",  "40x30",
                            "--spp",  fmt::format("{}", spp),     "--float", "-o",
                            output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    /// Larger of the mean squares of differences between two images, absolute and relative.
    [[nodiscard]] double difference(const std::string& a, const std::string& b) const {
        const ProgramResult result = run({"diff", a, b, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const json measures = json::parse(result.out)["measures"];
        return std::max(measures["mse"]["value"].get<double>(), measures["relmse"]["value"].get<double>());
    }
    /// Interrupts a render of `arguments` after `milliseconds`, or so much later that it has left a checkpoint: on a
    /// busy machine there may be no sample before.
    [[nodiscard]] ProgramResult interrupt(const Arguments& arguments, int milliseconds) const {
        constexpr int kLongest = 60'000;
        for (;; milliseconds *= 2) {
            ProgramResult result = run(arguments, [&](int pid) {
                sleep_ms(milliseconds);
                kill(pid, SIGINT);
            });
            const bool has_checkpoint = std::ranges::any_of(
                fs::directory_iterator(work_),
                [](const fs::directory_entry& entry) { return entry.path().extension() == ".checkpoint"; });
            if (has_checkpoint || result.exit_code == 0 || milliseconds > kLongest) return result;
        }
    }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

class ContinuationOf : public Continuation, public testing::WithParamInterface<std::string> {};

TEST_P(ContinuationOf, ResumesToTheSameBytes) {
    constexpr int kSpp = 500;
    const Arguments with{"--integrator", GetParam(), "--aov", "direct", "--aov", "variance", "--aov", "denoising"};
    ASSERT_EQ(run(render(kSpp, "whole.exr", with)).exit_code, 0);
    Arguments first = render(kSpp, "a.exr", with);
    // On one thread, so that it is long enough to be stopped on many.
    first.insert(first.end(), {"--checkpoint-every", "0.0003", "--threads", "1"});
    const ProgramResult stopped = run(first, [&](int pid) {
        for (int i = 0; i < 3000 && !fs::exists(work_ / "a.checkpoint"); ++i) sleep_ms(5);
        kill(pid, SIGINT);
    });
    ASSERT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_NE(stopped.err.find("--resume"), std::string::npos) << stopped.err;
    ASSERT_TRUE(fs::exists(work_ / "a.checkpoint")) << "it was not stopped in the middle";
    EXPECT_EQ(json::parse(read_file(work_ / "a.json"))["complete"], false);
    Arguments again = render(kSpp, "a.exr", with);
    again.insert(again.end(), {"--resume", "--threads", "3"});
    const ProgramResult resumed = run(again);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_NE(resumed.err.find("going on after"), std::string::npos) << resumed.err;
    EXPECT_EQ(difference("a.exr", "whole.exr"), 0.0);
    EXPECT_EQ(read_file(work_ / "a.png"), read_file(work_ / "whole.png"));
    EXPECT_FALSE(fs::exists(work_ / "a.checkpoint"));
    // What is done is left alone.
    EXPECT_NE(run(again).err.find("up to date"), std::string::npos);
}

TEST_P(ContinuationOf, PartsMergeToTheSingleImage) {
    const Arguments with{"--integrator", GetParam(), "--quiet"};
    ASSERT_EQ(run(render(20, "whole.exr", with)).exit_code, 0);
    for (const char* range : {"0:7", "7:16", "16:20"}) {
        Arguments part = render(20, fmt::format("{}.partial", range), with);
        part.insert(part.end(), {"--samples", range});
        ASSERT_EQ(run(part).exit_code, 0);
    }
    for (const auto& [name, crop] : {std::pair{"left", "0,0,13,30"}, {"top", "13,0,40,9"}, {"right", "13,9,40,30"}}) {
        Arguments part = render(20, fmt::format("{}.partial", name), with);
        part.insert(part.end(), {"--crop", crop});
        ASSERT_EQ(run(part).exit_code, 0);
    }
    for (const Arguments& parts : {Arguments{"16:20.partial", "0:7.partial", "7:16.partial"},
                                   Arguments{"top.partial", "right.partial", "left.partial"}}) {
        Arguments merge{"merge"};
        merge.insert(merge.end(), parts.begin(), parts.end());
        // With the parts' 32-bit floats.
        merge.insert(merge.end(), {"--quiet", "-o", "merged.exr"});
        const ProgramResult merged = run(merge);
        ASSERT_EQ(merged.exit_code, 0) << merged.err;
        // Squares of relative differences of 1e-6.
        EXPECT_LT(difference("merged.exr", "whole.exr"), 1e-12) << parts.front();
        const json one = json::parse(read_file(work_ / "whole.json"));
        const json sum = json::parse(read_file(work_ / "merged.json"));
        for (const char* key : {"size", "full_size", "samples", "rays", "complete", "spp"})
            EXPECT_EQ(one[key], sum[key]) << key;
        for (const char* key : {"settings_hash", "settings", "requested_settings"})
            EXPECT_EQ(one[key], sum[key]) << key;
    }
    // Parts of parts.
    ASSERT_EQ(run({"merge", "0:7.partial", "7:16.partial", "-o", "sum.partial"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "sum.partial", "16:20.partial", "-o", "merged.exr"}).exit_code, 0);
    EXPECT_LT(difference("merged.exr", "whole.exr"), 1e-12);
    ASSERT_EQ(run({"merge", "sum.partial", "16:20.partial", "--half", "-o", "merged.exr"}).exit_code, 0);
    EXPECT_GT(difference("merged.exr", "whole.exr"), 1e-10) << "in 16 bits";
}

INSTANTIATE_TEST_SUITE_P(Integrators, ContinuationOf, testing::Values("path", "light", "bdpt", "vcm"),
                         [](const auto& test) { return test.param; });

TEST_F(Continuation, CheckpointsOutliveAKill) {
    constexpr int kSpp = 4000;
    const Arguments every{"--checkpoint-every", "0.0003", "--resume"};  // 20 ms
    ASSERT_EQ(run(render(kSpp, "whole.exr")).exit_code, 0);
    std::mt19937 random(5);
    int killed = 0;
    const fs::path checkpoint = work_ / "a.checkpoint";
    for (int attempt = 0; attempt < 5; ++attempt) {
        const auto time = [&] {
            return fs::exists(checkpoint) ? fs::last_write_time(checkpoint) : fs::file_time_type{};
        };
        const ProgramResult result = run(render(kSpp, "a.exr", every), [&, before = time()](int pid) {
            // Once it has gone on, however slow the machine is.
            for (int i = 0; i < 6000 && time() == before && !fs::exists(work_ / "a.json"); ++i) sleep_ms(1);
            sleep_ms(static_cast<int>(random() % 40));
            kill(pid, SIGKILL);
        });
        if (result.exit_code == 1000 + SIGKILL) ++killed;
    }
    EXPECT_GE(killed, 2);
    EXPECT_EQ(run(render(kSpp, "a.exr", every)).exit_code, 0);
    EXPECT_EQ(difference("a.exr", "whole.exr"), 0.0);
    EXPECT_EQ(list(work_), (Names{"a.exr", "a.json", "a.png", "whole.exr", "whole.json", "whole.png"}));
}

TEST_F(Continuation, RefusesTheCheckpointOfAnotherRenderAndSaysWhatDiffers) {
    const Arguments stop = render(1000000, "a.exr");
    ASSERT_EQ(interrupt(stop, 60).exit_code, 130);
    const auto refused = [&](const Arguments& more) {
        Arguments arguments = stop;
        arguments.insert(arguments.end(), more.begin(), more.end());
        arguments.insert(arguments.end(), {"--resume", "--quiet"});
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 3) << result.err;
        return result.err;
    };
    EXPECT_NE(refused({"--seed", "4"}).find("seed: '0' there, '4' here"), std::string::npos);
    EXPECT_NE(refused({"--integrator", "bdpt"}).find("integrator"), std::string::npos);
    EXPECT_NE(refused({"--max-depth", "3"}).find("integrator.max_depth: '32' there, '3' here"), std::string::npos);
    EXPECT_NE(refused({"--crop", "0,0,8,8"}).find("pixels: '0,0,40,30' there, '0,0,8,8' here"), std::string::npos);
    EXPECT_NE(refused({"--error", "0.1"}).find("begun without --error"), std::string::npos);
    EXPECT_NE(refused({"--working-space", "lin_rec709"}).find("color.working_space"), std::string::npos);
    std::string bytes = read_file(folder_ / "box/triangle.bin");
    bytes[0] = static_cast<char>(bytes[0] ^ 1);
    write_file(folder_ / "box/triangle.bin", bytes);
    EXPECT_NE(refused({}).find("triangle.bin"), std::string::npos);
    bytes[0] = static_cast<char>(bytes[0] ^ 1);
    write_file(folder_ / "box/triangle.bin", bytes);
    // How long and how it is shown may change.
    Arguments other = render(50, "a.exr", {"--exposure", "1", "--threads", "1", "--resume", "--time", "100"});
    const ProgramResult result = run(other);
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(Continuation, FallsBackToThePreviousCheckpoint) {
    const Arguments every = render(1000000, "a.exr", {"--checkpoint-every", "0.0005", "--resume"});
    const ProgramResult interrupted = run(every, [&](int pid) {
        for (int i = 0; i < 6000 && !fs::exists(work_ / "a.checkpoint.previous"); ++i) sleep_ms(10);
        kill(pid, SIGINT);
    });
    ASSERT_EQ(interrupted.exit_code, 130) << interrupted.err;
    ASSERT_TRUE(fs::exists(work_ / "a.checkpoint.previous"));
    const auto damage = [&](const std::string& name) {
        std::string bytes = read_file(work_ / name);
        bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 8);
        write_file(work_ / name, bytes);
    };
    damage("a.checkpoint");
    const Arguments once = render(1000000, "a.exr", {"--resume"});
    RunningProgram going_on(once, work_);
    EXPECT_TRUE(wait_until(
        [&] { return going_on.has_ended() || going_on.messages().find("going on after") != std::string::npos; }));
    going_on.send(SIGINT);
    const ProgramResult fallen = going_on.wait();
    EXPECT_EQ(fallen.exit_code, 130);
    EXPECT_NE(fallen.err.find("a.checkpoint is damaged"), std::string::npos) << fallen.err;
    damage("a.checkpoint");
    // A run that is stopped at once leaves none.
    if (fs::exists(work_ / "a.checkpoint.previous")) damage("a.checkpoint.previous");
    const ProgramResult lost = run(once);
    EXPECT_EQ(lost.exit_code, 3);
    EXPECT_NE(lost.err.find("no other checkpoint is left"), std::string::npos) << lost.err;
}

TEST_F(Continuation, ShowsAPreviewAndGoesOn) {
    const ProgramResult result = run(render(1000000, "a.exr"), [&](int pid) {
        kill(pid, SIGUSR1);
        for (int i = 0; i < 500 && !fs::exists(work_ / "a.preview.png"); ++i) sleep_ms(10);
        kill(pid, SIGTERM);
    });
    EXPECT_EQ(result.exit_code, 143) << result.err;
    EXPECT_NE(result.err.find("a.preview.png: preview after"), std::string::npos) << result.err;
}

TEST_F(Continuation, RemovesThePreviewOfAFinishedImage) {
    write_file(work_ / "a.preview.png", "as SIGUSR1 left it");
    EXPECT_EQ(run(render(1, "a.exr")).exit_code, 0);
    EXPECT_FALSE(fs::exists(work_ / "a.preview.png"));
    EXPECT_EQ(run(render(1, "a.preview.exr")).exit_code, 0);
    EXPECT_EQ(run(render(1, "a.exr")).exit_code, 0);
    EXPECT_TRUE(fs::exists(work_ / "a.preview.png")) << "it is another image's";
}

TEST_F(Continuation, AFinishedImageKeepsTheCheckpointOfALongerRender) {
    ASSERT_EQ(run(render(8, "a.exr")).exit_code, 0);
    (void)run(render(1000000, "a.exr", {"--resume", "--checkpoint-every", "0.0003"}), [&](int pid) {
        for (int i = 0; i < 3000 && !fs::exists(work_ / "a.checkpoint"); ++i) sleep_ms(5);
        kill(pid, SIGKILL);
    });
    ASSERT_TRUE(fs::exists(work_ / "a.checkpoint"));
    const ProgramResult result = run(render(8, "a.exr", {"--resume"}));
    EXPECT_NE(result.err.find("up to date"), std::string::npos) << result.err;
    EXPECT_TRUE(fs::exists(work_ / "a.checkpoint"));
}

TEST_F(Continuation, RendersBetweenCheckpointsHoweverOftenTheyAreAskedFor) {
    EXPECT_EQ(run(render(4, "a.exr", {"--checkpoint-every", "1e-8"})).exit_code, 0);
}

TEST_F(Continuation, APreviewReplacesNoImage) {
    ASSERT_EQ(run(render(1, "a.preview.exr")).exit_code, 0);
    const std::string before = read_file(work_ / "a.preview.png");
    // A pause writes a preview before a checkpoint.
    const ProgramResult result = run(render(1000000, "a.exr", {"--checkpoint-every", "0.0003"}), [&](int pid) {
        kill(pid, SIGUSR1);
        for (int i = 0; i < 3000 && !fs::exists(work_ / "a.checkpoint"); ++i) sleep_ms(5);
        kill(pid, SIGTERM);
    });
    EXPECT_NE(result.err.find("no preview was written"), std::string::npos) << result.err;
    EXPECT_EQ(read_file(work_ / "a.preview.png"), before);
}

/// The choice is as good as any name in the file of the first frame, and there none.
TEST_F(Continuation, ASequenceHasTheIntegratorOfItsFirstFrame) {
    (void)animated_scene((folder_ / "box").string());
    const auto frame = [&](int number, const Arguments& more) {
        Arguments all{"--frames", fmt::format("{0}:{0}", number), "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_EQ(run(render(1, "a.exr", all)).exit_code, 0);
        return json::parse(read_file(work_ / fmt::format("a.{:04}.json", number)));
    };
    const std::string choice = frame(2, {"--first-frame", "1"})["integrator_choice"];
    EXPECT_TRUE(choice.ends_with(" in frame 1, the first")) << choice;
    json statistics = json::parse(read_file(work_ / "a.0002.json"));
    statistics["integrator"] = "vcm";
    write_file(work_ / "a.0002.json", statistics.dump());
    EXPECT_EQ(frame(3, {"--first-frame", "1"})["integrator_choice"], "'vcm', as in frame 2");
    EXPECT_EQ(json::parse(read_file(work_ / "a.0003.json"))["integrator"], "vcm");
    const std::string other = frame(4, {"--seed", "3"})["integrator_choice"];
    EXPECT_EQ(other.find("in frame"), std::string::npos) << "other settings, another sequence: " << other;
}

TEST_F(Continuation, StopsAtTheErrorThatWasAskedFor) {
    const ProgramResult result = run(render(100000, "a.exr", {"--error", "0.2", "--json", "--quiet"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json statistics = json::parse(result.out);
    EXPECT_EQ(statistics["halt_reason"], "error reached");
    EXPECT_LE(statistics["estimated_relative_error"].get<double>(), 0.2);
    EXPECT_EQ(statistics["complete"], true);
}

TEST_F(Continuation, GivesPixelsDifferentNumbersOfSamplesUnlessToldNotTo) {
    const auto statistics = [&](const Arguments& more) {
        Arguments arguments = render(100000, "a.exr", {"--error", "0.008", "--json", "--quiet"});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out);
    };
    const json adaptive = statistics({})["adaptive"];
    ASSERT_TRUE(adaptive.is_object());
    EXPECT_GE(adaptive["least"], 48);
    EXPECT_LE(adaptive["most"], 100000);
    EXPECT_LT(adaptive["least"].get<double>(), adaptive["mean"].get<double>());
    EXPECT_LT(adaptive["mean"].get<double>(), adaptive["most"].get<double>());
    EXPECT_TRUE(statistics({"--no-adaptive"})["adaptive"].is_null());
    EXPECT_TRUE(statistics({"--min-spp", "100000"})["adaptive"].is_null());
}

TEST_F(Continuation, ASinglePixelIsRenderedToItsErrorToo) {
    const ProgramResult result = run(render(200, "one.exr", {"--crop", "28,15,29,16", "--error", "1e-6", "--json"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["spp"]["done"], 200) << "an error that is out of reach takes all samples";
    EXPECT_NE(result.err.find(" in place of 1e-06: all 200 samples were taken first; give a larger --spp"),
              std::string::npos)
        << result.err;
}

TEST_F(Continuation, RefusesPartsThatDoNotBelongTogether) {
    const auto part = [&](const std::string& name, const Arguments& more) {
        Arguments arguments = render(16, name + ".partial", more);
        arguments.push_back("--quiet");
        EXPECT_EQ(run(arguments).exit_code, 0) << name;
    };
    part("a", {"--samples", "0:8"});
    part("b", {"--samples", "7:16"});
    part("seed", {"--samples", "8:16", "--seed", "4"});
    part("left", {"--crop", "0,0,20,30"});
    part("right", {"--crop", "20,0,40,30"});
    part("middle", {"--crop", "10,0,30,30"});
    part("corner", {"--crop", "20,0,40,20"});
    part("short", {"--crop", "20,0,40,30", "--samples", "0:8"});
    part("later", {"--samples", "10:16"});
    part("left-first", {"--crop", "0,0,20,30", "--samples", "0:8"});
    part("right-last", {"--crop", "20,0,40,30", "--samples", "8:16"});
    const auto refused = [&](const Arguments& parts, const std::string& why, const std::string& output = "m.exr") {
        Arguments arguments{"merge"};
        for (const std::string& name : parts) arguments.push_back(name + ".partial");
        arguments.insert(arguments.end(), {"-o", output});
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 3) << result.err;
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
        EXPECT_FALSE(fs::exists(work_ / output));
    };
    refused({"a", "b"}, "none may be added twice");
    refused({"a", "a"}, "none may be added twice");
    refused({"a", "seed"}, "seed: '4' in seed.partial, '0' in a.partial");
    refused({"left", "middle"}, "windows must be equal or apart");
    refused({"left", "corner"}, "no part has pixel (20, 20)");
    refused({"left", "short"}, "8 samples each in all parts together, others have 16");
    refused({"a", "later"}, "can become an image only", "m.partial");
    // Such a part would say that all of its pixels have samples 0 to 7.
    refused({"left-first", "right-last"}, "can become an image only", "m.partial");
    const ProgramResult apart = run({"merge", "left-first.partial", "right-last.partial", "-o", "apart.exr"});
    EXPECT_EQ(apart.exit_code, 0);
    EXPECT_NE(apart.err.find("the pixels 0,0,20,30 have samples 0 to 7 and the pixels 20,0,40,30 have 8 to 15"),
              std::string::npos)
        << apart.err;
    const ProgramResult gap = run({"merge", "a.partial", "later.partial", "-o", "m.exr"});
    EXPECT_EQ(gap.exit_code, 0);
    EXPECT_NE(gap.err.find("note: no part has samples 8 to 9"), std::string::npos) << gap.err;
    Checkpoint adaptive = read_checkpoint(work_ / "left.partial");
    adaptive.state.adaptive = {.passes = 1, .samples = std::vector<std::uint32_t>(20 * 30, 16)};
    write_checkpoint(work_ / "adaptive.partial", adaptive.identity, adaptive.description, adaptive.state);
    refused({"adaptive", "right"}, "is of an adaptive render", "x.exr");
    write_file(work_ / "a.partial", read_file(work_ / "a.partial").substr(100));
    const ProgramResult damaged = run({"merge", "a.partial", "later.partial", "-o", "n.exr"});
    EXPECT_EQ(damaged.exit_code, 1);
    EXPECT_NE(damaged.err.find("a.partial is damaged"), std::string::npos) << damaged.err;
}

TEST_F(Continuation, RefusesTheCheckpointOfAnotherVersionAndSaysSo) {
    ASSERT_EQ(interrupt(render(1000000, "a.exr"), 60).exit_code, 130);
    Checkpoint kept = read_checkpoint(work_ / "a.checkpoint");
    const std::string version = std::exchange(kept.identity.at("program"), "etendue 0.0.1");
    write_checkpoint(work_ / "a.checkpoint", kept.identity, kept.description, kept.state);
    const ProgramResult refused = run(render(1000000, "a.exr", {"--resume", "--quiet"}));
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.err.find("program: 'etendue 0.0.1' there, '" + version + "' here"), std::string::npos)
        << refused.err;
}

/// As after a change of its code: a copy of the program has another build ID.
TEST_F(Continuation, RefusesTheCheckpointOfAnotherBuildAndSaysSo) {
    ASSERT_EQ(interrupt(render(1000000, "a.exr"), 60).exit_code, 130);
    const std::string program = read_checkpoint(work_ / "a.checkpoint").identity.at("program");
    const std::string digits = program.substr(program.rfind(' ') + 1);
    ASSERT_EQ(digits.size(), 16u) << program;
    std::string id;
    for (std::size_t i = 0; i < digits.size(); i += 2)
        id += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
    std::string code = read_file(program_file());
    const std::size_t place = code.find(id);
    ASSERT_NE(place, std::string::npos);
    code[place] = static_cast<char>(code[place] ^ 1);
    const fs::path other = folder_ / "etendue";
    write_file(other, code);
    fs::permissions(other, fs::perms::owner_exec, fs::perm_options::add);
    Arguments again = render(1000000, (work_ / "a.exr").string(), {"--resume", "--quiet"});
    again.insert(again.begin(), other.string());
    const CommandResult refused = run_command(again);
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.err.find("program: '" + program + "' there, '"), std::string::npos) << refused.err;
}

TEST_F(Continuation, GoesOnWithASceneThatWasMoved) {
    ASSERT_EQ(interrupt(render(1000000, "a.exr"), 60).exit_code, 130);
    const int spp = json::parse(read_file(work_ / "a.json"))["spp"]["done"].get<int>() + 40;
    fs::create_directories(folder_ / "mounted");
    fs::rename(folder_ / "box", folder_ / "mounted/box");
    Arguments moved = render(spp, "a.exr", {"--resume"});
    moved[1] = "../mounted/box";
    const ProgramResult result = run(moved);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("going on after"), std::string::npos) << result.err;
}

TEST_F(Continuation, APartThatGrowsGoesOnFromItsCheckpoint) {
    ASSERT_EQ(run(render(8, "a.partial", {"--samples", "0:8", "--quiet"})).exit_code, 0);
    const Arguments longer = render(4'000'000, "a.partial", {"--samples", "0:4000000", "--resume"});
    ASSERT_EQ(interrupt(longer, 300).exit_code, 130);
    const ProgramResult again = interrupt(longer, 300);
    EXPECT_NE(again.err.find("going on after "), std::string::npos) << again.err;
    EXPECT_EQ(again.err.find("going on after 8 "), std::string::npos) << again.err;
}

// Tiles are merged to a part, and that to an image: as if they had been merged to the image.
TEST_F(Continuation, MergingInTwoStepsDescribesTheImage) {
    for (const auto& [name, crop] : {std::pair{"left", "0,0,13,30"}, {"right", "13,0,40,30"}, {"part", "0,0,13,20"}})
        ASSERT_EQ(run(render(4, fmt::format("{}.partial", name), {"--crop", crop, "--quiet"})).exit_code, 0);
    ASSERT_EQ(run({"merge", "left.partial", "right.partial", "-o", "both.partial"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "both.partial", "-o", "two.exr"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "left.partial", "right.partial", "-o", "one.exr"}).exit_code, 0);
    const json two = json::parse(read_file(work_ / "two.json"));
    const json one = json::parse(read_file(work_ / "one.json"));
    EXPECT_EQ(two["settings_hash"], one["settings_hash"]);
    EXPECT_EQ(two["complete"], true);
    EXPECT_EQ(two["settings"], one["settings"]);
    ASSERT_EQ(run(render(4, "below.partial", {"--crop", "0,20,13,30", "--quiet"})).exit_code, 0);
    ASSERT_EQ(run({"merge", "part.partial", "below.partial", "-o", "column.partial"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "column.partial", "-o", "column.exr"}).exit_code, 0);
    EXPECT_EQ(json::parse(read_file(work_ / "column.json"))["complete"], false) << "pixels are missing";
}

TEST_F(Continuation, FewerSamplesThanThereAreEndWithWholePasses) {
    ASSERT_EQ(interrupt(render(1000000, "a.exr"), 60).exit_code, 130);
    const ProgramResult result = run(render(1, "a.exr", {"--resume"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json statistics = json::parse(read_file(work_ / "a.json"));
    const int spp = statistics["spp"]["done"].get<int>();
    EXPECT_EQ(statistics["samples"], 40 * 30 * spp);
    ASSERT_EQ(run(render(spp, "whole.exr")).exit_code, 0);
    EXPECT_EQ(difference("a.exr", "whole.exr"), 0.0);
}

TEST_F(Continuation, AFinishedPartIsSaidToBeShownAsItIsAskedForNow) {
    ASSERT_EQ(run(render(16, "a.partial", {"--samples", "0:16", "--quiet"})).exit_code, 0);
    const Checkpoint before = read_checkpoint(work_ / "a.partial");
    const Arguments bright = render(16, "a.partial", {"--samples", "0:16", "--exposure", "4", "--resume", "--quiet"});
    ASSERT_EQ(run(bright).exit_code, 0);
    const Checkpoint after = read_checkpoint(work_ / "a.partial");
    EXPECT_EQ(json::parse(after.description)["frame"]["exposure"], 4.0);
    EXPECT_EQ(after.state.film.resolve(), before.state.film.resolve());
    EXPECT_EQ(after.state.counters.samples, before.state.counters.samples) << "none was rendered again";
    const auto written = fs::last_write_time(work_ / "a.partial");
    ASSERT_EQ(run(bright).exit_code, 0);
    EXPECT_EQ(fs::last_write_time(work_ / "a.partial"), written) << "it is left alone";
}

TEST_F(Continuation, DoesNotReplaceAPartOfAnotherRenderUnlessForced) {
    const Arguments eight{"--samples", "0:8", "--resume", "--quiet"};
    ASSERT_EQ(run(render(16, "a.partial", eight)).exit_code, 0);
    const std::string bytes = read_file(work_ / "a.partial");
    const auto refused = [&](const Arguments& arguments, const std::string& why) {
        const ProgramResult result = run(render(16, "a.partial", arguments));
        EXPECT_EQ(result.exit_code, 3) << why;
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
        EXPECT_EQ(read_file(work_ / "a.partial"), bytes) << why;
    };
    refused({"--samples", "0:8", "--resume", "--seed", "4"}, "seed: '0' there, '4' here");
    refused({"--samples", "8:16", "--resume"}, "first sample: '0' there, '8' here");
    refused({"--samples", "0:4", "--resume"}, "has 8 samples of each pixel, and no more than 4 are asked for");
    // The same part is left alone, and its statistics are its own.
    ProgramResult same = run(render(16, "a.partial", {"--samples", "0:8", "--resume", "--json"}));
    EXPECT_NE(same.err.find("up to date"), std::string::npos) << same.err;
    EXPECT_EQ(json::parse(same.out)["spp"]["done"], 8);
    same = run(render(16, "a.partial", {"--samples", "0:8", "--resume", "--force"}));
    EXPECT_EQ(same.err.find("up to date"), std::string::npos) << same.err;
    EXPECT_EQ(run(render(16, "a.partial", {"--samples", "8:16", "--resume", "--force"})).exit_code, 0);
    EXPECT_NE(read_file(work_ / "a.partial"), bytes);
    // What is damaged is of no use to anybody.
    write_file(work_ / "a.partial", bytes.substr(100));
    const ProgramResult again = run(render(16, "a.partial", {"--samples", "0:8", "--resume"}));
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_NE(again.err.find("a.partial is damaged"), std::string::npos) << again.err;
}

TEST_F(Continuation, AMergeOfSomePartsIsNoFinishedImage) {
    const auto part = [&](const std::string& name, const Arguments& more) {
        ASSERT_EQ(run(render(16, name + ".partial", more)).exit_code, 0) << name;
    };
    part("a", {"--samples", "0:8", "--quiet"});
    part("b", {"--samples", "8:16", "--quiet"});
    part("left", {"--crop", "0,0,13,30", "--quiet"});
    part("middle", {"--crop", "13,0,20,30", "--quiet"});
    const auto merged = [&](const Arguments& parts, bool complete) {
        Arguments merge{"merge"};
        for (const std::string& name : parts) merge.push_back(name + ".partial");
        merge.insert(merge.end(), {"-o", "m.exr", "--json"});
        const ProgramResult result = run(merge);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(json::parse(read_file(work_ / "m.json"))["complete"], complete) << parts.front();
        EXPECT_EQ(json::parse(result.out)["complete"], complete);
        EXPECT_EQ(result.err.find("incomplete") == std::string::npos, complete) << result.err;
        return result.err;
    };
    EXPECT_NE(merged({"a"}, false).find("note: no part has samples 8 to 15"), std::string::npos);
    EXPECT_EQ(run(render(16, "m.exr", {"--resume"})).err.find("up to date"), std::string::npos);
    EXPECT_NE(merged({"b"}, false).find("note: no part has samples 0 to 7"), std::string::npos);
    EXPECT_NE(merged({"left", "middle"}, false).find("the parts have the pixels 0,0,20,30 of 0,0,40,30"),
              std::string::npos);
    EXPECT_EQ(merged({"left"}, true).find("note"), std::string::npos) << "a crop is what was asked for";
    EXPECT_EQ(merged({"b", "a"}, true).find("note"), std::string::npos);
    EXPECT_NE(run(render(16, "m.exr", {"--resume"})).err.find("up to date"), std::string::npos);
}

TEST_F(Continuation, StatisticsOfAnImageThatIsUpToDateAreThoseOfItsRender) {
    ASSERT_EQ(run(render(5, "a.exr", {"--quiet"})).exit_code, 0);
    const ProgramResult again = run(render(5, "a.exr", {"--resume", "--json"}));
    EXPECT_NE(again.err.find("up to date"), std::string::npos) << again.err;
    EXPECT_EQ(again.out, read_file(work_ / "a.json"));
}

TEST_F(Continuation, ACheckpointThatCannotBeWrittenIsNotPromised) {
    ASSERT_EQ(interrupt(render(1000000, "a.exr"), 60).exit_code, 130);
    fs::create_directories(work_ / "a.checkpoint.previous/taken");
    ProgramResult result;
    // Later and later: there is a checkpoint already, and perhaps no sample yet.
    for (int milliseconds = 60; milliseconds < 60'000 && result.err.find("stopped after") == std::string::npos;
         milliseconds *= 2)
        result = interrupt(render(1000000, "a.exr"), milliseconds);
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.err.find("no checkpoint was written: cannot rename"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("stopped after"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("goes on from there"), std::string::npos) << result.err;
}

TEST_F(Continuation, ASecondSignalOfTheOtherKindEndsItAtOnce) {
    // Large enough for the second to come before the first is obeyed.
    Arguments large = render(1000000, "a.exr");
    large[3] = "3000x2000";
    ProgramResult result;
    // On a busy machine the first may come before anything is rendered, and ends it.
    for (int milliseconds = 100; milliseconds < 60'000 && result.exit_code != 1000 + SIGTERM; milliseconds *= 2)
        result = run(large, [&](int pid) {
            sleep_ms(milliseconds);
            kill(pid, SIGINT);
            EXPECT_TRUE(wait_until([pid] { return !handles_interrupt(pid); }));
            kill(pid, SIGTERM);
        });
    EXPECT_EQ(result.exit_code, 1000 + SIGTERM);
}

TEST_F(Continuation, ASignalBeforeAnythingIsRenderedEndsItAtOnce) {
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}, std::pair{SIGHUP, 143}}) {
        ProgramResult result;
        bool was_loading = false;
        // On a busy machine the signal may come when the scene has been loaded.
        for (int i = 0; i < 20 && !was_loading; ++i) {
            fs::remove_all(work_);
            fs::create_directories(work_);
            result = run(render(1000000, "a.exr"), [number = signal](int pid) { kill(pid, number); });
            was_loading = result.err.find("a.exr") == std::string::npos;
        }
        EXPECT_TRUE(was_loading) << result.err;
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_TRUE(list(work_).empty());
    }
    int of_inspect = 0;
    for (int i = 0; i < 20 && of_inspect == 0; ++i)
        of_inspect = run({"inspect", (folder_ / "box").string()}, [](int pid) { kill(pid, SIGINT); }).exit_code;
    EXPECT_EQ(of_inspect, 130);
}

TEST_F(Continuation, UsageErrorsEndWithTwo) {
    for (const Arguments& more :
         {Arguments{"--samples", "0:8"}, Arguments{"--samples", "8:8"}, Arguments{"--samples", "x"},
          Arguments{"--checkpoint-every", "-1"}, Arguments{"--error", "-1"}, Arguments{"--progress-fd", "1"},
          Arguments{"--progress-fd", "999"}})
        EXPECT_EQ(run(render(8, "a.exr", more)).exit_code, 2) << more.back();
    EXPECT_EQ(run(render(8, "a.partial", {"--time", "1"})).exit_code, 2);
    EXPECT_EQ(run({"merge", "-o", "a.exr"}).exit_code, 2);
    EXPECT_TRUE(list(work_).empty());
}

TEST_F(Continuation, AProbeSaysWhatTheImageWouldTakeAndWritesNothing) {
    const ProgramResult result = run({"render", (folder_ / "box").string(), "--spp", "100000", "--probe", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json probe = json::parse(result.out);
    EXPECT_EQ(probe["spp"], 100000);
    EXPECT_EQ(probe["width"], 16);
    const auto start = probe["start_seconds"].get<double>();
    EXPECT_GE(start, probe["load_seconds"].get<double>() + probe["build_seconds"].get<double>());
    const double expected = start + 1e5 * probe["seconds_per_spp"].get<double>();
    EXPECT_NEAR(probe["estimated_seconds"].get<double>(), expected, 1e-3 * expected);
    EXPECT_GT(probe["peak_memory_bytes"].get<double>(), 1e6);
    EXPECT_EQ(probe["deep_bytes"], 0);
    const ProgramResult deep = run({"render", (folder_ / "box").string(), "--deep", "--probe", "--quiet"});
    EXPECT_GT(json::parse(deep.out)["deep_bytes"].get<int>(), 16 * 12 * 24) << deep.err;
    const ProgramResult part = run(render(100000, "a.partial", {"--samples", "64:96", "--probe", "--quiet"}));
    EXPECT_EQ(json::parse(part.out)["spp"], 32);
    EXPECT_TRUE(list(work_).empty());
}

}  // namespace

}  // namespace etendue::test
