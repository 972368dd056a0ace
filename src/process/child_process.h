// A program that runs beside this one: its messages, its progress and its end.
#pragma once

#include "process/file_descriptor.h"
#include "process/line_splitter.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace etendue {

struct ChildOptions {
    /// Names the program; by default it is the file that runs here, even if another has taken its name since.
    std::filesystem::path program = "/proc/self/exe";
    std::string name = "etendue";          ///< name that the child is told to have
    std::vector<std::string> arguments{};  ///< without that name
    /// Bytes that the child may have of memory of its own to write to: the heap, buffers and the stacks of threads. It
    /// is RLIMIT_DATA, since the address space (RLIMIT_AS) also counts what is only reserved or mapped from files,
    /// which for ray tracing is many times more, and Linux heeds no limit of resident memory (RLIMIT_RSS). Asking for
    /// more fails in the child, as if the machine had none.
    std::optional<std::uint64_t> memory_limit{};
    /// Bytes of stdout that are kept; `output_was_cut` tells if there were more.
    std::size_t most_output = std::size_t{1} << 20;
};

/// Says how a child has ended.
struct ChildEnd {
    int exit_code = 0;  ///< if no signal ended it
    int signal = 0;     ///< 0 if it ended by itself
};

/// Returns the name of a signal: "SIGSEGV".
[[nodiscard]] std::string signal_name(int signal);

/// The child reads nothing (/dev/null), and has a process group of its own: Ctrl-C in a terminal reaches only the
/// parent, which passes it on when it wants to. It is killed (SIGKILL) as soon as the thread that started it ends, for
/// whatever reason: nothing that another process takes over goes on to be written. So start it in the main thread.
class ChildProcess {
  public:
    /// Descriptor on which the child may write lines about its progress; those for which there is no room are lost.
    static constexpr int kProgressDescriptor = 3;
    /// How many lines of the messages are kept, and bytes of each.
    static constexpr std::size_t kKeptLines = 20;
    static constexpr std::size_t kLongestLine = 4096;

    using LineCallback = LineSplitter::Callback;

    /// Starts the child. Throws IoError if that is not possible.
    explicit ChildProcess(const ChildOptions& options);
    /// Kills the child if it still runs.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits until the child has written something or ended, a signal arrives here, or `timeout` is over. Calls
    /// `on_message` with each line of stderr, `on_progress` with each line of progress. False once the child has ended
    /// and all that it wrote was handed over.
    bool wait(std::chrono::milliseconds timeout, const LineCallback& on_message, const LineCallback& on_progress);

    /// Waits until one of `children`, none of which has ended, has written something or ended, a signal arrives here,
    /// or `timeout` is over.
    static void wait_for_any(std::span<const ChildProcess* const> children, std::chrono::milliseconds timeout);

    /// Returns the bytes of memory that the child has resident and shares with no file; 0 once it has ended.
    [[nodiscard]] std::uint64_t own_memory_bytes() const;

    /// Sends it a signal, unless it has ended.
    void send(int signal);

    /// Valid once `wait` has returned false.
    [[nodiscard]] const ChildEnd& end() const { return end_; }
    [[nodiscard]] const std::deque<std::string>& last_messages() const { return last_messages_; }
    [[nodiscard]] const std::string& output() const { return output_; }
    [[nodiscard]] bool output_was_cut() const { return output_was_cut_; }

  private:
    struct Stream {
        FileDescriptor pipe;
        LineSplitter lines{kLongestLine};
    };
    void drain(const LineCallback& on_message, const LineCallback& on_progress);
    void reap();

    pid_t pid_ = -1;  ///< -1 once it has ended
    Stream output_stream_;
    Stream messages_;
    Stream progress_;
    ChildEnd end_;
    std::deque<std::string> last_messages_;
    std::size_t most_output_;
    std::string output_;
    bool output_was_cut_ = false;
};

}  // namespace etendue
