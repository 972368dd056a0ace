// An image that a browser looks at: as a picture through a view, and as the numbers below the pointer.
#pragma once

#include "color/color_config.h"
#include "live/live_server.h"
#include "output/display_image.h"
#include "output/output_frame.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

/// Describes an image to a page.
struct LiveImageFacts {
    std::uint64_t version = 0;  ///< grows with each
    int width = 0;              ///< pixels
    int height = 0;             ///< pixels
    std::vector<std::string> layers{};
    int spp = 0;  ///< 0 for a small image while the camera moves
    std::string integrator{};
    std::string space{};  ///< colour space of its numbers
    DisplayView shown{};  ///< how it is shown by itself
};

/// Holds the newest state of an image, and answers requests for it. Safe to use from several threads.
class LiveImage {
  public:
    explicit LiveImage(ColorConfig colors) : colors_(std::move(colors)) {}

    /// Takes an image in place of the one before.
    void set(OutputFrame frame);

    /// Answers with an 8-bit PNG. The query may name a `layer`, and a `display`, `view` and `exposure` in place of the
    /// image's own; layers that are no colours are shown as `view` shows them.
    [[nodiscard]] LiveAnswer png(const LiveRequest& request) const;
    /// Answers with the numbers of the pixel at `u` and `v`, shares of the width and the height from the top left
    /// corner, in the layer that the query names.
    [[nodiscard]] LiveAnswer pixel(const LiveRequest& request) const;
    /// Describes the image; nothing if there is none.
    [[nodiscard]] std::optional<LiveImageFacts> facts() const;

  private:
    struct Held {
        std::uint64_t version = 0;
        std::shared_ptr<const OutputFrame> frame{};
    };

    [[nodiscard]] Held held() const;

    ColorConfig colors_;
    mutable std::mutex mutex_;
    Held held_;
    mutable std::string png_key_;  ///< layer and view that `png_` shows
    mutable std::string png_;      ///< the last picture that was asked for
};

}  // namespace etendue
