// Starts commands of etendue within milliseconds: each runs in a copy of one process that has loaded OpenImageIO.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace etendue::test {

/// A process that runs commands of etendue in copies of itself; it ends with the process that started it.
class ProgramServer {
  public:
    /// Starts it. Throws std::runtime_error if that is not possible.
    ProgramServer();
    ~ProgramServer();
    ProgramServer(const ProgramServer&) = delete;
    ProgramServer& operator=(const ProgramServer&) = delete;

    /// Starts a command, `words` with the program's name, and this process's environment; returns its process id.
    [[nodiscard]] pid_t start(const std::vector<std::string>& words, const std::filesystem::path& directory,
                              const std::filesystem::path& out, const std::filesystem::path& err) const;
    [[nodiscard]] bool has_ended(pid_t pid) const;
    /// Waits for the end of a command and returns its status, as waitpid gives it.
    [[nodiscard]] int wait(pid_t pid) const;

  private:
    [[nodiscard]] int ask(const std::string& request) const;

    int socket_ = -1;
    pid_t pid_ = -1;
};

/// Returns the server of this process, which the first call starts.
[[nodiscard]] const ProgramServer& program_server();

}  // namespace etendue::test
