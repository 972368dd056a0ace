#include "core/parallel.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>
#include <xmmintrin.h>

#ifdef __SANITIZE_THREAD__
// ThreadSanitizer's interface.
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace etendue {

namespace {
constexpr unsigned int kFlushToZero = 0x8000;
constexpr unsigned int kDenormalsAreZero = 0x0040;

/// Tells ThreadSanitizer of an order that it cannot see, since TBB is not instrumented: what happened before `leave` in
/// one thread happens before what follows `enter` in another.
class Handover {
  public:
#ifdef __SANITIZE_THREAD__
    void leave() {
        __tsan_release(this);
    }
    void enter() {
        __tsan_acquire(this);
    }

  private:
    char address_ = 0;
#else
    void leave() {}
    void enter() {}
#endif
};
}  // namespace

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
}

FlushDenormals::~FlushDenormals() {
    _mm_setcsr(saved_);
}

struct ThreadPool::Impl {
    Impl(int thread_count, std::span<const ProcessorSet> nodes) : arena(thread_count) {
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
    Handover begin;
    Handover end;
    std::vector<Handover> slots(static_cast<std::size_t>(thread_count()));
    begin.leave();
    impl_->arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                const FlushDenormals flush_denormals;
                const int slot = tbb::this_task_arena::current_thread_index();
                Handover& of_slot = slots[static_cast<std::size_t>(slot)];
                begin.enter();
                of_slot.enter();
                for (std::size_t index = range.begin(); index != range.end(); ++index) body(index, slot);
                of_slot.leave();
                end.leave();
            },
            tbb::simple_partitioner());
    });
    end.enter();
}

void ThreadPool::execute(const std::function<void()>& body) const {
    Handover begin;
    Handover end;
    begin.leave();
    impl_->arena.execute([&] {
        const FlushDenormals flush_denormals;
        begin.enter();
        body();
        end.leave();
    });
    end.enter();
}

NodeBinding::Stay ThreadPool::stay_on_node(int slot) const {
    return {impl_->binding, slot};
}

std::string parallel_library_version() {
    return TBB_runtime_version();
}

}  // namespace etendue
