#include "core/write_file.h"

#include "core/error.h"

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

// An open file of the name `path`, for messages. Closing can report what earlier writes could not (a full disk or quota),
// hence `close()`.
class OpenFile {
  public:
    OpenFile(const std::filesystem::path& path, int fd) : path_(path), fd_(fd) {}
    ~OpenFile() {
        if (fd_ >= 0) ::close(fd_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    void write(std::span<const std::byte> bytes) const {
        while (!bytes.empty()) {
            const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) throw_errno(path_, errno);
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
    }
    void sync() const {
        if (::fsync(fd_) != 0) throw_errno(path_, errno);
    }
    void close() {
        if (::close(std::exchange(fd_, -1)) != 0) throw_errno(path_, errno);
    }

  private:
    const std::filesystem::path& path_;
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
    void rename_to(const std::filesystem::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) throw_errno(target, errno);
        path_.clear();
    }

  private:
    std::filesystem::path path_;
    int fd_ = -1;
};

void write_in_place(const std::filesystem::path& path, const std::function<void(const ByteSink&)>& produce) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd < 0) throw_errno(path, errno);
    OpenFile file(path, fd);
    produce([&](std::span<const std::byte> bytes) { file.write(bytes); });
    file.close();
}

}  // namespace

void write_file(const std::filesystem::path& path, const std::function<void(const ByteSink&)>& produce) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        return write_in_place(path, produce);
    }
    const auto target = std::filesystem::is_symlink(path, ignored) && std::filesystem::exists(status)
                            ? std::filesystem::canonical(path)
                            : path;
    TemporaryFile temporary(target);
    OpenFile file(path, temporary.descriptor());
    produce([&](std::span<const std::byte> bytes) { file.write(bytes); });
    file.sync();
    file.close();
    temporary.rename_to(target);
}

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    write_file(path, [&](const ByteSink& sink) { sink(bytes); });
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    write_bytes(path, std::as_bytes(std::span(text)));
}

}  // namespace etendue
