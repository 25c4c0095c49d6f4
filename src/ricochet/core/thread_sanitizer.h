/// \file
/// Private: happens-before edges that the thread sanitizer cannot see, because the packaged TBB and Embree are built
/// without it. Without the sanitizer every call compiles to nothing.
#pragma once

#ifdef RICOCHET_THREAD_SANITIZER
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace ricochet {

/// One synchronisation point. Aligned, so that two of them never share a word of the sanitizer's shadow memory.
class alignas(16) SyncPoint {
public:
    /// What this thread did so far is visible to every later acquire().
    void release() {
#ifdef RICOCHET_THREAD_SANITIZER
        __tsan_release(this);
#endif
    }
    /// What happened before every earlier release() is visible to this thread.
    void acquire() {
#ifdef RICOCHET_THREAD_SANITIZER
        __tsan_acquire(this);
#endif
    }
};

/// A parallel loop on a library's threads: construct one around the loop and an Iteration in every body. Iterations are
/// not ordered among each other, so a race between two of them is still found.
class LoopSync {
public:
    LoopSync() { start_.release(); }
    ~LoopSync() { end_.acquire(); }
    LoopSync(const LoopSync&) = delete;
    LoopSync& operator=(const LoopSync&) = delete;

    /// Lives while one body runs.
    class Iteration {
    public:
        explicit Iteration(LoopSync& loop) : loop_(loop) { loop_.start_.acquire(); }
        ~Iteration() { loop_.end_.release(); }
        Iteration(const Iteration&) = delete;
        Iteration& operator=(const Iteration&) = delete;

    private:
        LoopSync& loop_;
    };

private:
    SyncPoint start_;
    SyncPoint end_;
};

}  // namespace ricochet
