// Colour management on OpenColorIO: input spaces to the working space, the working space to output spaces and views.
#pragma once

#include "core/rgb.h"

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// A 3 × 3 matrix between two linear spaces, applied to column vectors.
struct ColorMatrix {
    std::array<float, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major

    [[nodiscard]] Rgb operator()(const Rgb& c) const {
        return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b,
                m[6] * c.r + m[7] * c.g + m[8] * c.b};
    }
};

/// Any conversion, as OpenColorIO compiles it. Cheap to copy, safe to use from several threads.
class ColorTransform {
  public:
    ColorTransform();
    ~ColorTransform();
    ColorTransform(const ColorTransform&);
    ColorTransform& operator=(const ColorTransform&);

    [[nodiscard]] Rgb operator()(const Rgb& c) const;
    /// Converts pixels of `channels` (3 or 4) interleaved floats in place; alpha is left alone.
    void apply(std::span<float> pixels, int channels) const;

  private:
    friend class ColorConfig;
    struct Impl;
    std::shared_ptr<const Impl> impl_;
};

/// CIE xy of the primaries and the white point of a linear RGB space.
struct Chromaticities {
    std::array<float, 2> red, green, blue, white;
};

/// An OpenColorIO config.
class ColorConfig {
  public:
    /// Path of the config that $OCIO names; empty if it is unset or empty.
    [[nodiscard]] static std::filesystem::path environment_path();
    /// Reads the config that $OCIO names, else the project's own, which is built into the program. Throws SceneError if
    /// the config cannot be read, refers to itself, or has a table that is no regular file.
    [[nodiscard]] static ColorConfig from_environment();
    /// Lists the config that $OCIO names and the tables that it reads; none if $OCIO is unset or empty. Throws
    /// SceneError.
    [[nodiscard]] static std::vector<std::filesystem::path> environment_files();
    [[nodiscard]] static ColorConfig built_in();
    [[nodiscard]] static ColorConfig from_file(const std::filesystem::path& path);

    /// Name of the space with role `scene_linear`.
    [[nodiscard]] std::string default_working_space() const;
    [[nodiscard]] std::vector<std::string> spaces() const;
    [[nodiscard]] std::vector<std::string> displays() const;
    [[nodiscard]] std::vector<std::string> views(const std::string& display) const;
    [[nodiscard]] std::string default_display() const;
    [[nodiscard]] std::string default_view(const std::string& display) const;
    /// The config and the tables it names that exist; none if it is built in.
    [[nodiscard]] const std::vector<std::filesystem::path>& files() const;
    /// Path of the config, or "built-in".
    [[nodiscard]] const std::string& origin() const;

    /// Canonical name of the space, alias or role `name`. Throws SceneError with the nearest known name if there is
    /// none.
    [[nodiscard]] std::string resolve_space(const std::string& name) const;

    /// Throws SceneError if a name is unknown.
    [[nodiscard]] ColorTransform transform(const std::string& from, const std::string& to) const;
    /// Returns the conversion between two scene-linear spaces as a matrix. Throws SceneError if a name is unknown or a
    /// space is not linear.
    [[nodiscard]] ColorMatrix matrix(const std::string& from, const std::string& to) const;
    /// Names of the looks: what is done to scene light before the view, such as a grade.
    [[nodiscard]] std::vector<std::string> looks() const;
    /// The looks that a view applies itself, as the config lists them; empty if it applies none.
    [[nodiscard]] std::string looks_of_view(const std::string& display, const std::string& view) const;
    /// Returns the conversion from `working` to encoded display values; `exposure` in stops is applied first, in
    /// `working`. `look` is applied to the light before the view and takes the place of the view's own looks: a name,
    /// several with commas between them (a minus before a name undoes it), `kNoLook` for none at all, or empty for the
    /// view's own. Throws SceneError if a name is unknown.
    [[nodiscard]] ColorTransform display_transform(const std::string& working, const std::string& display,
                                                   const std::string& view, float exposure,
                                                   const std::string& look = {}) const;
    /// Throws what `display_transform` throws for such a look.
    void require_look(const std::string& look) const;
    /// Name of the space with the primaries and the white of ACES2065-1 (SMPTE ST 2065-1); empty if there is none.
    [[nodiscard]] std::string aces_space() const;
    /// Returns the chromaticities of a scene-linear space: the published ones with the space's own white if its
    /// conversion to ACES2065-1 (adapted by Bradford) is that of a known set of primaries, else those after adaptation
    /// to D65. Throws SceneError if the space is not linear or the config has no ACES2065-1.
    [[nodiscard]] Chromaticities chromaticities(const std::string& space) const;
    /// Weights of R, G and B of a scene-linear space in CIE luminance Y, from its chromaticities; the config's own luma
    /// weights where those are unknown. Throws SceneError if the space is not linear.
    [[nodiscard]] Rgb luminance_weights(const std::string& space) const;

  private:
    struct Impl;
    explicit ColorConfig(std::shared_ptr<const Impl> impl);
    std::shared_ptr<const Impl> impl_;
};

/// A view without its own looks.
inline constexpr const char* kNoLook = "none";

/// Version of the colour library.
[[nodiscard]] std::string color_library_version();

/// The space that glTF's colour factors and emission are in, by the name of the project's config.
inline constexpr const char* kGltfColorSpace = "Linear Rec.709 (sRGB)";

}  // namespace etendue
