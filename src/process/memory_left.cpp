#include "process/memory_left.h"

#include "core/byte_size.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// Returns the number behind `key` in a file of lines such as "MemAvailable:  1024 kB"; none if there is no such line.
std::optional<std::uint64_t> number_behind(const std::string& key, const fs::path& file) {
    std::ifstream in(file);
    for (std::string word; in >> word;) {
        if (word != key) continue;
        std::uint64_t number = 0;
        if (in >> number) return number;
        return std::nullopt;
    }
    return std::nullopt;
}

/// Returns the number that a file holds; none if it is missing, or says "max".
std::optional<std::uint64_t> number_in(const fs::path& file) {
    std::ifstream in(file);
    std::uint64_t number = 0;
    if (in >> number) return number;
    return std::nullopt;
}

/// Returns the path of this process's control group, below the root of all.
fs::path own_group(const fs::path& proc) {
    std::ifstream in(proc / "self/cgroup");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("0::/")) return fs::path(line.substr(4)).lexically_normal();
    return {};
}

}  // namespace

std::uint64_t free_memory_bytes(const fs::path& proc, const fs::path& groups) {
    constexpr std::uint64_t kKibibyte = 1024;
    const std::optional<std::uint64_t> available = number_behind("MemAvailable:", proc / "meminfo");
    std::uint64_t free = available ? *available * kKibibyte : physical_memory();
    // A group has no more than those that it is in.
    for (fs::path group = own_group(proc);; group = group.parent_path()) {
        const fs::path files = groups / group;
        const auto most = number_in(files / "memory.max");
        const auto used = number_in(files / "memory.current");
        if (most && used) {
            const std::uint64_t cached = number_behind("inactive_file", files / "memory.stat").value_or(0);
            const std::uint64_t taken = *used - std::min(*used, cached);
            free = std::min(free, *most - std::min(*most, taken));
        }
        if (group.empty()) return free;
    }
}

std::uint64_t process_memory_bytes(pid_t process) {
    std::ifstream in(fmt::format("/proc/{}/statm", process));
    std::uint64_t size = 0;
    std::uint64_t resident = 0;
    std::uint64_t shared = 0;
    if (!(in >> size >> resident >> shared)) return 0;
    return (resident - std::min(resident, shared)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace etendue
