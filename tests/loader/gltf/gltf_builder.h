// Small glTF files for tests, built in memory and written to a temporary directory.
#pragma once

#include "loader/loader.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace etendue {

/// A directory that is removed with its content.
class TempDir {
  public:
    TempDir();
    ~TempDir();
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    void write(const std::string& name, const std::string& content) const;

  private:
    std::filesystem::path path_;
};

/// A glTF document and its one buffer.
class GltfBuilder {
  public:
    GltfBuilder();

    nlohmann::json json;
    std::vector<unsigned char> bin;

    /// Appends `values` to the buffer, 4-byte aligned, as a new buffer view; returns its index.
    template <typename T>
    int view(const std::vector<T>& values, int stride = 0) {
        return view_bytes(values.data(), values.size() * sizeof(T), stride);
    }

    /// A view with an accessor of `count` elements; returns the accessor's index.
    template <typename T>
    int accessor(const std::vector<T>& values, const std::string& type, int component_type, std::size_t count,
                 bool normalized = false) {
        return accessor_of_view(view(values), type, component_type, count, normalized);
    }
    int accessor_of_view(int view, const std::string& type, int component_type, std::size_t count,
                         bool normalized = false);

    int floats(const std::vector<float>& values, int components);
    int indices(const std::vector<std::uint32_t>& values);

    /// A mesh of one primitive, a node that shows it, and the scene it is in. Returns the primitive.
    nlohmann::json& add_mesh(nlohmann::json attributes);

    /// The triangle (0,0,0), (1,0,0), (0,1,0). Returns the primitive.
    nlohmann::json& add_triangle();

    /// The scene's environment: a cube map of six images of the same pixel, the last for +X. The scene must be there.
    /// Returns the light.
    nlohmann::json& add_cube_map();

    /// Bytes of a GLB file with these contents.
    [[nodiscard]] std::string glb() const;

    /// Writes scene.gltf and scene.bin.
    void write(const TempDir& directory) const;

    /// Writes to a new directory and loads from it.
    [[nodiscard]] LoadedScene load(const LoadOptions& options = {}) const;

  private:
    int view_bytes(const void* data, std::size_t size, int stride);
    [[nodiscard]] nlohmann::json document(bool with_uri) const;
};

/// A PNG of one pixel.
[[nodiscard]] const std::string& png_bytes();

/// An IES file: 100 candela downwards, 50 sideways.
[[nodiscard]] const std::string& ies_bytes();

/// True if some problem of this severity has `text` in its message and `pointer` as (the end of) its JSON pointer.
[[nodiscard]] bool has_problem(const ProblemList& problems, Severity severity, const std::string& text,
                               const std::string& pointer = "");

/// All problems, one a line, for failure messages.
[[nodiscard]] std::string listing(const ProblemList& problems);

/// The first of what must have been loaded without errors.
[[nodiscard]] const PrimitiveDesc& first_primitive(const LoadedScene& loaded);

}  // namespace etendue
