/// \file
/// Private: lets the caller of parallel loops end them before their end, without a word of it in the code between.
#pragma once

#include <functional>

namespace ricochet {

/// While it lives, the parallel loops that this thread begins, and the loops within their blocks, call a function
/// before each block, from any of their threads. An exception of the function ends the loop. Several nest: the
/// innermost counts.
class LoopStop {
public:
    explicit LoopStop(std::function<void()> ask);
    ~LoopStop();
    LoopStop(const LoopStop&) = delete;
    LoopStop& operator=(const LoopStop&) = delete;

private:
    std::function<void()> ask_;
    const std::function<void()>* outer_;
};

/// Calls that function, if there is one: for blocks that take long.
void poll_loop_stop();

}  // namespace ricochet
