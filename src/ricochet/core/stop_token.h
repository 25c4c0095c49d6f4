/// \file
/// Private to the library: lets the caller of a step end it early.
#pragma once

#include <functional>
#include <utility>

namespace ricochet {

/// Request to end a running step. Long loops poll it after each piece of work of at most a few milliseconds.
class StopToken {
public:
    /// Sets the function that poll() calls, from any thread and from several at once. It throws to end the step. An
    /// empty function never ends a step. Do not call set() while a step runs.
    void set(std::function<void()> ask) { ask_ = std::move(ask); }
    /// Calls the function and lets its exceptions propagate.
    void poll() const {
        if (ask_) ask_();
    }

private:
    std::function<void()> ask_;
};

}  // namespace ricochet
