/// \file
/// Private: what the thread sanitizer cannot see. The packaged libraries are built without it, so it does not know that
/// their loops order memory: what happened before the loop, before what its threads do, before what happens after it.
#pragma once

#ifdef RICOCHET_THREAD_SANITIZER
extern "C" {
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

namespace ricochet {

/// Memory handed from one thread to others by a library's own means. Without the sanitizer every call does nothing.
/// Aligned, so that two of them never share a word of the sanitizer's books.
class alignas(16) HandOver {
public:
    /// What this thread did so far is visible to those who take.
    void give() {
#ifdef RICOCHET_THREAD_SANITIZER
        __tsan_release(this);
#endif
    }
    /// What those did who gave is visible to this thread.
    void take() {
#ifdef RICOCHET_THREAD_SANITIZER
        __tsan_acquire(this);
#endif
    }
};

/// A loop that a library runs on its own threads: the calling thread makes one around the loop, every body a Body. The
/// bodies are not ordered among each other, so that a race between two of them is still found.
class LoopOrder {
public:
    LoopOrder() { start_.give(); }
    ~LoopOrder() { end_.take(); }
    LoopOrder(const LoopOrder&) = delete;
    LoopOrder& operator=(const LoopOrder&) = delete;

    /// Lives while one body runs.
    class Body {
    public:
        explicit Body(LoopOrder& loop) : loop_(loop) { loop_.start_.take(); }
        ~Body() { loop_.end_.give(); }
        Body(const Body&) = delete;
        Body& operator=(const Body&) = delete;

    private:
        LoopOrder& loop_;
    };

private:
    HandOver start_;
    HandOver end_;
};

}  // namespace ricochet
