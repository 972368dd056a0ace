// Which processors lie next to which memory, on machines whose memory is not equally far from all of them (NUMA).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace etendue {

/// Processors, by the numbers that the system gives them.
class ProcessorSet {
  public:
    /// The most processors that Linux can be built for; greater numbers are in no set.
    static constexpr int kMostProcessors = 8192;

    ProcessorSet() = default;

    /// Returns the processors that the calling thread may run on, as taskset, cpusets and batch systems set them; none
    /// where the system does not tell.
    static ProcessorSet of_this_thread();

    void add(int processor);
    [[nodiscard]] bool contains(int processor) const;
    [[nodiscard]] int size() const;
    [[nodiscard]] ProcessorSet common_with(const ProcessorSet& other) const;

    /// Binds the calling thread to these processors. False, and nothing changes, where the system refuses.
    bool bind_this_thread() const;  // NOLINT(modernize-use-nodiscard): a thread that stays free renders the same

    bool operator==(const ProcessorSet&) const = default;

  private:
    std::array<std::uint64_t, kMostProcessors / 64> words_{};  ///< a bit each, as the kernel has them
};

/// Processors of all the sets together, which have none in common.
[[nodiscard]] int size_of_all(std::span<const ProcessorSet> sets);

/// Parts of the machine whose processors share their nearest memory: of each the processors that the calling thread may
/// run on. Parts without such processors are left out. Empty where the system does not tell.
///
/// @param directory one folder `node<N>` for each, with a file `cpulist` of ranges ("0-3,8"), as sysfs has it
[[nodiscard]] std::vector<ProcessorSet> memory_nodes(
    const std::filesystem::path& directory = "/sys/devices/system/node");

}  // namespace etendue
