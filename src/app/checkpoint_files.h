// The checkpoints of one image, which stand beside it until it is complete.
#pragma once

#include "core/pixel_rect.h"
#include "render/checkpoint.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace etendue {

class CheckpointFiles {
  public:
    /// Those of the image `exr`: NAME.checkpoint, and NAME.checkpoint.previous in case it is damaged.
    explicit CheckpointFiles(const std::filesystem::path& exr);

    /// What is to be gone on with.
    struct Expected {
        const RenderIdentity& identity;
        PixelRect window;
        PixelRect splat_window;
        std::uint32_t first_sample = 0;
        bool every_other_pass = false;  ///< it must be kept; otherwise it is dropped
    };

    /// Writes a new one; what was the newest becomes the previous one. At every moment one of the two is whole. Throws
    /// IoError.
    void write(const RenderIdentity& identity, const std::string& description, const RenderState& state) const;

    /// The state of the newest that is whole; none if there is no file. Warns of damaged ones, unless `quiet`, and
    /// replaces the newest by the previous one if only that is whole. Throws
    /// IoError if all are damaged, SceneError with every difference if the checkpoint is of another render than what is
    /// expected.
    [[nodiscard]] std::optional<RenderState> read(const Expected& expected, bool quiet) const;

    /// True if there is one.
    [[nodiscard]] bool exist() const;
    /// Once the image is complete.
    void remove() const;

  private:
    std::filesystem::path newest_;
    std::filesystem::path previous_;
};

/// The state in `file`, if that is there, whole, and of what is expected.
[[nodiscard]] std::optional<RenderState> read_if_expected(const std::filesystem::path& file,
                                                          const CheckpointFiles::Expected& expected);

}  // namespace etendue
