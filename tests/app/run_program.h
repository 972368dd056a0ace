// Runs the etendue program as a user would.
#pragma once

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

/// Runs `etendue arguments...` in `directory`. `while_running` is called with the process id once the program handles
/// SIGINT, if it gets that far.
[[nodiscard]] ProgramResult run_etendue(const std::vector<std::string>& arguments,
                                        const std::filesystem::path& directory,
                                        const std::function<void(int pid)>& while_running = {});

}  // namespace etendue::test
