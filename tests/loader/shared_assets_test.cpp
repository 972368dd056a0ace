// Real files, where the folder with them is present: models must load, broken files must give the stated problem.

#include "loader/gltf/gltf_builder.h"

#include <set>

#include <gtest/gtest.h>

namespace etendue {
namespace {

const std::filesystem::path kAssets = ETENDUE_SHARED_ASSETS;

std::vector<std::filesystem::path> gltf_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

struct Expectation {
    const char* file;
    Severity severity;  ///< Error: the file is refused. Warning: it loads, repaired.
    const char* message;
    const char* pointer;
};

/// What is wrong with each broken file, and what becomes of it.
const Expectation kBroken[] = {
    {"BoxBadNormals-glTF-Binary/BoxBadNormals.glb", Severity::Warning, "normals that are zero", "/NORMAL"},
    {"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", Severity::Warning, "not finite", "/POSITION"},
    {"IncorrectVertexArrays/Cube.gltf", Severity::Warning, "left over after a primitive's last triangle are ignored (2",
     ""},
    {"IndexOutOfRange/AllIndicesOutOfRange.gltf", Severity::Error, "index 0 is 65535", "/indices"},
    {"IndexOutOfRange/IndexOutOfRange.gltf", Severity::Error, "index 0 is 255", "/indices"},
    {"MissingBin/BoxTextured.gltf", Severity::Error, "'BoxTextured0.bin': the file does not exist", "/buffers/0"},
    {"RecursiveNodes/RecursiveNodes.gltf", Severity::Error, "its own ancestor", "/nodes/0"},
    {"SchemaFailures/sceneWrongType.gltf", Severity::Error, "must be an integer, but is a string", "/scene"},
    {"TestNoRootNode/NoScene.gltf", Severity::Error, "refers to number 0 of /scenes, but there are 0", "/scene"},
    {"TestNoRootNode/SceneWithoutNodes.gltf", Severity::Warning, "shows no surfaces", ""},
    {"issue_3269/texcoord_crash.gltf", Severity::Warning, "texture coordinates that a material needs", ""},
    {"wrongTypes/badArray.gltf", Severity::Error, "must be an array, but is an object", "/meshes/0/primitives"},
    {"wrongTypes/badExtension.gltf", Severity::Error, "must be an object, but is a string", "/KHR_texture_transform"},
    {"wrongTypes/badNumber.gltf", Severity::Error, "must be a number, but is a string", "/normalTexture/scale"},
    {"wrongTypes/badObject.gltf", Severity::Error, "must be an object, but is an array", "/pbrMetallicRoughness"},
    {"wrongTypes/badString.gltf", Severity::Error, "must be a string, but is a number", "/scenes/0/name"},
    {"wrongTypes/badUint.gltf", Severity::Error, "refers to number -1", "/baseColorTexture/index"},
};

const Expectation* find_expectation(std::span<const Expectation> expectations, const std::string& file) {
    for (const Expectation& e : expectations) {
        if (file == e.file) return &e;
    }
    return nullptr;
}

void check(const Expectation& expected, const LoadedScene& loaded) {
    EXPECT_TRUE(has_problem(loaded.problems, expected.severity, expected.message, expected.pointer))
        << expected.file << "\n"
        << listing(loaded.problems);
    EXPECT_EQ(loaded.problems.has_errors(), expected.severity == Severity::Error) << listing(loaded.problems);
}

TEST(SharedAssets, ModelsLoad) {
    const std::filesystem::path folder = kAssets / "models";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
    for (const std::filesystem::path& file : gltf_files(folder)) {
        SCOPED_TRACE(file);
        const LoadedScene loaded = inspect_scene(file);
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
        EXPECT_FALSE(loaded.scene.instances.empty());
        EXPECT_FALSE(compute_bounds(loaded.scene).empty());
    }
}

TEST(SharedAssets, BrokenFilesGiveTheirProblem) {
    const std::filesystem::path folder = kAssets / "broken";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
    for (const std::filesystem::path& file : gltf_files(folder)) {
        SCOPED_TRACE(file);
        const Expectation* expected = find_expectation(kBroken, file.lexically_relative(folder).string());
        const LoadedScene loaded = inspect_scene(file);
        if (expected == nullptr) {
            ADD_FAILURE() << "not in the table; it gives\n" << listing(loaded.problems);
            continue;
        }
        check(*expected, loaded);
    }
}

}  // namespace
}  // namespace etendue
