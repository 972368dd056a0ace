#include "process/process_owner.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

namespace {

std::string host_name() {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
    return name.data();
}

std::string machine_id() {
    std::string boot;
    std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
    std::error_code ignored;
    return fmt::format("{} {}", boot, std::filesystem::read_symlink("/proc/self/ns/pid", ignored).string());
}

/// Returns the line of /proc/PID/stat; none if the process does not exist, or if /proc hides it from this user.
std::optional<std::string> stat_of(std::int64_t pid) {
    std::ifstream file(fmt::format("/proc/{}/stat", pid));
    std::string text;
    if (!std::getline(file, text)) return std::nullopt;
    return text;
}

/// Returns when a process started, in clock ticks since the system started, from `text`, its line of /proc/PID/stat;
/// none if the process is a zombie: it has ended, and its parent has not waited for it yet.
std::optional<std::uint64_t> start_time_in(const std::string& text) {
    // The name in parentheses, which may hold anything, is the second field; the state is the third, the start the
    // 22nd.
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string state;
    fields >> state;
    if (state == "Z" || state == "X") return std::nullopt;
    std::string skipped;
    for (int field = 4; field < 22; ++field) fields >> skipped;
    std::uint64_t start = 0;
    if (!(fields >> start)) return std::nullopt;
    return start;
}

}  // namespace

std::string ProcessOwner::str() const {
    return fmt::format("{}:{}", host, pid);
}

ProcessOwner this_process() {
    const std::int64_t pid = ::getpid();
    const std::optional<std::string> stat = stat_of(pid);
    return {host_name(), machine_id(), pid, stat ? start_time_in(*stat).value_or(0) : 0};
}

Liveness liveness(const ProcessOwner& owner) {
    if (owner.machine != machine_id()) return Liveness::Unknown;
    if (const std::optional<std::string> stat = stat_of(owner.pid))
        return start_time_in(*stat) == owner.start_time ? Liveness::Alive : Liveness::Dead;
    // /proc may hide the processes of other users (hidepid).
    return ::kill(static_cast<pid_t>(owner.pid), 0) != 0 && errno == ESRCH ? Liveness::Dead : Liveness::Unknown;
}

}  // namespace etendue
