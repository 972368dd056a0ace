#include "process/hardware_counters.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace etendue {

namespace {

struct Event {
    std::string_view name;
    std::uint64_t config;  ///< number of the event in PERF_TYPE_HARDWARE
};

constexpr std::array kEvents{
    Event{"cycles", PERF_COUNT_HW_CPU_CYCLES},
    Event{"instructions", PERF_COUNT_HW_INSTRUCTIONS},
    Event{"cache-references", PERF_COUNT_HW_CACHE_REFERENCES},
    Event{"cache-misses", PERF_COUNT_HW_CACHE_MISSES},
    Event{"branches", PERF_COUNT_HW_BRANCH_INSTRUCTIONS},
    Event{"branch-misses", PERF_COUNT_HW_BRANCH_MISSES},
};

/// -1 with errno if the kernel does not allow it.
int open_counter(std::uint64_t config, int thread) {
    perf_event_attr attributes{};
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = config;
    attributes.inherit = 1;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    constexpr int kAnyProcessor = -1;
    constexpr int kNoGroup = -1;
    return static_cast<int>(
        syscall(SYS_perf_event_open, &attributes, thread, kAnyProcessor, kNoGroup, PERF_FLAG_FD_CLOEXEC));
}

std::vector<int> threads_of_process() {
    std::vector<int> threads;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", error))
        threads.push_back(std::stoi(entry.path().filename().string()));
    return threads;
}

bool lacks_event(int error) {
    return error == ENOENT || error == EOPNOTSUPP || error == ENODEV;
}

std::string reason(int error) {
    if (error == EACCES || error == EPERM)
        return "the kernel does not allow hardware counters here (/proc/sys/kernel/perf_event_paranoid)";
    if (lacks_event(error)) return "this machine has no hardware counters, as virtual machines often have none";
    return fmt::format("the kernel gives no hardware counters: {}", std::strerror(error));
}

}  // namespace

ProcessorCounters::ProcessorCounters() : ProcessorCounters(open_counter) {}

ProcessorCounters::ProcessorCounters(const Open& open) {
    int error = 0;
    for (const int thread : threads_of_process())
        for (std::size_t event = 0; event < kEvents.size(); ++event) {
            const int file = open(kEvents[event].config, thread);
            if (file >= 0) {
                counters_.push_back({event, FileDescriptor(file)});
                continue;
            }
            error = errno;
            if (lacks_event(error)) continue;
            // Sums of some threads would look like those of all. One that has ended meanwhile has nothing to count.
            if (error == ESRCH) break;
            counters_.clear();
            unavailable_ = reason(error);
            return;
        }
    if (counters_.empty()) unavailable_ = reason(error);
}

std::vector<ProcessorCounters::Count> ProcessorCounters::read() const {
    std::array<double, kEvents.size()> sums{};
    std::array<bool, kEvents.size()> known{};
    for (const Counter& counter : counters_) {
        struct {
            std::uint64_t value, enabled, running;
        } now{};
        if (::read(counter.file.get(), &now, sizeof now) != static_cast<ssize_t>(sizeof now)) continue;
        known[counter.event] = true;
        if (now.running > 0)
            sums[counter.event] +=
                static_cast<double>(now.value) * static_cast<double>(now.enabled) / static_cast<double>(now.running);
    }
    std::vector<Count> counts;
    for (std::size_t event = 0; event < kEvents.size(); ++event)
        if (known[event]) counts.push_back({std::string(kEvents[event].name), sums[event]});
    return counts;
}

}  // namespace etendue
