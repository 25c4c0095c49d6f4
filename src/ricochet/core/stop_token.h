/// \file
/// Private to the library: lets the caller of a step end it before its end.
#pragma once

#include <functional>
#include <utility>

namespace ricochet {

/// A request to end a step that runs. Long loops poll it between pieces of work of at most some milliseconds.
class StopToken {
public:
    /// ask: called by poll() from any thread, by several at a time; throws when the step is to end. An empty function
    /// ends nothing. Not while a step runs.
    void set(std::function<void()> ask) { ask_ = std::move(ask); }
    /// Calls the function, and lets its exceptions pass.
    void poll() const {
        if (ask_) ask_();
    }

private:
    std::function<void()> ask_;
};

}  // namespace ricochet
