/// \file
/// Private: reports happens-before edges to the thread sanitizer. The sanitizer cannot see the synchronisation in the
/// packaged TBB and Embree, because these libraries are built without it. Without the sanitizer every call compiles to
/// nothing.
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
    /// Makes all earlier effects of this thread visible to every later acquire().
    void release() {
#ifdef RICOCHET_THREAD_SANITIZER
        __tsan_release(this);
#endif
    }
    /// Makes all effects before every earlier release() visible to this thread.
    void acquire() {
#ifdef RICOCHET_THREAD_SANITIZER
        __tsan_acquire(this);
#endif
    }
};

/// Parallel loop on a library's threads. Construct a LoopSync around the loop and an Iteration in every body.
/// Iterations are not ordered among each other, so a race between two of them is still found.
class LoopSync {
public:
    LoopSync() { start_.release(); }
    ~LoopSync() { end_.acquire(); }
    LoopSync(const LoopSync&) = delete;
    LoopSync& operator=(const LoopSync&) = delete;

    /// Scope of one body.
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
