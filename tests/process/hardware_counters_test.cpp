// What the processor counts, with a kernel that was made up.
#include "process/hardware_counters.h"

#include <cerrno>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/perf_event.h>

namespace etendue::test {

namespace {

/// Counters that stand at zero; the one after `most` cannot be opened, for `error`.
ProcessorCounters::Open that_fails_after(int most, int error) {
    return [opened = 0, most, error](std::uint64_t, int) mutable {
        if (opened++ < most) return open("/dev/zero", O_RDONLY | O_CLOEXEC);
        errno = error;
        return -1;
    };
}

TEST(ProcessorCounters, CountsAllEventsThatTheProcessorHas) {
    const ProcessorCounters all(that_fails_after(1000000, 0));
    EXPECT_EQ(all.unavailable(), "");
    EXPECT_EQ(all.read().size(), 6u);
    const ProcessorCounters some([](std::uint64_t event, int) {
        errno = ENOENT;
        return event == PERF_COUNT_HW_CACHE_MISSES ? -1 : open("/dev/zero", O_RDONLY | O_CLOEXEC);
    });
    EXPECT_EQ(some.unavailable(), "");
    EXPECT_EQ(some.read().size(), 5u);
}

TEST(ProcessorCounters, CountsNothingRatherThanAPart) {
    for (const int error : {EMFILE, ENFILE, ENOMEM, EACCES}) {
        const ProcessorCounters counters(that_fails_after(2, error));
        EXPECT_NE(counters.unavailable(), "") << error;
        EXPECT_TRUE(counters.read().empty()) << error;
    }
    EXPECT_NE(ProcessorCounters(that_fails_after(2, EMFILE)).unavailable().find("Too many open files"),
              std::string::npos);
}

TEST(ProcessorCounters, SaysWhyThereAreNone) {
    const ProcessorCounters counters(that_fails_after(0, ENOENT));
    EXPECT_NE(counters.unavailable().find("virtual machines"), std::string::npos) << counters.unavailable();
}

}  // namespace

}  // namespace etendue::test
