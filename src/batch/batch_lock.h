// Which batch process makes which image, where several share an output directory, also from several machines.
//
// OUT/.etendue/locks holds a small JSON file for each image that is being made: who its owner is. Its owner touches it
// every few seconds. Taking and giving up a lock happens while OUT/.etendue/mutex is locked (flock), for a moment: of
// two processes that find the same dead owner, one is first, and the other sees it.
#pragma once

#include "process/file_descriptor.h"
#include "process/process_owner.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace etendue {

struct LockTimes {
    std::chrono::milliseconds between_touches{5000};
    /// An owner on another machine that has not touched its file for this long is taken for dead. Longer than files may
    /// look old to other clients of a network file system: a minute with NFS. So is one whose file says nothing: it may
    /// have just been written elsewhere.
    std::chrono::seconds dead_after{150};
};

/// Holds the right to make one image, for as long as the object lives.
class BatchLock {
  public:
    BatchLock(std::filesystem::path directory, std::filesystem::path file, FileDescriptor descriptor,
              std::optional<ProcessOwner> dead_owner, std::chrono::milliseconds between_touches);
    /// Gives the lock up.
    ~BatchLock();
    BatchLock(BatchLock&&) = default;
    BatchLock& operator=(BatchLock&&) = delete;
    BatchLock(const BatchLock&) = delete;
    BatchLock& operator=(const BatchLock&) = delete;

    /// Keeps the lock: called several times a second, or as often as may be, it touches the file when it is time.
    /// Returns false if the lock is lost: this process stood still for so long that another one has taken it for dead.
    [[nodiscard]] bool keep_alive();

    /// Returns the owner that the lock was taken over from, if that owner died.
    [[nodiscard]] const std::optional<ProcessOwner>& dead_owner() const { return dead_owner_; }

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] bool is_ours() const;

    std::filesystem::path directory_;  ///< OUT/.etendue
    std::filesystem::path file_;
    FileDescriptor descriptor_;
    std::optional<ProcessOwner> dead_owner_;
    std::chrono::milliseconds between_touches_;
    Clock::time_point touched_ = Clock::now();
};

/// Holds what became of the wish for a lock: the lock, or whose it is.
struct LockAttempt {
    std::optional<BatchLock> lock{};
    ProcessOwner holder{};
};

class BatchLocks {
  public:
    /// Gives out the locks of the output directory `output`, which exists.
    explicit BatchLocks(const std::filesystem::path& output, LockTimes times = {});

    /// Throws IoError if no locks can be had there, since nothing can be written or the file system has none.
    void require() const;

    /// Tries to get the lock of `image`, a path below the output directory. Throws IoError.
    [[nodiscard]] LockAttempt take(const std::string& image) const;

    /// Returns the process that makes `image` now, if one does. The call writes nothing and takes no lock, so that this
    /// machine's clock decides whether an owner on another machine is alive.
    [[nodiscard]] std::optional<ProcessOwner> find_holder(const std::string& image) const;

    /// Removes what dead owners left, and the folder if nothing is left in it then. Throws IoError.
    void tidy() const;

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& image) const;

    std::filesystem::path directory_;  ///< OUT/.etendue
    LockTimes times_;
};

}  // namespace etendue
