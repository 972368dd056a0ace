// Parallel loops over one task arena, and the floating-point mode that every thread renders in.
#pragma once

#include "core/memory_nodes.h"
#include "core/node_binding.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace etendue {

/// Flushes denormals to zero (FTZ, DAZ) in the calling thread while it lives, as Embree recommends: denormals cost a
/// hundredfold and carry no visible light.
class FlushDenormals {
  public:
    FlushDenormals();
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    unsigned int saved_;
};

/// The threads of one render. Everything parallel, Embree's BVH build included, runs in this one arena, so that no more
/// than `thread_count()` threads ever work at once.
class ThreadPool {
  public:
    /// `thread_count` worker threads, the caller included; 0 for one per processor.
    /// @param nodes the memory nodes of the machine, for `stay_on_node`
    explicit ThreadPool(int thread_count = 0, std::span<const ProcessorSet> nodes = memory_nodes());
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    [[nodiscard]] int thread_count() const;

    /// Runs `body(index, slot)` for every index in [0, count), in any order and on any thread. `slot` lies in
    /// [0, thread_count()) and no two calls share one at the same time, so it can index per-thread scratch memory.
    /// FTZ and DAZ are set around every call. Exceptions leave through the caller once the other calls have ended.
    void parallel_for(std::size_t count, const std::function<void(std::size_t index, int slot)>& body) const;

    /// Keeps the calling thread, in a call of `parallel_for`, on the memory node of its slot while the result lives:
    /// what belongs to a slot and is touched first in it then lies near whoever works there later. It costs three
    /// system calls, and so is for calls that take long. Slots have a node where the machine has several and the pool a
    /// thread for every processor; threads of smaller pools go where the system sends them, since processes that share
    /// a machine would else choose the same nodes.
    [[nodiscard]] NodeBinding::Stay stay_on_node(int slot) const;

    /// Runs `body` inside the arena: libraries that use TBB themselves (Embree's build) then use its threads only.
    void execute(const std::function<void()>& body) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Version of the threading library.
[[nodiscard]] std::string parallel_library_version();

}  // namespace etendue
