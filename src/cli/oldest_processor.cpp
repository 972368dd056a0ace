// Compiled for every x86-64 processor, and run before whatever else of the program is: says so where the processor
// lacks what all the rest is compiled for, which would end in an illegal instruction.
#include <cstddef>
#include <string_view>

#include <unistd.h>

namespace {

[[gnu::constructor(101)]] void require_oldest_processor() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("sse4.2") != 0 && __builtin_cpu_supports("ssse3") != 0 &&
        __builtin_cpu_supports("popcnt") != 0)
        return;
    constexpr std::string_view kMessage =
        "error: Etendue needs a processor of the level x86-64-v2, with SSE4.2 and POPCNT, which this one is not\n";
    // Nothing can be done about a standard error that takes nothing.
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
    ::_exit(1);
}

}  // namespace
