/// \file
/// Private: lets the caller of parallel loops stop them early, without a parameter in the code between.
#pragma once

#include <functional>

namespace ricochet {

/// Scope in which a function is called before each block of the parallel loops that this thread starts, and of loops
/// within their blocks. Any thread of the loop may call it. An exception of the function ends the loop. Scopes nest:
/// only the innermost function is called.
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

/// Calls the function of the innermost scope, if there is one. For blocks that take long.
void poll_loop_stop();

}  // namespace ricochet
