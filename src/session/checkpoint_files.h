// The checkpoints of one image, which stand beside it until it is complete.
#pragma once

#include "core/pixel_rect.h"
#include "render/checkpoint.h"
#include "render/render.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace etendue {

class CheckpointFiles {
  public:
    /// Names the checkpoints of `output`: NAME.checkpoint for the image NAME.exr, NAME.partial.checkpoint for the part
    /// NAME.partial, and either with ".previous" behind the name in case the newest file is damaged.
    explicit CheckpointFiles(const std::filesystem::path& output);

    /// Describes the render that a checkpoint must be of for that render to go on.
    struct Expected {
        const RenderIdentity& identity;
        PixelRect window;
        PixelRect splat_window;
        std::uint32_t first_sample = 0;
        bool every_other_pass = false;            ///< it must be kept; otherwise it is dropped
        bool adaptive = false;                    ///< pixels may have more samples than others
        std::optional<std::uint32_t> most_spp{};  ///< that it may have, with those of a pass that was stopped
    };

    /// Writes a new one; what was the newest becomes the previous one. At every moment one of the two is whole. Throws
    /// IoError.
    void write(const RenderIdentity& identity, const std::string& description, const RenderState& state) const;

    /// The newest that is whole; none if there is no file. Warns of those that are damaged or cannot be read, unless
    /// `quiet`, and replaces the newest by the previous one if only that is whole. Throws IoError if a damaged one
    /// cannot be replaced, or if one cannot be read and there is no other, RefusedCheckpoint if
    /// all are damaged, or with every difference if the checkpoint is of another format or render than what is
    /// expected.
    [[nodiscard]] std::optional<Checkpoint> read(const Expected& expected, bool quiet) const;

    /// Returns the paths of the newest and the previous checkpoint, whether the files exist or not.
    [[nodiscard]] std::array<std::filesystem::path, 2> paths() const { return {newest_, previous_}; }
    /// True if there is one.
    [[nodiscard]] bool exist() const;
    /// True if `file` does not exist, or a checkpoint was written after it.
    [[nodiscard]] bool are_newer_than(const std::filesystem::path& file) const;
    /// Once the image is complete.
    void remove() const;

  private:
    std::filesystem::path newest_;
    std::filesystem::path previous_;
};

/// Describes the checkpoint of a render of an image by itself with `options`, with `every_other_pass` for an estimate
/// of the image's error or for denoising; `identity` outlives the result.
[[nodiscard]] CheckpointFiles::Expected expected_image(const RenderIdentity& identity, const RenderOptions& options,
                                                       bool every_other_pass);

/// Describes the checkpoint of a render of a part from `first_sample` on, with no more samples than `options` ask for;
/// `identity` outlives the result.
[[nodiscard]] CheckpointFiles::Expected expected_part(const RenderIdentity& identity, const RenderOptions& options,
                                                      std::uint32_t first_sample, bool every_other_pass);

/// True if a render can go on with `kept`.
[[nodiscard]] bool is_of(const Checkpoint& kept, const CheckpointFiles::Expected& expected);

/// Returns the file that keeps the sums of the finished image `output`, so that more samples can go on from them.
[[nodiscard]] std::filesystem::path sums_path(const std::filesystem::path& output);

/// Writes the sums of the finished image `output` if `are_kept`, with its `description`. Otherwise, or if they cannot
/// be written, which is said, removes those of an earlier image, which are of no more use.
void keep_sums(const std::filesystem::path& output, bool are_kept, const RenderIdentity& identity,
               const std::string& description, const RenderState& state);

/// Reads the sums in `file`; none if there are none, or if they are of another render than what is expected or have
/// more than `most_spp` samples. Warns of those that are damaged or cannot be read, unless `quiet`.
[[nodiscard]] std::optional<Checkpoint> read_sums(const std::filesystem::path& file,
                                                  const CheckpointFiles::Expected& expected, int most_spp, bool quiet);

/// The part in `file`; none if there is none, or, with a warning unless `quiet`, if it is damaged. Throws
/// RefusedCheckpoint with every difference if it is of another render than what is expected: it took somebody's time.
[[nodiscard]] std::optional<Checkpoint> read_part(const std::filesystem::path& file,
                                                  const CheckpointFiles::Expected& expected, bool quiet);

}  // namespace etendue
