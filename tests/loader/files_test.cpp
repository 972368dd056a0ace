#include "loader/files.h"

#include "core/error.h"
#include "loader/gltf/gltf_builder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace etendue {
namespace {

std::string refusal(const std::filesystem::path& directory, const std::string& uri) {
    try {
        return "resolved to " + resolve_uri(directory, uri).string();
    } catch (const IoError& error) {
        return error.what();
    }
}

TEST(ResolveUri, FindsFilesInside) {
    const TempDir dir;
    dir.write("a.bin", "x");
    dir.write("sub/b c.bin", "x");
    EXPECT_EQ(resolve_uri(dir.path(), "a.bin"), dir.path() / "a.bin");
    EXPECT_EQ(resolve_uri(dir.path(), "./a.bin"), dir.path() / "a.bin");
    EXPECT_EQ(resolve_uri(dir.path(), "sub/b%20c.bin"), dir.path() / "sub/b c.bin");
    EXPECT_EQ(resolve_uri(dir.path(), "sub/b c.bin"), dir.path() / "sub/b c.bin");
}

TEST(ResolveUri, StepsBackWithinTheDirectory) {
    const TempDir dir;
    dir.write("a.bin", "x");
    dir.write("sub/b.bin", "x");
    EXPECT_EQ(resolve_uri(dir.path(), "sub/../a.bin"), dir.path() / "a.bin");
    EXPECT_EQ(resolve_uri(dir.path(), "sub/./../sub/b.bin"), dir.path() / "sub/b.bin");
    EXPECT_NE(refusal(dir.path(), "sub/../../a.bin").find("'..'"), std::string::npos);
    // Where a link leads is where its ".." counts from.
    const TempDir outside;
    outside.write("in/secret", "x");
    outside.write("a.bin", "secret");
    std::filesystem::create_directory_symlink(outside.path() / "in", dir.path() / "link");
    EXPECT_NE(refusal(dir.path(), "link/../a.bin").find("link leads out"), std::string::npos);
}

TEST(ResolveUri, TakesNamesThatAreNotEncoded) {
    const TempDir dir;
    dir.write("a%20b.png", "x");
    dir.write("100%.png", "x");
    EXPECT_EQ(resolve_uri(dir.path(), "a%20b.png"), dir.path() / "a%20b.png");
    EXPECT_EQ(resolve_uri(dir.path(), "100%.png"), dir.path() / "100%.png");
    dir.write("a b.png", "x");
    EXPECT_EQ(resolve_uri(dir.path(), "a%20b.png"), dir.path() / "a b.png");
}

TEST(ResolveUri, SaysWhatMayHaveBeenMeant) {
    const TempDir dir;
    dir.write("sub/Wood.png", "x");
    dir.write(
        "u\xcc\x88"
        "ber.png",
        "x");  // decomposed, as on a Mac
    EXPECT_NE(refusal(dir.path(), "sub\\Wood.png").find("did you mean 'sub/Wood.png'"), std::string::npos);
    EXPECT_NE(refusal(dir.path(), "sub/wood.png").find("did you mean 'sub/Wood.png'"), std::string::npos);
    EXPECT_NE(refusal(dir.path(), "SUB\\WOOD.PNG").find("did you mean 'sub/Wood.png'"), std::string::npos);
    const std::string long_name(100, 'a');
    dir.write(long_name + ".png", "x");
    EXPECT_NE(refusal(dir.path(), long_name + ".PNG").find("did you mean '"), std::string::npos);
    EXPECT_NE(refusal(dir.path(),
                      "\xc3\xbc"
                      "ber.png")
                  .find("encoded another way"),
              std::string::npos);
    EXPECT_EQ(refusal(dir.path(), "unlike-anything.bin").find("did you mean"), std::string::npos);
    dir.write("Box.gltf", "x");
    dir.write("Floor.jpg", "x");
    EXPECT_EQ(refusal(dir.path(), "Box0.bin").find("did you mean"), std::string::npos) << "the scene is no buffer";
    EXPECT_NE(refusal(dir.path(), "Box0.gltf").find("did you mean 'Box.gltf'"), std::string::npos);
    EXPECT_NE(refusal(dir.path(), "Floor.png").find("did you mean 'Floor.jpg'"), std::string::npos);
    dir.write("Box.bin", "x");
    EXPECT_NE(refusal(dir.path(), "Box0.bin").find("did you mean 'Box.bin'"), std::string::npos);
}

TEST(ResolveUri, RefusesWhatIsNoFileInside) {
    const TempDir outside;
    outside.write("secret", "x");
    const TempDir dir;
    dir.write("a.bin", "x");
    const std::pair<std::string, const char*> cases[] = {
        {"", "empty"},
        {"../a.bin", "'..'"},
        {"sub/../../a.bin", "'..'"},
        {"%2e%2e/a.bin", "'..'"},
        {"..%2fa.bin", "'..'"},
        {"/etc/passwd", "absolute"},
        {"%2fetc/passwd", "absolute"},
        {"//host/share", "absolute"},
        {outside.path().string() + "/secret", "absolute"},
        {"http://example.com/a.bin", "other URIs"},
        {"file:///etc/passwd", "other URIs"},
        {"http%3a//example.com", "other URIs"},
        {"C:\\a.bin", "other URIs"},
        {std::string("a.bin\0.png", 10), "control"},
        {"a.bin%00.png", "control"},
        {"a%0a.bin", "control"},
        {"100%", "hexadecimal"},
        {"a%zz", "hexadecimal"},
        {"missing.bin", "does not exist"},
        {".", "regular file"},
        {"./", "regular file"},
        {std::string(5000, 'a'), "longer than"},
        {std::string(1000, 'a'), "reached"},
    };
    for (const auto& [uri, expected] : cases) {
        EXPECT_NE(refusal(dir.path(), uri).find(expected), std::string::npos)
            << uri.substr(0, 100) << ": " << refusal(dir.path(), uri);
    }
}

TEST(ResolveUri, FollowsLinksInsideOnly) {
    const TempDir outside;
    outside.write("secret", "x");
    const TempDir dir;
    dir.write("a.bin", "x");
    std::filesystem::create_symlink(dir.path() / "a.bin", dir.path() / "inside");
    std::filesystem::create_symlink(outside.path() / "secret", dir.path() / "outside");
    std::filesystem::create_directory_symlink(outside.path(), dir.path() / "folder");
    std::filesystem::create_symlink("loop", dir.path() / "loop");
    EXPECT_EQ(resolve_uri(dir.path(), "inside"), dir.path() / "a.bin");
    EXPECT_NE(refusal(dir.path(), "outside").find("link leads out"), std::string::npos);
    EXPECT_NE(refusal(dir.path(), "folder/secret").find("link leads out"), std::string::npos);
    EXPECT_EQ(refusal(dir.path(), "loop").find("resolved"), std::string::npos);
}

TEST(ResolveUri, DoesNotTakeASiblingForInside) {
    const TempDir dir;
    dir.write("scene/a.bin", "x");
    dir.write("scene-2/secret", "x");
    std::filesystem::create_symlink(dir.path() / "scene-2/secret", dir.path() / "scene/link");
    EXPECT_NE(refusal(dir.path() / "scene", "link").find("link leads out"), std::string::npos);
}

TEST(ResolveUri, RefusesPipesAndDirectories) {
    const TempDir dir;
    dir.write("sub/a", "x");
    ASSERT_EQ(mkfifo((dir.path() / "pipe").c_str(), 0600), 0);
    EXPECT_NE(refusal(dir.path(), "pipe").find("regular file"), std::string::npos);
    EXPECT_NE(refusal(dir.path(), "sub").find("regular file"), std::string::npos);
}

TEST(ResolveName, GivesPercentNoMeaning) {
    const TempDir dir;
    dir.write("100%.hdr", "x");
    EXPECT_EQ(resolve_name(dir.path(), "100%.hdr"), dir.path() / "100%.hdr");
}

TEST(ResolveAsset, FindsFilesOfTheSceneAndOfDirectoriesThatAreNamed) {
    const TempDir scene;
    const TempDir first;
    const TempDir second;
    scene.write("own.exr", "x");
    first.write("both.exr", "x");
    second.write("both.exr", "x");
    second.write("sky/noon.exr", "x");
    const std::vector<std::filesystem::path> assets{first.path(), second.path()};
    const auto find = [&](const std::string& name) { return resolve_asset(scene.path(), assets, name); };
    EXPECT_EQ(find("own.exr"), scene.path() / "own.exr");
    EXPECT_EQ(find("both.exr"), first.path() / "both.exr");
    EXPECT_EQ(find("sky/noon.exr"), second.path() / "sky/noon.exr");
    EXPECT_EQ(find((second.path() / "sky/noon.exr").string()), second.path() / "sky/noon.exr");
    const std::string from_scene = "../" + second.path().filename().string() + "/sky/noon.exr";
    EXPECT_EQ(find(from_scene), second.path() / "sky/noon.exr");
}

TEST(ResolveAsset, ReadsNothingFromElsewhere) {
    const TempDir scene;
    const TempDir assets;
    const TempDir elsewhere;
    elsewhere.write("secret.exr", "x");
    const std::filesystem::path secret = elsewhere.path() / "secret.exr";
    std::filesystem::create_symlink(secret, assets.path() / "link.exr");
    const auto refusal_of = [&](const std::string& name, const std::vector<std::filesystem::path>& directories) {
        try {
            return "resolved to " + resolve_asset(scene.path(), directories, name).string();
        } catch (const IoError& error) {
            return std::string(error.what());
        }
    };
    const std::vector<std::filesystem::path> one{assets.path()};
    const std::vector<std::filesystem::path> missing{scene.path() / "nowhere"};
    for (const std::string& name :
         {secret.string(), "../" + elsewhere.path().filename().string() + "/secret.exr", std::string("absent.exr")}) {
        EXPECT_NE(refusal_of(name, one).find("in none of the directories of --assets"), std::string::npos) << name;
        EXPECT_NE(refusal_of(name, missing).find("in none of the directories"), std::string::npos) << name;
        EXPECT_NE(refusal_of(name, {}).find("; --assets DIR names"), std::string::npos) << name;
    }
    const std::string outward = refusal_of("link.exr", one);
    EXPECT_NE(outward.find("a symbolic link leads out of this directory"), std::string::npos) << outward;
}

TEST(ResolveAsset, SaysWhyADirectoryRefusesWhatItHas) {
    const TempDir scene;
    const TempDir empty;
    const TempDir assets;
    std::filesystem::create_directory(assets.path() / "folder.exr");
    std::filesystem::create_symlink("loop.exr", assets.path() / "loop.exr");
    std::filesystem::create_symlink("nothing", assets.path() / "dangling.exr");
    ASSERT_EQ(mkfifo((assets.path() / "pipe.exr").c_str(), 0600), 0);
    const std::vector<std::filesystem::path> directories{empty.path(), assets.path()};
    const std::pair<std::string, const char*> cases[] = {
        {"folder.exr", "this is not a regular file"},
        {"pipe.exr", "this is not a regular file"},
        {"loop.exr", "cannot be reached"},
        {"dangling.exr", "leads to a file that does not exist"},
        {(assets.path() / "pipe.exr").string(), "this is not a regular file"},
        {(assets.path() / "loop.exr").string(), "cannot be reached"},
    };
    for (const auto& [name, reason] : cases) {
        try {
            ADD_FAILURE() << resolve_asset(scene.path(), directories, name);
        } catch (const IoError& error) {
            const std::string said = error.what();
            const std::size_t at = said.find("in '" + assets.path().string() + "' of --assets");
            EXPECT_NE(at, std::string::npos) << said;
            EXPECT_NE(said.find(reason, at), std::string::npos) << said;
        }
    }
}

TEST(ReadBytes, ReadsAllOrTheFirstOnes) {
    const TempDir dir;
    dir.write("a", "hello");
    EXPECT_EQ(read_bytes(dir.path() / "a", 100).size(), 5u);
    EXPECT_EQ(read_bytes(dir.path() / "a", 100, 2).size(), 2u);
    EXPECT_THROW(static_cast<void>(read_bytes(dir.path() / "a", 4)), IoError);
    EXPECT_THROW(static_cast<void>(read_bytes(dir.path() / "a", 100, 6)), IoError);
    EXPECT_THROW(static_cast<void>(read_bytes(dir.path() / "b", 100)), IoError);
    EXPECT_THROW(static_cast<void>(read_bytes(dir.path(), 100)), IoError);
}

}  // namespace
}  // namespace etendue
