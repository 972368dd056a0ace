// A folder of the test's own, with scenes small enough to render in a blink.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etendue::test {

/// Named after the running test, removed at its end.
class TestFolder {
  public:
    TestFolder();
    ~TestFolder();
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

/// Names of everything below `folder`, directories included, relative to it and sorted.
[[nodiscard]] std::vector<std::string> list(const std::filesystem::path& folder);
[[nodiscard]] std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& text);

/// A directory with a triangle in front of a camera called "main", an environment, 16 × 12 pixels and 2 samples.
/// `extra` is put into render.json, for example `"seed": 3,`.
void write_scene(const std::filesystem::path& directory, const std::string& extra = "");

/// Gives the triangle of such a scene a texture, "missing.hdr", which is not there.
void name_missing_texture(const std::filesystem::path& directory);
/// An image of one pixel that may lie there.
[[nodiscard]] std::string hdr_bytes();

/// Makes the triangle of such a scene move to the right, off the screen, in the second after time 0. Returns
/// `directory`.
std::string animated_scene(const std::string& directory);

}  // namespace etendue::test
