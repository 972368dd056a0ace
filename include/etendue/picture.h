// A rendered image: its pixels, its layers, and writing it.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include <etendue/message.h>

namespace etendue {

class Scene;
struct RenderControl;

/// One image of a picture besides its colour, such as depth or normals.
struct Layer {
    std::string name;
    std::string channels;           ///< a letter each
    std::span<const float> values;  ///< channel by channel within a pixel, pixels row by row from the top left
};

/// A value. Spans that it hands out live as long as it does, also when it is moved.
class [[gnu::visibility("default")]] Picture {
  public:
    ~Picture();
    Picture(const Picture& other);
    Picture(Picture && other) noexcept;
    Picture& operator=(Picture other) noexcept;

    [[nodiscard]] int width() const;   ///< pixels
    [[nodiscard]] int height() const;  ///< pixels
    /// Red, green, blue and alpha of each pixel, row by row from the top left. Proportional to light, in the space
    /// `working_space`; colours are already multiplied by alpha.
    [[nodiscard]] std::span<const float> pixels() const;
    /// A scene-linear space of the OpenColorIO config.
    [[nodiscard]] const std::string& working_space() const;
    /// The layers that the settings ask for ("aovs"). Colours are in the working space, too.
    [[nodiscard]] std::span<const Layer> layers() const;

    /// False if rendering was stopped before it had all samples.
    [[nodiscard]] bool is_complete() const;
    /// Samples that every pixel has; of an adaptive render, passes.
    [[nodiscard]] int samples_per_pixel() const;
    /// Seconds that rendering took.
    [[nodiscard]] double seconds() const;
    /// Notes and warnings of rendering.
    [[nodiscard]] std::span<const Message> messages() const;

    enum class Depth {
        Half,   ///< 16-bit floats
        Float,  ///< 32-bit floats
    };
    /// Writes the EXR `file`, and layers as the settings ask for it: into it, or into files beside it. A file is
    /// written whole or not at all. Throws Error, also if `file` is one that the scene was read from.
    void write_exr(const std::filesystem::path& file, Depth depth = Depth::Half) const;

  private:
    friend Picture render(Scene scene, const RenderControl& control);
    struct [[gnu::visibility("hidden")]] State;
    explicit Picture(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace etendue
