// Whoever looks on while images are rendered: a page in a browser, a viewer elsewhere.
#pragma once

#include "picture/image_description.h"
#include "render/render.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace etendue {

/// Hears how a render goes on, and gets its image from time to time. No pixel depends on it.
class RenderWatcher {
  public:
    RenderWatcher() = default;
    RenderWatcher(const RenderWatcher&) = delete;
    RenderWatcher& operator=(const RenderWatcher&) = delete;
    virtual ~RenderWatcher() = default;

    /// Called before anything is done for an image, which will be the file `output`.
    virtual void begin(const std::string& title, const std::filesystem::path& output) = 0;
    /// Called when a phase begins, which is "load", "resume", "build", "render", "measure" or "write", and at the end
    /// with "finished" or "stopped".
    virtual void enter(std::string_view phase) = 0;
    /// Called from rendering threads, as `ProgressCallback` is.
    virtual void update(const RenderProgress& progress) = 0;
    /// Says whether somebody waits for an image. Called from rendering threads before every tile.
    [[nodiscard]] virtual bool wants_image() const = 0;
    /// Called with the image as far as it is, while nothing is rendered, and at the end with the finished one.
    virtual void show(const ImageDescription& image) = 0;
};

}  // namespace etendue
