/// \file
/// Private: lets a caller stop parallel loops early, without a parameter of the functions between the caller and the
/// loop.
#pragma once

#include <functional>

namespace ricochet {

/// Scope in which parallel loops call a function before each of their blocks. It applies to loops that this thread
/// starts, and to loops within their blocks. Any thread of the loop may call the function. If the function throws, the
/// loop ends. Scopes nest: only the innermost function is called.
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

/// Calls the function of the innermost scope, if there is one. Blocks that take long call it repeatedly.
void poll_loop_stop();

}  // namespace ricochet
