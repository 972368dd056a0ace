// An image whose header has been read and found acceptable. For this room only.
#pragma once

#include "image/encoded_format.h"
#include "image/encoded_image.h"
#include "image/read.h"

#include <memory>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace etendue::oiio {

struct OpenImage {
    std::unique_ptr<OIIO::Filesystem::IOProxy>
        bytes;  // outlives `input`, which reads through it; null for a whole file
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;  ///< the header of `part`, as the library has it
    EncodedFormat format;
    std::int64_t encoded_size = 0;  ///< bytes
    int part = 0;                   ///< the part of a multi-part file that is read
    /// Lists the channels to read, in order: R, G, B and A by name where the file has them (EXR stores channels
    /// alphabetically, and other layers may stand between), else the first four.
    std::vector<int> channels;
};

/// Opens one part of a file; bytes in memory must outlive the result. Throws IoError as `read_image_info` does.
[[nodiscard]] OpenImage open_image(const EncodedImage& encoded, int part = 0);

/// Opens the first part of a file, whose header may claim anything; bytes in memory must outlive the result.
[[nodiscard]] OpenImage open_unchecked(const EncodedImage& encoded);
/// Goes on with another part, whose header may claim anything. Returns false if there is none, or kMostParts before it.
[[nodiscard]] bool seek_part(OpenImage& image, int part);

/// Throws IoError if `seek_part` has failed for another reason than that there are no more parts. Of EXR files only:
/// for other formats, the library calls their end an error, too.
void require_all_parts(const OpenImage& image);
/// Throws IoError if what the header claims is not accepted.
void require_acceptable(const OpenImage& image);

/// Returns what the header of `image` says.
[[nodiscard]] ImageInfo describe(const OpenImage& image);

/// Returns the sizes of the image and, where the file has them, of its mip levels, as far as each is half the one
/// before (rounded down, at least 1).
[[nodiscard]] std::vector<ImageLevel> levels_of(OpenImage& image);

/// Makes `level`, which is `size` large, the one that is read next. Throws IoError if the file says otherwise now that
/// it is looked at: some formats read what a level is only then, and its size decides how much is written into memory.
void seek_level(OpenImage& image, const ImageLevel& size, int level);

/// Moves the selected channels of `count` pixels together: `stored` holds all channels from the first selected to the
/// last.
template <typename T>
void pick_channels(const OpenImage& image, const T* stored, std::size_t count, T* picked);

/// The channels [first, last) of the file that hold all selected ones.
struct ChannelRange {
    int first;
    int last;

    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(last - first); }
};
[[nodiscard]] ChannelRange channel_range(const OpenImage& image);
/// Returns whether `channel_range` is the selected channels in their order, so that nothing has to be picked.
[[nodiscard]] bool channels_in_order(const OpenImage& image);

/// Says which pixels are read, and where to.
struct PixelTarget {
    int part, level;
    ChannelRange channels;
    OIIO::TypeDesc type;
    void* pixels;
    OIIO::stride_t stride = OIIO::AutoStride;  ///< bytes from pixel to pixel; rows follow each other
};

/// Reads rows [begin, end), as the file counts them; false if they are broken.
[[nodiscard]] bool read_rows(OIIO::ImageInput& input, int begin, int end, const PixelTarget& target);
/// Reads tiles with pixels from (x, y) on, `width` x `height` large, as the file counts them; false if they are broken.
[[nodiscard]] bool read_tiles(OIIO::ImageInput& input, int x, int y, const ImageLevel& size, const PixelTarget& target);
/// Reads all pixels of a level; false if they are broken.
[[nodiscard]] bool read_pixels(OIIO::ImageInput& input, const PixelTarget& target);

/// Throws IoError with the library's reason, or std::bad_alloc if that is a lack of memory, which is no fault of the
/// image.
[[noreturn]] void throw_library_error(const OIIO::ImageInput& input, std::string_view what);

template <typename T>
void pick_channels(const OpenImage& image, const T* stored, std::size_t count, T* picked) {
    const ChannelRange range = channel_range(image);
    const std::size_t channels = image.channels.size();
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < channels; ++c)
            picked[i * channels + c] =
                stored[i * range.size() + static_cast<std::size_t>(image.channels[c] - range.first)];
}

}  // namespace etendue::oiio
