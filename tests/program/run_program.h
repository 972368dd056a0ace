// Runs the etendue program as a user would.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue::test {

struct ProgramResult {
    int exit_code = -1;  ///< 1000 + signal if a signal ended it
    std::string out;
    std::string err;
};

enum class Start {
    /// The command runs in a copy of a process that has loaded OpenImageIO, and so starts within milliseconds. Under
    /// sanitizers it is executed: they look for leaks at a program's end and know no threads of copies.
    Copied,
    Executed  ///< the program's file is executed: for tests of how it starts
};

/// `etendue arguments...` while it runs in `directory`.
class RunningProgram {
  public:
    RunningProgram(const std::vector<std::string>& arguments, const std::filesystem::path& directory,
                   Start start = Start::Copied);
    /// Kills it if it still runs.
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    [[nodiscard]] int pid() const { return pid_; }
    /// Sends it a signal, unless it was waited for.
    void send(int signal) const;
    /// True once it has ended, and stays there for `wait`.
    [[nodiscard]] bool has_ended() const;
    /// Returns what the program has written to stderr so far.
    [[nodiscard]] std::string messages() const;
    /// Waits for its end; once.
    [[nodiscard]] ProgramResult wait();

  private:
    std::filesystem::path out_;
    std::filesystem::path err_;
    Start start_;
    int pid_ = -1;
};

/// The file whose code runs in commands that are copied.
[[nodiscard]] std::filesystem::path program_file();

/// True while the process catches SIGINT: from the time it is ready to, until the first has arrived.
[[nodiscard]] bool handles_interrupt(int pid);

/// Process ids of the children of the process `pid`.
[[nodiscard]] std::vector<int> children_of(int pid);

/// The words that the process `pid` was started with, each ended by a zero.
[[nodiscard]] std::string command_of(int pid);

/// Waits for at most a minute until `is_true`, which is asked once in every `interval`; says whether it became so.
[[nodiscard]] bool wait_until(const std::function<bool()>& is_true,
                              std::chrono::microseconds interval = std::chrono::milliseconds(10));

/// Runs `etendue arguments...` in `directory`. `while_running` is called with the process id once the program handles
/// SIGINT, if it gets that far.
[[nodiscard]] ProgramResult run_etendue(const std::vector<std::string>& arguments,
                                        const std::filesystem::path& directory,
                                        const std::function<void(int pid)>& while_running = {},
                                        Start start = Start::Copied);

}  // namespace etendue::test
