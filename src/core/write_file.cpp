#include "core/write_file.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/system_error_text.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue {

namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& path, int error) {
    throw IoError(fmt::format("cannot write {}: {}", path.string(), system_error_text(error)));
}

// An open file of the name `path`, for messages. Closing can report what earlier writes could not (a full disk or
// quota), hence `close()`.
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
    void clear() const {
        if (::ftruncate(fd_, 0) != 0) throw_errno(path_, errno);
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

std::string host_name() {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
    return name.data();
}

/// Names of temporary files: a dot before the target's name, and the writer's host and a number behind it.
constexpr std::string_view kTemporaryEnd = ".etendue.tmp";
std::filesystem::path temporary_path(const std::filesystem::path& target, int attempt) {
    constexpr std::size_t kLongestName = 255;  // bytes, on most file systems
    const auto named = [&](const std::string& name) {
        return fmt::format(".{}.{}-{}{}", name, host_name(), attempt, kTemporaryEnd);
    };
    const std::string name = target.filename().string();
    std::string temporary = named(name);
    if (temporary.size() > kLongestName) temporary = named(content_hex(name));
    return target.parent_path() / temporary;
}

/// True if `path` is still the name of the open file `fd`.
bool is_name_of(const std::filesystem::path& path, int fd) {
    struct stat named {};
    struct stat opened {};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(fd, &opened) == 0 && named.st_dev == opened.st_dev &&
           named.st_ino == opened.st_ino;
}

/// After which a file is abandoned whose writer cannot be asked, since it may be on another machine or knows no locks.
constexpr auto kOldAge = std::chrono::hours(1);

/// False if there is no such file.
bool is_old(const std::filesystem::path& path) {
    std::error_code error;
    const auto changed = std::filesystem::last_write_time(path, error);
    return !error && std::filesystem::file_time_type::clock::now() - changed >= kOldAge;
}

enum class Lock { Taken, Held, Unknown };

/// Unknown on file systems without locks.
Lock take_lock(int fd) {
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return Lock::Taken;
    return errno == EWOULDBLOCK ? Lock::Held : Lock::Unknown;
}

/// Opening waits for nobody, if somebody has made a pipe under such a name.
constexpr int kOpenFlags = O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;

/// The open file if nobody else holds it, else -1. The kernel lets go of the files of the dead; where it knows no
/// locks, only those are theirs that are old and `may_be_old`.
int open_unowned(const std::filesystem::path& path, bool may_be_old) {
    const int fd = ::open(path.c_str(), kOpenFlags);
    if (fd < 0) return -1;
    const Lock lock = take_lock(fd);
    // Between opening and locking, its owner may have renamed it: then it is somebody's finished file.
    const bool is_free = lock == Lock::Taken || (lock == Lock::Unknown && may_be_old && is_old(path));
    if (is_free && is_name_of(path, fd)) return fd;
    ::close(fd);
    errno = EWOULDBLOCK;
    return -1;
}

/// Creates the file `path` and returns it open, or opens as open_unowned does one that is there already, else returns
/// -1. A new file belongs to the process that has made it, with a lock or without.
int create_unowned(const std::filesystem::path& path) {
    const int fd = ::open(path.c_str(), kOpenFlags | O_CREAT | O_EXCL, 0666);
    if (fd < 0 && errno == EEXIST) {
        const int left = open_unowned(path, false);
        // It has gone since, or is a pipe: another name is as good.
        if (left < 0 && (errno == ENOENT || errno == ENXIO)) errno = EWOULDBLOCK;
        return left;
    }
    // Somebody who looks for what is abandoned may have been faster with the lock.
    if (fd < 0 || (take_lock(fd) != Lock::Held && is_name_of(path, fd))) return fd;
    ::close(fd);
    errno = EWOULDBLOCK;
    return -1;
}

/// Limits how many processes can write one target at a time.
constexpr int kMostWriters = 1000;

/// Nobody else's, and under a name beside `target`. Throws IoError.
struct UnownedFile {
    std::filesystem::path path;
    int fd;
};
UnownedFile create_temporary(const std::filesystem::path& target) {
    for (int attempt = 0; attempt < kMostWriters; ++attempt) {
        const std::filesystem::path path = temporary_path(target, attempt);
        if (const int fd = create_unowned(path); fd >= 0) return {path, fd};
        if (errno != EWOULDBLOCK) throw_errno(target, errno);
    }
    throw IoError(fmt::format("cannot write {}: too many others do", target.string()));
}

bool remove_unowned(const std::filesystem::path& path) {
    const int fd = open_unowned(path, true);
    if (fd < 0) return false;
    std::error_code ignored;
    const bool removed = std::filesystem::remove(path, ignored);
    ::close(fd);
    return removed;
}

// A name beside the target, removed unless it has been renamed. What a writer that was killed left behind is used again
// by the next one with the same target.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& target) : TemporaryFile(target, create_temporary(target)) {
        file_.clear();
    }
    ~TemporaryFile() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::span<const std::byte> bytes) const { file_.write(bytes); }
    /// Gives it its name once its bytes are on the disk. It is closed after that: closing lets others take the name.
    void finish() {
        file_.sync();
        if (::rename(path_.c_str(), target_.c_str()) != 0) throw_errno(target_, errno);
        path_.clear();
        file_.close();
    }

  private:
    TemporaryFile(const std::filesystem::path& target, UnownedFile temporary)
        : target_(target), path_(std::move(temporary.path)), file_(target, temporary.fd) {}

    const std::filesystem::path& target_;
    std::filesystem::path path_;
    OpenFile file_;  ///< closed after the name is gone
};

void write_in_place(const std::filesystem::path& path, const std::function<void(const ByteSink&)>& produce) {
    // A named pipe that nobody reads from is an error, and nothing to wait for.
    const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0 && errno == ENXIO)
        throw IoError(fmt::format("cannot write {}: nobody reads from the pipe", path.string()));
    if (fd < 0) throw_errno(path, errno);
    OpenFile file(path, fd);
    if (::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) & ~O_NONBLOCK) != 0) throw_errno(path, errno);
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
    produce([&](std::span<const std::byte> bytes) { temporary.write(bytes); });
    temporary.finish();
}

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    write_file(path, [&](const ByteSink& sink) { sink(bytes); });
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    write_bytes(path, std::as_bytes(std::span(text)));
}

void require_no_pipe(const std::filesystem::path& path) {
    // What the process has opened already leads to no file that has a name.
    std::error_code has_no_name;
    (void)std::filesystem::canonical(path, has_no_name);
    if (!has_no_name && (std::filesystem::is_fifo(path) || std::filesystem::is_socket(path)))
        throw IoError(fmt::format("cannot write {}: it is a pipe or a socket, and a file is wanted", path.string()));
}

void remove_abandoned_files_of(const std::filesystem::path& path) {
    std::error_code ignored;
    for (int attempt = 0; attempt < kMostWriters; ++attempt) {
        const std::filesystem::path temporary = temporary_path(path, attempt);
        if (!std::filesystem::exists(temporary, ignored)) return;
        remove_unowned(temporary);
    }
}

std::size_t remove_abandoned_files(const std::filesystem::path& directory) {
    std::size_t removed = 0;
    std::error_code error;
    std::filesystem::recursive_directory_iterator entry(
        directory, std::filesystem::directory_options::skip_permission_denied, error);
    for (; !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with('.') || !name.ends_with(kTemporaryEnd) || !entry->is_regular_file(error)) continue;
        const bool is_ours = name.find(fmt::format(".{}-", host_name())) != std::string::npos;
        if (!is_ours && !is_old(entry->path())) continue;
        if (remove_unowned(entry->path())) ++removed;
    }
    return removed;
}

}  // namespace etendue
