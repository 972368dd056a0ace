#include "image/write_file.h"

#include "core/error.h"
#include "image/write.h"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& path, int error) {
    throw IoError(fmt::format("cannot write {}: {}", path.string(), std::generic_category().message(error)));
}

// An open file descriptor. Closing can report what earlier writes could not (a full disk or quota), hence `close()`.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    // Returns 0 or an errno.
    [[nodiscard]] int write(std::span<const std::byte> bytes) const {
        while (!bytes.empty()) {
            const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) return errno;
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
        return 0;
    }
    // Returns 0 or an errno.
    [[nodiscard]] int close() { return ::close(std::exchange(fd_, -1)) == 0 ? 0 : errno; }

  private:
    int fd_;
};

// A name beside the target, removed unless it has been renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& target) {
        // O_EXCL makes the name ours even if another process or thread picks the same.
        for (int attempt = 0;; ++attempt) {
            path_ =
                target.parent_path() / fmt::format(".{}.{}-{}.tmp", target.filename().string(), ::getpid(), attempt);
            fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (fd_ >= 0) return;
            if (errno != EEXIST) throw_errno(target, errno);
        }
    }
    ~TemporaryFile() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] int descriptor() const { return fd_; }
    [[nodiscard]] int rename_to(const std::filesystem::path& target) {
        std::error_code error;
        std::filesystem::rename(path_, target, error);
        if (!error) path_.clear();
        return error.value();
    }

  private:
    std::filesystem::path path_;
    int fd_ = -1;
};

void write_in_place(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd < 0) throw_errno(path, errno);
    Descriptor file(fd);
    int error = file.write(bytes);
    if (error == 0) error = file.close();
    if (error != 0) throw_errno(path, error);
}

}  // namespace

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        return write_in_place(path, bytes);
    }
    const auto target = std::filesystem::is_symlink(path, ignored) && std::filesystem::exists(status)
                            ? std::filesystem::canonical(path)
                            : path;
    TemporaryFile temporary(target);
    Descriptor file(temporary.descriptor());
    int error = file.write(bytes);
    if (error == 0) error = file.close();
    if (error == 0) error = temporary.rename_to(target);
    if (error != 0) throw_errno(path, error);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    write_bytes(path, std::as_bytes(std::span(text)));
}

}  // namespace etendue
