#include "core/process_time.h"

#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace etendue {

double process_cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double thread_cpu_seconds() {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

double seconds_since_process_start() {
    // proc(5): field 22 of stat is the start in ticks since the system began; the name before may hold anything.
    std::ifstream file("/proc/self/stat");
    std::string stat;
    std::getline(file, stat);
    const std::size_t end_of_name = stat.rfind(')');
    timespec now{};
    if (end_of_name == std::string::npos || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0.0;
    constexpr int kFieldsBetween = 19;
    std::istringstream fields(stat.substr(end_of_name + 1));
    std::string skipped;
    for (int i = 0; i < kFieldsBetween; ++i) fields >> skipped;
    double ticks = 0.0;
    if (!(fields >> ticks)) return 0.0;
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
           ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace etendue
