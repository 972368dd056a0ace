// What tests/fuzz starts from: words and files of everything that the loader reads, or it would hardly ever get there.

#include "loader/gltf/gltf_builder.h"
#include "loader/gltf/gltf_document.h"
#include "loader/gltf/gltf_shape.h"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

namespace etendue {
namespace {

const std::filesystem::path kFuzz = ETENDUE_SOURCE_DIR "/tests/fuzz";

/// The entries of the dictionary, as they stand in it.
std::set<std::string> dictionary() {
    std::set<std::string> entries;
    std::ifstream stream(kFuzz / "gltf.dict");
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with('"')) entries.insert(line);
    return entries;
}

std::string quoted(std::string_view word) {
    return "\"\\\"" + std::string(word) + "\\\"\"";
}

/// Adds every name and every text of `shape` to `words`.
void collect(const Shape& shape, std::set<std::string_view>& words) {
    words.insert(shape.texts.begin(), shape.texts.end());
    if (shape.element != nullptr) collect(*shape.element, words);
    for (const ShapeField& field : std::span(shape.fields, shape.field_count)) {
        words.insert(field.key);
        collect(field.shape, words);
    }
}

TEST(FuzzDictionary, HasEveryWordThatIsRead) {
    std::set<std::string_view> words;
    collect(gltf_shape(), words);
    for (const auto extensions : {supported_gltf_extensions(), irrelevant_gltf_extensions()})
        words.insert(extensions.begin(), extensions.end());
    EXPECT_GT(words.size(), 150u);
    const std::set<std::string> entries = dictionary();
    for (const std::string_view word : words) EXPECT_TRUE(entries.contains(quoted(word))) << word;
}

/// The seed in `file`, loaded as tests/fuzz/gltf_fuzz.cpp does.
LoadedScene load_seed(const std::filesystem::path& file) {
    const TempDir directory;
    std::filesystem::copy(kFuzz / "beside", directory.path());
    std::filesystem::copy(file, directory.path() / "scene.gltf");
    LoadOptions options;
    options.adjust = [](RenderSettings& settings) {
        settings.time_code = 0.25;
        settings.shutter = {0.0, 0.5};
    };
    return inspect_scene(directory.path() / "scene.gltf", options);
}

// Mutations of what is refused at once, or passed over, lead nowhere.
TEST(FuzzCorpus, EverySeedIsShown) {
    for (const auto& entry : std::filesystem::directory_iterator(kFuzz / "corpus")) {
        const LoadedScene loaded = load_seed(entry.path());
        EXPECT_FALSE(loaded.problems.has_errors()) << entry.path() << ":\n" << listing(loaded.problems);
        EXPECT_FALSE(has_problem(loaded.problems, Severity::Warning, "ignored")) << entry.path() << ":\n"
                                                                                 << listing(loaded.problems);
        EXPECT_FALSE(loaded.scene.instances.empty()) << entry.path();
        EXPECT_LE(entry.file_size(), 8192u) << entry.path() << ": small ones are mutated faster";
    }
}

TEST(FuzzCorpus, UsesEveryExtension) {
    std::set<std::string> used;
    for (const auto& entry : std::filesystem::directory_iterator(kFuzz / "corpus")) {
        const LoadedScene loaded = load_seed(entry.path());
        used.insert(loaded.scene.extensions_used.begin(), loaded.scene.extensions_used.end());
    }
    for (const std::string_view extension : supported_gltf_extensions())
        EXPECT_TRUE(used.contains(std::string(extension))) << extension;
}

}  // namespace
}  // namespace etendue
