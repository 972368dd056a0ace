#include "core/parallel.h"

#include "core/error.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>
#include <xmmintrin.h>

namespace etendue {

namespace {
constexpr unsigned int kFlushToZero = 0x8000;
constexpr unsigned int kDenormalsAreZero = 0x0040;

using Body = std::function<void(std::size_t index, int slot)>;

#ifdef __SANITIZE_THREAD__
/// Runs `body` on plain threads. TBB is not instrumented: ThreadSanitizer does not see the order that it keeps between
/// threads, and would report a race for all that it hands over.
void run_tasks(tbb::task_arena& arena, std::size_t count, const Body& body) {
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&](int slot) {
        const FlushDenormals flush_denormals;
        try {
            for (std::size_t index = next++; index < count; index = next++) body(index, slot);
        } catch (...) {
            next = count;
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        for (int slot = 1; slot < arena.max_concurrency(); ++slot) others.emplace_back(work, slot);
        work(0);
    }
    if (failure) std::rethrow_exception(failure);
}
#else
void run_tasks(tbb::task_arena& arena, std::size_t count, const Body& body) {
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                const FlushDenormals flush_denormals;
                const int slot = tbb::this_task_arena::current_thread_index();
                for (std::size_t index = range.begin(); index != range.end(); ++index) body(index, slot);
            },
            tbb::simple_partitioner());
    });
}
#endif

}  // namespace

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
}

FlushDenormals::~FlushDenormals() {
    _mm_setcsr(saved_);
}

namespace {

/// Throws IoError unless `pool_threads`, and some threads of libraries, can run at once beside the caller. TBB and
/// OpenEXR start threads when there is work, and end the process if they get none.
void require_threads(int pool_threads) {
    if (pool_threads == 0) return;
    constexpr int kLibraryThreads = 4;
    const int count = pool_threads + kLibraryThreads;
    std::mutex mutex;
    std::vector<std::jthread> threads;
    const std::lock_guard until_all_are_asked_for(mutex);
    try {
        for (int i = 0; i < count; ++i) threads.emplace_back([&mutex] { const std::lock_guard wait(mutex); });
    } catch (const std::system_error& error) {
        throw IoError(fmt::format(
            "only {} of {} threads can be started, {} of them for libraries: {}; ask for fewer (--threads), or "
            "raise the limit (ulimit -u)",
            threads.size() + 1, count + 1, kLibraryThreads, error.code().message()));
    }
}

}  // namespace

struct ThreadPool::Impl {
    Impl(int thread_count, std::span<const ProcessorSet> nodes) : arena(thread_count) {
        require_threads(thread_count - 1);
        // TBB keeps one worker per processor; more are allowed when asked for, so that determinism can be tested on a
        // small machine. Fewer are the arena's business: a global limit would hold for other pools too.
        if (thread_count > tbb::info::default_concurrency())
            limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(thread_count));
        if (nodes.size() > 1 && thread_count >= size_of_all(nodes)) binding = NodeBinding(thread_count, nodes);
    }

    std::optional<tbb::global_control> limit;
    tbb::task_arena arena;
    NodeBinding binding;
};

ThreadPool::ThreadPool(int thread_count, std::span<const ProcessorSet> nodes)
    : impl_(std::make_unique<Impl>(thread_count > 0 ? thread_count : std::max(1, tbb::info::default_concurrency()),
                                   nodes)) {}

ThreadPool::~ThreadPool() = default;

int ThreadPool::thread_count() const {
    return impl_->arena.max_concurrency();
}

void ThreadPool::parallel_for(std::size_t count, const std::function<void(std::size_t, int)>& body) const {
    run_tasks(impl_->arena, count, body);
}

void ThreadPool::execute(const std::function<void()>& body) const {
    impl_->arena.execute([&] {
        const FlushDenormals flush_denormals;
        body();
    });
}

NodeBinding::Stay ThreadPool::stay_on_node(int slot) const {
    return {impl_->binding, slot};
}

std::string parallel_library_version() {
    return TBB_runtime_version();
}

}  // namespace etendue
