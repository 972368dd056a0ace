// Images of one size that do not all fit into memory.
#pragma once

#include "image/image.h"
#include "process/file_descriptor.h"

#include <cstddef>
#include <filesystem>

namespace etendue {

/// Keeps images in a file that has no name, and is gone with this object or the process.
class ImageStore {
  public:
    /// The file lies in `directory`. Throws IoError if it cannot be made.
    ImageStore(const std::filesystem::path& directory, int width, int height, int channels);

    /// Returns the number to get it back by. `image` has the store's size. Throws IoError if the disk is full.
    std::size_t add(const ImageF& image);
    [[nodiscard]] ImageF get(std::size_t index) const;

  private:
    [[nodiscard]] std::size_t image_bytes() const;

    std::filesystem::path directory_;
    int width_;
    int height_;
    int channels_;
    FileDescriptor file_;
    std::size_t count_ = 0;
};

}  // namespace etendue
