/// \file
/// Private to the library: lets the caller of a step end it early.
#pragma once

#include <functional>
#include <utility>

namespace ricochet {

/// Request to end a running step. Long loops poll it at least every few milliseconds.
class StopToken {
public:
    /// Sets the function that poll() calls. Any thread may call the function, also several at once. The function throws
    /// an exception to end the step. An empty function never ends a step. Do not call set() while a step runs.
    void set(std::function<void()> ask) { ask_ = std::move(ask); }
    /// Calls the function and lets its exceptions propagate.
    void poll() const {
        if (ask_) ask_();
    }

private:
    std::function<void()> ask_;
};

}  // namespace ricochet
