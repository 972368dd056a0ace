// A scene that is loaded, with its settings.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <etendue/message.h>

namespace etendue {

class Picture;
struct RenderControl;

/// A value: a copy has meshes of its own.
class [[gnu::visibility("default")]] Scene {
  public:
    /// Loads a scene directory, a .gltf or a .glb.
    /// @param settings overrides the scene's render.json: the text of another one, merged as RFC 7386 says; members
    ///        replace members, null restores a default. Every setting is described in render-json.md.
    /// @param frame of the scene's animation; none for the moment that the settings name
    /// Throws Error.
    explicit Scene(const std::filesystem::path& path, std::string_view settings = {}, std::optional<int> frame = {});
    ~Scene();
    Scene(const Scene& other);
    Scene(Scene && other) noexcept;
    Scene& operator=(Scene other) noexcept;

    /// The directory's or file's name without its extension.
    [[nodiscard]] const std::string& name() const;
    /// Pixels of the image that will be rendered, which may be a window of a larger one.
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// Notes and warnings of loading.
    [[nodiscard]] std::span<const Message> messages() const;

  private:
    friend Picture render(Scene scene, const RenderControl& control);
    struct [[gnu::visibility("hidden")]] State;
    std::unique_ptr<State> state_;
};

}  // namespace etendue
