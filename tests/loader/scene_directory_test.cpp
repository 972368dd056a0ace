#include "loader/gltf/gltf_builder.h"

#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue {
namespace {

const std::string& lone_triangle() {
    static const std::string bytes = [] {
        GltfBuilder builder;
        builder.add_triangle();
        return builder.glb();
    }();
    return bytes;
}

std::string failure_to_load(const std::filesystem::path& path) {
    try {
        static_cast<void>(load_scene(path));
        return "";
    } catch (const SceneError& error) {
        return error.what();
    }
}

TEST(LoadScene, TakesTheOnlyFile) {
    const TempDir dir;
    dir.write("thing.glb", lone_triangle());
    const LoadedScene loaded = load_scene(dir.path());
    EXPECT_EQ(loaded.scene.file, dir.path() / "thing.glb");
    EXPECT_EQ(loaded.scene.directory, dir.path());
    EXPECT_EQ(loaded.scene.name, dir.path().filename());
    EXPECT_EQ(load_scene(dir.path() / "thing.glb").scene.name, "thing");
    EXPECT_EQ(load_scene(dir.path() / "").scene.name, dir.path().filename());
    EXPECT_EQ(load_scene(dir.path() / ".").scene.name, dir.path().filename());
}

TEST(LoadScene, TakesExtensionsInUpperCase) {
    const TempDir dir;
    dir.write("THING.GLB", lone_triangle());
    EXPECT_EQ(load_scene(dir.path()).scene.file, dir.path() / "THING.GLB");
    EXPECT_EQ(find_scene_directories(dir.path()).size(), 1u);
}

TEST(FindSceneDirectories, FollowsLinksButNotInCirclesAndNotThoseOfAScene) {
    namespace fs = std::filesystem;
    const TempDir dir;
    const TempDir outside;
    outside.write("shot/a.glb", lone_triangle());
    outside.write("other/b.glb", lone_triangle());
    dir.write("z/c.glb", lone_triangle());
    fs::create_directory_symlink(dir.path() / "z", dir.path() / "a-is-z");
    fs::create_directory_symlink(outside.path() / "shot", dir.path() / "b-is-shot");
    fs::create_directory_symlink(dir.path(), dir.path() / "circle");
    fs::create_directory_symlink(dir.path(), outside.path() / "shot/back");
    fs::create_directory_symlink(outside.path() / "other", dir.path() / "z/of-the-scene");
    EXPECT_EQ(find_scene_directories(dir.path()), (std::vector<fs::path>{dir.path() / "b-is-shot", dir.path() / "z"}));
    fs::create_directory_symlink(outside.path(), dir.path() / "all");
    EXPECT_EQ(find_scene_directories(dir.path() / "all"),
              (std::vector<fs::path>{dir.path() / "all/other", dir.path() / "all/shot"}))
        << "a link that is given";
    fs::create_directories(outside.path() / "empty");
    fs::create_directory_symlink(outside.path(), outside.path() / "empty/up");
    EXPECT_TRUE(find_scene_directories(outside.path() / "empty").empty()) << "nothing above is searched";
}

TEST(LoadScene, SeveralFilesNeedAChoice) {
    const TempDir dir;
    dir.write("a.glb", lone_triangle());
    dir.write("b.gltf", "{}");
    EXPECT_NE(failure_to_load(dir.path()).find("a.glb, b.gltf"), std::string::npos) << failure_to_load(dir.path());
    EXPECT_EQ(failure_to_load(dir.path() / "a.glb"), "");

    dir.write("render.json", R"({"scene": "a.glb"})");
    EXPECT_EQ(load_scene(dir.path()).scene.file.filename(), "a.glb");
    dir.write("render.json", R"({"scene": "c.glb"})");
    EXPECT_NE(failure_to_load(dir.path()).find("#/scene: 'c.glb': the file does not exist"), std::string::npos);
    dir.write("render.json", R"({"scene": "../a.glb"})");
    EXPECT_NE(failure_to_load(dir.path()).find("'..'"), std::string::npos);
}

TEST(LoadScene, PrefersTheNameScene) {
    const TempDir dir;
    dir.write("a.glb", lone_triangle());
    dir.write("scene.glb", lone_triangle());
    EXPECT_EQ(load_scene(dir.path()).scene.file.filename(), "scene.glb");
    dir.write("scene.gltf", "{}");
    EXPECT_NE(failure_to_load(dir.path()).find("several"), std::string::npos);
}

TEST(LoadScene, SettingsForAnotherFileAreNotApplied) {
    const TempDir dir;
    dir.write("a.glb", lone_triangle());
    dir.write("b.glb", lone_triangle());
    dir.write("render.json", R"({"scene": "a.glb", "spp": 7})");
    EXPECT_EQ(load_scene(dir.path() / "a.glb").scene.settings.spp, 7);
    const LoadedScene other = load_scene(dir.path() / "b.glb");
    EXPECT_EQ(other.scene.settings.spp, RenderSettings{}.spp);
    EXPECT_TRUE(has_problem(other.problems, Severity::Note, "it is for 'a.glb'"));
}

TEST(LoadScene, SaysWhatIsNotThere) {
    const TempDir dir;
    EXPECT_NE(failure_to_load(dir.path() / "nothing").find("no such file or directory"), std::string::npos);
    EXPECT_NE(failure_to_load(dir.path()).find("no glTF file"), std::string::npos);
    dir.write("a.obj", "v 0 0 0");
    EXPECT_NE(failure_to_load(dir.path() / "a.obj").find("format is not known"), std::string::npos);
    dir.write("render.json", "{}");
    EXPECT_NE(failure_to_load(dir.path()).find("no glTF file"), std::string::npos);
}

TEST(LoadScene, RecognisesTheFormatByContentToo) {
    const TempDir dir;
    dir.write("model.bin", lone_triangle());
    EXPECT_EQ(failure_to_load(dir.path() / "model.bin"), "");
    dir.write("model.gltf", lone_triangle());
    EXPECT_EQ(failure_to_load(dir.path() / "model.gltf"), "");
    dir.write("model.glb", "{}");
    EXPECT_NE(failure_to_load(dir.path() / "model.glb").find("does not start with 'glTF'"), std::string::npos);
    dir.write("MODEL.GLB", lone_triangle());
    EXPECT_EQ(failure_to_load(dir.path() / "MODEL.GLB"), "");
}

TEST(LoadScene, CollectsTheProblemsOfSettingsAndScene) {
    const TempDir dir;
    dir.write("scene.gltf", R"({"asset": {"version": "2.0"}, "scene": 3})");
    dir.write("render.json", R"({"spp": 0, "sead": 1})");
    const LoadedScene loaded = inspect_scene(dir.path());
    EXPECT_EQ(loaded.problems.error_count(), 3u) << listing(loaded.problems);
    EXPECT_NE(failure_to_load(dir.path()).find("did you mean 'seed'"), std::string::npos);
}

TEST(LoadScene, EachProblemIsReportedOnce) {
    const TempDir dir;
    dir.write("scene.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["X"], "scene": 3})");
    EXPECT_EQ(inspect_scene(dir.path()).problems.all().size(), 2u);
}

TEST(LoadScene, FilesBehindLinksOutsideAreNotFoundInADirectory) {
    const TempDir outside;
    outside.write("scene.glb", lone_triangle());
    outside.write("render.json", "{}");
    const TempDir dir;
    std::filesystem::create_symlink(outside.path() / "scene.glb", dir.path() / "scene.glb");
    EXPECT_NE(failure_to_load(dir.path()).find("link leads out"), std::string::npos);
    EXPECT_EQ(failure_to_load(dir.path() / "scene.glb"), "");  // the user named it
    std::filesystem::create_symlink(outside.path() / "render.json", dir.path() / "render.json");
    EXPECT_NE(failure_to_load(dir.path() / "scene.glb").find("link leads out"), std::string::npos);
}

TEST(LoadScene, GivenSettingsAreMergedIntoThoseOfTheFile) {
    const TempDir dir;
    dir.write("a.glb", lone_triangle());
    const auto settings = [&](const char* given) { return load_scene(dir.path(), {.settings = given}).scene.settings; };
    EXPECT_EQ(settings(R"({"spp": 7})").spp, 7) << "without a file";
    dir.write("render.json", R"({"spp": 3, "seed": 5, "integrator": {"type": "bdpt", "max_depth": 4}})");
    EXPECT_EQ(settings("").spp, 3);
    const RenderSettings merged = settings(R"({"spp": 7, "seed": null, "integrator": {"max_depth": 9}})");
    EXPECT_EQ(merged.spp, 7);
    EXPECT_EQ(merged.seed, RenderSettings{}.seed) << "null restores the default";
    EXPECT_EQ(merged.integrator.type, "bdpt") << "objects are merged";
    EXPECT_EQ(merged.integrator.lengths.max_depth, 9);
    EXPECT_EQ(load_scene(dir.path(), {.settings = R"({"spp": 7})"}).scene.inputs, load_scene(dir.path()).scene.inputs);
}

TEST(LoadScene, GivenSettingsAreCheckedAsThoseOfTheFile) {
    const TempDir dir;
    dir.write("a.glb", lone_triangle());
    for (const char* given : {"{", "[1]", R"({"spp": 1, "spp": 2})", R"({"spp": 0})", R"({"ssp": 1})"})
        EXPECT_THROW((void)load_scene(dir.path(), {.settings = given}), SceneError) << given;
    // A render.json that is for another file is left out, what is given is not.
    dir.write("b.glb", lone_triangle());
    dir.write("render.json", R"({"scene": "b.glb", "spp": 3})");
    EXPECT_EQ(load_scene(dir.path() / "a.glb", {.settings = R"({"seed": 8})"}).scene.settings.seed, 8u);
    EXPECT_NE(load_scene(dir.path() / "a.glb", {.settings = R"({"seed": 8})"}).scene.settings.spp, 3);
}

TEST(FindSceneDirectories, FindsThemSortedAtEveryDepth) {
    const TempDir dir;
    dir.write("b/scene.glb", lone_triangle());
    dir.write("b/inner/scene.glb", lone_triangle());
    dir.write("a/render.json", "{}");
    dir.write("c/d/e/x.gltf", "{}");
    dir.write("two/x.gltf", "{}");
    dir.write("two/y.glb", "");
    dir.write("two/deeper/z.glb", "");
    dir.write("none/readme.txt", "");
    const auto& root = dir.path();
    EXPECT_EQ(find_scene_directories(root),
              (std::vector<std::filesystem::path>{root / "a", root / "b", root / "b/inner", root / "c/d/e",
                                                  root / "two", root / "two/deeper"}))
        << "loading says of two files in one directory that one must be named";
    EXPECT_EQ(find_scene_directories(root / "b"), (std::vector<std::filesystem::path>{root / "b", root / "b/inner"}));
}

/// Takes the rights of root from this process while it lives, since no permissions apply to root.
class WithoutRootRights {
  public:
    WithoutRootRights() : user_(geteuid()) {
        constexpr uid_t kNobody = 65534;
        if (user_ == 0 && seteuid(kNobody) != 0) return;
        applies_ = geteuid() != 0;
    }
    ~WithoutRootRights() {
        if (seteuid(user_) != 0) std::abort();
    }
    WithoutRootRights(const WithoutRootRights&) = delete;
    WithoutRootRights& operator=(const WithoutRootRights&) = delete;

    [[nodiscard]] bool applies() const { return applies_; }

  private:
    uid_t user_;
    bool applies_ = false;
};

TEST(FindSceneDirectories, FindsWhatCannotBeListedSoThatLoadingSaysWhy) {
    namespace fs = std::filesystem;
    const TempDir dir;
    fs::permissions(dir.path(), fs::perms(0755));
    dir.write("a/scene.glb", lone_triangle());
    dir.write("closed/scene.glb", lone_triangle());
    dir.write("other/inside/scene.glb", lone_triangle());
    fs::permissions(dir.path() / "closed", fs::perms::none);
    fs::permissions(dir.path() / "other", fs::perms::none);
    std::vector<fs::path> found;
    std::string failure;
    std::string failure_below;
    bool can_try = false;
    {
        const WithoutRootRights without;
        std::error_code code;
        can_try = without.applies() && fs::exists(dir.path() / "a/scene.glb", code);
        if (can_try) {
            found = find_scene_directories(dir.path());
            failure = failure_to_load(dir.path() / "closed");
            failure_below = failure_to_load(dir.path() / "other/inside");
        }
    }
    fs::permissions(dir.path() / "closed", fs::perms::owner_all);
    fs::permissions(dir.path() / "other", fs::perms::owner_all);
    if (!can_try) GTEST_SKIP() << "permissions do not apply here";
    EXPECT_EQ(found, (std::vector<fs::path>{dir.path() / "a", dir.path() / "closed", dir.path() / "other"}));
    EXPECT_NE(failure.find("closed: cannot be read: Permission denied"), std::string::npos) << failure;
    EXPECT_NE(failure_below.find("inside: cannot be read: Permission denied"), std::string::npos) << failure_below;
}

TEST(FindSceneDirectories, FindsSceneFilesThatAreNoRegularFilesSoThatLoadingSaysWhy) {
    namespace fs = std::filesystem;
    const TempDir dir;
    for (const char* name : {"dangling", "folder/scene.gltf", "loop", "pipe", "scenes/car.glb/inner"})
        fs::create_directories(dir.path() / name);
    fs::create_symlink("nothing", dir.path() / "dangling/scene.gltf");
    fs::create_symlink("scene.glb", dir.path() / "loop/scene.glb");
    ASSERT_EQ(mkfifo((dir.path() / "pipe/scene.gltf").c_str(), 0600), 0);
    dir.write("scenes/car.glb/inner/car.glb", lone_triangle());
    EXPECT_EQ(find_scene_directories(dir.path()),
              (std::vector<fs::path>{dir.path() / "dangling", dir.path() / "folder", dir.path() / "loop",
                                     dir.path() / "pipe", dir.path() / "scenes/car.glb/inner"}))
        << "a folder with the name of a scene may hold some";
    const std::pair<const char*, const char*> cases[] = {
        {"dangling", "scene.gltf: a symbolic link leads to a file that does not exist"},
        {"folder", "scene.gltf: this is not a regular file"},
        {"loop", "scene.glb: the file cannot be reached"},
        {"pipe", "scene.gltf: this is not a regular file"},
    };
    for (const auto& [name, reason] : cases) {
        const std::string failure = failure_to_load(dir.path() / name);
        EXPECT_NE(failure.find(reason), std::string::npos) << failure;
    }
}

TEST(LoadScene, WhatIsNoRegularFileStandsBackUnlessItIsCalledScene) {
    const TempDir dir;
    dir.write("room.glb", lone_triangle());
    std::filesystem::create_symlink("me@here.1", dir.path() / ".#room.glb");  // as an editor's lock
    EXPECT_EQ(failure_to_load(dir.path()), "");
    std::filesystem::create_symlink("nothing", dir.path() / "scene.gltf");
    EXPECT_NE(failure_to_load(dir.path()).find("scene.gltf: a symbolic link"), std::string::npos);
}

TEST(LoadScene, SaysWhyAPathCannotBeRead) {
    const std::string failure = failure_to_load("/tmp/" + std::string(300, 'a'));
    EXPECT_NE(failure.find(": cannot be read: File name too long"), std::string::npos) << failure;
}

TEST(FindSceneDirectories, NeedsADirectory) {
    const TempDir dir;
    dir.write("file", "");
    EXPECT_THROW(static_cast<void>(find_scene_directories(dir.path() / "file")), SceneError);
    EXPECT_THROW(static_cast<void>(find_scene_directories(dir.path() / "nothing")), SceneError);
}

}  // namespace
}  // namespace etendue
