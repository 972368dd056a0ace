#include "compare/image_store.h"

#include "core/error.h"
#include "core/system_error_text.h"

#include <cerrno>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

namespace {

[[noreturn]] void fail(const char* what, const std::filesystem::path& directory, int error) {
    throw IoError(
        fmt::format("cannot {} a temporary file in {}: {}", what, directory.string(), system_error_text(error)));
}

}  // namespace

ImageStore::ImageStore(const std::filesystem::path& directory, int width, int height, int channels)
    : directory_(directory), width_(width), height_(height), channels_(channels) {
    std::string name = (directory / ".images.XXXXXX").string();
    file_ = FileDescriptor(mkostemp(name.data(), O_CLOEXEC));
    if (!file_.is_open()) fail("make", directory, errno);
    unlink(name.c_str());
}

std::size_t ImageStore::image_bytes() const {
    return sizeof(float) * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
           static_cast<std::size_t>(channels_);
}

std::size_t ImageStore::add(const ImageF& image) {
    const auto* bytes = reinterpret_cast<const char*>(image.pixels.data());
    for (std::size_t done = 0; done < image_bytes();) {
        const ssize_t written =
            pwrite(file_.get(), bytes + done, image_bytes() - done, static_cast<off_t>(count_ * image_bytes() + done));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail("write", directory_, written < 0 ? errno : ENOSPC);
        done += static_cast<std::size_t>(written);
    }
    return count_++;
}

ImageF ImageStore::get(std::size_t index) const {
    ImageF image(width_, height_, channels_);
    auto* bytes = reinterpret_cast<char*>(image.pixels.data());
    for (std::size_t done = 0; done < image_bytes();) {
        const ssize_t got =
            pread(file_.get(), bytes + done, image_bytes() - done, static_cast<off_t>(index * image_bytes() + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) fail("read", directory_, got < 0 ? errno : EIO);
        done += static_cast<std::size_t>(got);
    }
    return image;
}

}  // namespace etendue
