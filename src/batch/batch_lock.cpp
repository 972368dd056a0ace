#include "batch/batch_lock.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/log.h"
#include "core/system_error_text.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_errno(const char* what, const fs::path& path, int error) {
    throw IoError(fmt::format("cannot {} {}: {}", what, path.string(), system_error_text(error)));
}

/// True if `path` still is the name of the open file.
bool is_name_of(const fs::path& path, const FileDescriptor& file) {
    struct stat named {};
    struct stat open {};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(file.get(), &open) == 0 && named.st_ino == open.st_ino &&
           named.st_dev == open.st_dev;
}

/// Gives a file the time of its file system.
bool touch(const FileDescriptor& file) {
    return ::futimens(file.get(), nullptr) == 0;
}

/// Holds OUT/.etendue/mutex.
class Mutex {
  public:
    explicit Mutex(const fs::path& directory) : path_(directory / "mutex") {
        // Whoever finds nothing left to do removes the directory: then it is made again.
        do {
            std::error_code error;
            fs::create_directories(directory, error);
            if (error) throw_errno("make", directory, error.value());
            file_ = FileDescriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
            if (!file_.is_open() && errno != ENOENT) throw_errno("open", path_, errno);
            if (file_.is_open()) lock();
        } while (!file_.is_open() || !is_name_of(path_, file_));
    }

    [[nodiscard]] const fs::path& path() const { return path_; }

    /// Returns what time it is for the file system: only that time can be compared with the times of its files.
    [[nodiscard]] timespec time_of_files() const {
        struct stat status {};
        if (!touch(file_) || ::fstat(file_.get(), &status) != 0) throw_errno("touch", path_, errno);
        return status.st_mtim;
    }

  private:
    void lock() const {
        while (::flock(file_.get(), LOCK_EX) != 0)
            if (errno != EINTR) throw_errno("lock", path_, errno);
    }

    fs::path path_;
    FileDescriptor file_;
};

std::string to_json(const ProcessOwner& owner, const std::string& image) {
    const nlohmann::ordered_json json{{"image", image},
                                      {"host", owner.host},
                                      {"pid", owner.pid},
                                      {"start_time", owner.start_time},
                                      {"machine", owner.machine}};
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Reads the owner in a lock's file; none if it cannot be read: whoever died while writing left it so, or another
/// machine has not seen its content yet.
std::optional<ProcessOwner> read_owner(const fs::path& file) {
    constexpr std::size_t kMostBytes = 1 << 16;
    std::string text(kMostBytes, '\0');
    std::ifstream in = open_regular_file(file);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        return ProcessOwner{json.at("host"), json.at("machine"), json.at("pid"), json.at("start_time")};
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

/// Returns whether `file` was last touched at most `dead_after` before the time `now()`, a timespec. No owner has made
/// what is no regular file.
template <typename Now>
bool is_young(const fs::path& file, const Now& now, std::chrono::seconds dead_after) {
    if (is_irregular(file)) return false;
    // Opened, so that a network file system asks its server.
    const FileDescriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status {};
    if (!opened.is_open() || ::fstat(opened.get(), &status) != 0) return false;
    return now().tv_sec - status.st_mtim.tv_sec <= dead_after.count();
}

/// Returns whether the owner of the lock `file` is alive at the time `now()`, as far as one can tell.
template <typename Now>
bool is_held(const std::optional<ProcessOwner>& owner, const fs::path& file, const Now& now,
             std::chrono::seconds dead_after) {
    const Liveness known = owner ? liveness(*owner) : Liveness::Unknown;
    return known == Liveness::Unknown ? is_young(file, now, dead_after) : known == Liveness::Alive;
}

/// Creates a file that is on the disk when this returns: another machine would otherwise see a file that says nothing.
FileDescriptor create(const fs::path& file, const std::string& text) {
    FileDescriptor created(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!created.is_open()) throw_errno("write", file, errno);
    const ssize_t written = ::write(created.get(), text.data(), text.size());
    const bool is_whole = written == static_cast<ssize_t>(text.size());
    if (!is_whole || ::fsync(created.get()) != 0) {
        const int error = written < 0 || is_whole ? errno : ENOSPC;
        ::unlink(file.c_str());
        throw_errno("write", file, error);
    }
    return created;
}

}  // namespace

BatchLock::BatchLock(fs::path directory, fs::path file, FileDescriptor descriptor,
                     std::optional<ProcessOwner> dead_owner, std::chrono::milliseconds between_touches)
    : directory_(std::move(directory)),
      file_(std::move(file)),
      descriptor_(std::move(descriptor)),
      dead_owner_(std::move(dead_owner)),
      between_touches_(between_touches) {}

BatchLock::~BatchLock() {
    if (!descriptor_.is_open()) return;
    try {
        const Mutex mutex(directory_);
        if (is_ours()) ::unlink(file_.c_str());
    } catch (const std::exception& error) {
        log_warning("warning: {} is left until this process ends: {}", file_.string(), error.what());
    }
}

bool BatchLock::is_ours() const {
    return is_name_of(file_, descriptor_);
}

bool BatchLock::keep_alive() {
    const Clock::time_point now = Clock::now();
    if (now - touched_ < between_touches_) return true;
    touched_ = now;
    touch(descriptor_);
    return is_ours();
}

BatchLocks::BatchLocks(const fs::path& output, LockTimes times) : directory_(output / ".etendue"), times_(times) {}

fs::path BatchLocks::file_of(const std::string& image) const {
    return directory_ / "locks" / (content_hex(image) + ".json");
}

void BatchLocks::require() const {
    const Mutex mutex(directory_);
    static_cast<void>(mutex.time_of_files());
}

LockAttempt BatchLocks::take(const std::string& image) const {
    const fs::path file = file_of(image);
    const Mutex mutex(directory_);
    std::error_code error;
    fs::create_directory(file.parent_path(), error);
    if (error) throw_errno("make", file.parent_path(), error.value());
    std::optional<ProcessOwner> owner = read_owner(file);
    if (is_held(
            owner, file, [&] { return mutex.time_of_files(); }, times_.dead_after))
        return {.lock = std::nullopt, .holder = owner.value_or(ProcessOwner{.host = "unknown"})};
    if (::unlink(file.c_str()) != 0 && errno != ENOENT) throw_errno("remove", file, errno);
    ProcessOwner self = this_process();
    FileDescriptor created = create(file, to_json(self, image));
    return {.lock = BatchLock(directory_, file, std::move(created), std::move(owner), times_.between_touches),
            .holder = std::move(self)};
}

std::optional<ProcessOwner> BatchLocks::find_holder(const std::string& image) const {
    const fs::path file = file_of(image);
    std::optional<ProcessOwner> owner = read_owner(file);
    const auto here = [] {
        timespec now{};
        ::clock_gettime(CLOCK_REALTIME, &now);
        return now;
    };
    return owner && is_held(owner, file, here, times_.dead_after) ? owner : std::nullopt;
}

void BatchLocks::tidy() const {
    const Mutex mutex(directory_);
    const fs::path locks = directory_ / "locks";
    std::error_code error;
    for (fs::directory_iterator entry(locks, error), end; !error && entry != end; entry.increment(error)) {
        const std::optional<ProcessOwner> owner = read_owner(entry->path());
        if (!is_held(
                owner, entry->path(), [&] { return mutex.time_of_files(); }, times_.dead_after))
            ::unlink(entry->path().c_str());
    }
    // Fails, as it should, if locks are left.
    if (::rmdir(locks.c_str()) != 0 && errno != ENOENT) return;
    ::unlink(mutex.path().c_str());
    ::rmdir(directory_.c_str());
}

}  // namespace etendue
