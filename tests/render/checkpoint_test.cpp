#include "render/checkpoint.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/write_file.h"
#include "render/render_test_scene.h"
#include "support/temporary_folder.h"

#include <atomic>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const RenderIdentity kIdentity{{"integrator", "bdpt"}, {"file scene.gltf", "0123"}, {"empty", ""}};

/// A render that was stopped after that many questions.
RenderState stopped(const World& world, const Integrator& integrator, const RenderOptions& options, int questions) {
    const ThreadPool pool(1);
    std::atomic<int> asked = 0;
    ProgressiveRender rendering(world, integrator, options, pool);
    const auto stop = [&] { return ++asked > questions; };
    for (const std::uint32_t count : {1u, 1u, 2u}) rendering.add_samples(count, stop);
    return rendering.take_state();
}

/// Not through to the disk: that takes long, a thousand times.
void write_quickly(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

class Checkpoints : public testing::TestWithParam<std::string> {};

TEST_P(Checkpoints, GoOnToTheSameBytes) {
    const TemporaryFolder folder;
    const World world = compile(busy_scene(100, 70));
    const auto integrator = make_integrator(GetParam(), {});
    const RenderOptions options = options_for(100, 70, 9);
    const bool asks_often = !integrator->makes_splats();
    RenderState state = stopped(world, *integrator, options, asks_often ? 31 : 1);
    // Once the speed is known, all splats of a pass that takes less than a second are added together.
    ASSERT_EQ(state.pass_size, asks_often ? 2u : 1u) << "the middle of a pass";
    const auto path = folder / "a.checkpoint";
    write_checkpoint(path, kIdentity, "what it is", state);
    Checkpoint kept = read_checkpoint(path);
    EXPECT_EQ(kept.identity, kIdentity);
    EXPECT_EQ(kept.description, "what it is");
    EXPECT_EQ(kept.state.spp_done, state.spp_done);
    EXPECT_EQ(kept.state.tiles_done, state.tiles_done);
    EXPECT_EQ(kept.state.counters.rays.total(), state.counters.rays.total());
    EXPECT_EQ(kept.state.wall_seconds, state.wall_seconds);
    EXPECT_TRUE(same_bytes(kept.state.film.resolve(), state.film.resolve()));
    const ThreadPool pool(3);
    const std::atomic<bool> never{false};
    const RenderResult result = render(world, *integrator, options, pool, never, {}, {}, std::move(kept.state));
    const RenderResult whole = render_now(world, GetParam().c_str(), options, 2);
    EXPECT_TRUE(same_bytes(result.film.resolve(), whole.film.resolve()));
    EXPECT_EQ(result.counters.samples, whole.counters.samples);
}

/// All mattes and depths, as text that can be compared.
std::string mattes_and_depths(const Film& film) {
    std::string text;
    for (const float value : film.resolve_matte(0, 4))
        text += std::to_string(std::bit_cast<std::uint32_t>(value)) + " ";
    for (const std::vector<DeepSample>& pixel : film.resolve_deep())
        for (const DeepSample& s : pixel)
            for (const float value : {s.r, s.g, s.b, s.alpha, s.front, s.back})
                text += std::to_string(std::bit_cast<std::uint32_t>(value)) + " ";
    return text;
}

TEST_P(Checkpoints, GoOnToTheSameMattesAndDepths) {
    const TemporaryFolder folder;
    const SceneDesc scene = busy_scene(70, 40);
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.mattes = 1;
    aovs->layout.matte_slots = 3;  // too few for some pixels
    aovs->layout.is_deep = true;
    MatteIds& ids = aovs->mattes.emplace_back();
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) ids.ids.push_back(i + 1);
    const World world = compile(scene);
    const auto integrator = make_integrator(GetParam(), {});
    RenderOptions options = options_for(70, 40, 9);
    options.aovs = aovs;
    const RenderState state = stopped(world, *integrator, options, integrator->makes_splats() ? 1 : 9);
    const auto path = folder / "a.checkpoint";
    write_checkpoint(path, kIdentity, "", state);
    Checkpoint kept = read_checkpoint(path);
    EXPECT_EQ(mattes_and_depths(kept.state.film), mattes_and_depths(state.film));
    const ThreadPool pool(3);
    const std::atomic<bool> never{false};
    const RenderResult result = render(world, *integrator, options, pool, never, {}, {}, std::move(kept.state));
    const RenderResult whole = render_now(world, GetParam().c_str(), options, 2);
    EXPECT_EQ(mattes_and_depths(result.film), mattes_and_depths(whole.film));
}

INSTANTIATE_TEST_SUITE_P(Integrators, Checkpoints, testing::Values("path", "light", "bdpt", "vcm"),
                         [](const auto& test) { return test.param; });

TEST(Checkpoint, DamageIsFound) {
    const TemporaryFolder folder;
    const World world = compile(busy_scene(20, 10));
    const RenderOptions options = options_for(20, 10, 4);
    const auto path = folder / "a.checkpoint";
    write_checkpoint(path, kIdentity, "what it is", stopped(world, *make_integrator("bdpt", {}), options, 1000));
    const std::vector<std::byte> bytes = read_all(path);
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        std::vector<std::byte> damaged = bytes;
        damaged[random() % damaged.size()] ^= static_cast<std::byte>(1 + random() % 255);
        write_quickly(path, damaged);
        EXPECT_THROW((void)read_checkpoint(path), IoError) << "attempt " << i;
    }
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{16}, bytes.size() / 2, bytes.size() - 1}) {
        write_bytes(path, std::span(bytes).first(size));
        EXPECT_THROW((void)read_checkpoint(path), IoError) << size << " bytes";
    }
    write_bytes(path, bytes);
    EXPECT_NO_THROW((void)read_checkpoint(path));
    EXPECT_THROW((void)read_checkpoint(folder / "missing"), IoError);
}

/// `bytes` with the hash that belongs to them at their end.
std::vector<std::byte> with_hash(std::vector<std::byte> bytes) {
    bytes.resize(bytes.size() - ContentHash::kSize);
    ContentHash hash;
    hash.add(bytes);
    const ContentHash::Digest digest = hash.digest();
    bytes.insert(bytes.end(), digest.begin(), digest.end());
    return bytes;
}

TEST(Checkpoint, AnotherFormatIsNoDamage) {
    const TemporaryFolder folder;
    const auto path = folder / "a.checkpoint";
    write_checkpoint(path, kIdentity, "", {.film = Film(2, 2, {0, 0, 2, 2}), .spp_done = 1});
    std::vector<std::byte> bytes = read_all(path);
    const char format = static_cast<char>(std::exchange(bytes[7], std::byte{'1'}));
    write_bytes(path, with_hash(bytes));
    try {
        (void)read_checkpoint(path);
        FAIL();
    } catch (const RefusedCheckpoint& refused) {
        EXPECT_NE(std::string(refused.what()).find(std::string("format 1 there, ") + format + " here"),
                  std::string::npos)
            << refused.what();
    }
    write_bytes(path, bytes);
    EXPECT_THROW((void)read_checkpoint(path), DamagedCheckpoint) << "with a wrong hash";
    bytes[6] = std::byte{'?'};
    write_bytes(path, with_hash(bytes));
    EXPECT_THROW((void)read_checkpoint(path), DamagedCheckpoint) << "no checkpoint at all";
}

// Such files have a right hash; what stands in them is what no render leaves behind.
TEST(Checkpoint, WhatDoesNotBelongTogetherIsRefused) {
    const TemporaryFolder folder;
    const auto path = folder / "a.checkpoint";
    const World world = compile(busy_scene(40, 40));
    RenderOptions options = options_for(40, 40, 4);
    options.window = {4, 4, 36, 36};
    options.splat_window = {0, 0, 40, 40};
    const auto integrator = make_integrator("path", {});
    const auto read_after = [&](const std::function<void(RenderState&)>& change, int questions = 1000) {
        RenderState state = stopped(world, *integrator, options, questions);
        change(state);
        write_checkpoint(path, kIdentity, "", state);
        (void)read_checkpoint(path);
    };
    const auto every_other = [&](const PixelRect& window, const PixelRect& splat_window, int width = 40) {
        return [=](RenderState& state) {
            state.every_other_pass = Film(width, 40, window, splat_window);
            state.every_other_spp = 1;
        };
    };
    EXPECT_NO_THROW(read_after([](RenderState&) {}));
    EXPECT_NO_THROW(read_after([](RenderState&) {}, 2));
    EXPECT_NO_THROW(read_after(every_other(options.window, options.splat_window)));
    EXPECT_THROW(read_after(every_other({4, 4, 36, 35}, options.splat_window)), IoError);
    EXPECT_THROW(read_after(every_other(options.window, {0, 0, 40, 39})), IoError);
    EXPECT_THROW(read_after(every_other(options.window, options.splat_window, 41)), IoError);
    EXPECT_THROW(read_after([&](RenderState& state) {
                     state.every_other_pass = Film(40, 40, options.window, options.splat_window);
                     state.every_other_spp = state.spp_done + 1;
                 }),
                 IoError);
    EXPECT_THROW(read_after([](RenderState& state) { state.every_other_spp = 1; }), IoError);
    EXPECT_THROW(read_after([](RenderState& state) {
                     state.film = Film(40, 40, {4, 4, 36, 36}, {5, 4, 36, 36});
                 }),
                 IoError);
    EXPECT_THROW(read_after([](RenderState& state) { state.first_sample = ~0u - 3; }), IoError);
    EXPECT_NO_THROW(read_after([](RenderState& state) { state.first_sample = ~0u - 4; }));
    const auto adaptive = [](RenderState& state) {
        state.adaptive = {.passes = 1, .samples = std::vector<std::uint32_t>(state.film.window().area(), 4)};
        state.adaptive.samples.back() = 20;
    };
    const auto adaptive_but = [&](const std::function<void(RenderState&)>& change) {
        return [&adaptive, change](RenderState& state) {
            adaptive(state);
            change(state);
        };
    };
    EXPECT_NO_THROW(read_after(adaptive));
    EXPECT_THROW(read_after(adaptive_but([](RenderState& s) { s.adaptive.samples.pop_back(); })), IoError);
    EXPECT_THROW(read_after(adaptive_but([](RenderState& s) { s.adaptive.samples.front() = 3; })), IoError);
    EXPECT_THROW(read_after(adaptive_but([](RenderState& s) { s.adaptive.samples.clear(); })), IoError);
    EXPECT_THROW(read_after(adaptive_but([](RenderState& s) { s.first_sample = ~0u - 19; })), IoError);
    const auto all_active = [](RenderState& s) { s.adaptive.is_active.assign(s.film.window().area(), 1); };
    EXPECT_THROW(read_after(adaptive_but(all_active)), IoError) << "no pass is under way";
    const auto in_a_pass = [&](const std::function<void(RenderState&)>& change) {
        read_after(
            [&](RenderState& s) {
                adaptive(s);
                s.spp_done = 4;
                all_active(s);
                change(s);
            },
            2);
    };
    EXPECT_NO_THROW(in_a_pass([](RenderState&) {}));
    EXPECT_THROW(in_a_pass([](RenderState& s) { s.adaptive.is_active.pop_back(); }), IoError);
    EXPECT_THROW(in_a_pass([](RenderState& s) { s.adaptive.is_active.front() = 2; }), IoError);
    EXPECT_THROW(read_after([](RenderState& state) { state.counters.dropped = 1; }), IoError);
    EXPECT_THROW(read_after([](RenderState& state) { state.counters.first_dropped.push_back({}); }), IoError);
    EXPECT_THROW(read_after([](RenderState& state) { state.tiles_done.push_back(1); }), IoError);
    EXPECT_THROW(read_after([](RenderState& state) { state.tiles_done.back() = 2; }, 2), IoError);
}

TEST(Checkpoint, DifferencesAreNamed) {
    EXPECT_EQ(difference(kIdentity, kIdentity), "");
    RenderIdentity other = kIdentity;
    other["integrator"] = "path";
    other.erase("empty");
    other["new"] = "1";
    EXPECT_EQ(difference(kIdentity, other),
              "empty: '' there, missing here\nintegrator: 'bdpt' there, 'path' here\nnew: missing there, '1' here");
    EXPECT_EQ(difference({{"seed", "1"}}, {{"seed", "2"}}, "in a.partial", "in b.partial"),
              "seed: '1' in a.partial, '2' in b.partial");
}

}  // namespace

}  // namespace etendue::test
