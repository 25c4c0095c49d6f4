/// \file
/// Ctrl-C while C++ code works on many threads.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "python/gil.h"
#include "ricochet/core/loop_stop.h"

namespace ricochet::python {

/// Calls work() on a thread of its own, and look() on this one again and again until it has ended. Without the lock.
template <class Work, class Look>
void run_beside(const Work& work, std::chrono::milliseconds interval, const Look& look) {
    std::exception_ptr error;
    std::promise<void> done;
    std::future<void> end = done.get_future();
    std::thread thread([&] {
        try {
            const detail::Beside beside;
            work();
        } catch (...) {
            error = std::current_exception();
        }
        done.set_value();
    });
    while (end.wait_for(interval) == std::future_status::timeout) look();
    thread.join();
    if (error != nullptr) std::rethrow_exception(error);
}

/// Lets Ctrl-C end parallel loops. Python handles signals on its main thread alone, so the thread that has made the
/// object looks for them. Made with the lock.
class CtrlC {
public:
    CtrlC() = default;
    CtrlC(const CtrlC&) = delete;
    CtrlC& operator=(const CtrlC&) = delete;

    /// Returns work(), called without the lock. Ctrl-C ends its loops, and its exception comes out. is_short: work has
    /// one block, so that this thread does it all and looks between; else it is done beside this thread, which looks.
    template <class Work>
    auto run(bool is_short, const Work& work) {
        std::optional<decltype(work())> result;
        const auto stoppable = [&] {
            const LoopStop stop([this] { poll(); });
            result.emplace(work());
        };
        try {
            const Unlocked unlocked;
            if (is_short)
                stoppable();
            else
                run_beside(stoppable, kInterval, [this] { look(); });
        } catch (const Ended&) {  // error_ says why
        }
        if (error_ != nullptr) std::rethrow_exception(error_);
        return std::move(*result);
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kInterval{50};

    /// Ends a loop.
    struct Ended : std::exception {};

    void look() {
        const Locked locked;
        if (PyErr_CheckSignals() == 0) return;
        error_ = std::make_exception_ptr(py::error_already_set());
        is_ended_ = true;
    }
    /// From any thread.
    void poll() {
        if (std::this_thread::get_id() == thread_ && Clock::now() >= next_) {
            next_ = Clock::now() + kInterval;
            if (error_ == nullptr) look();
        }
        if (is_ended_) throw Ended();
    }

    std::thread::id thread_ = std::this_thread::get_id();
    Clock::time_point next_ = Clock::now() + kInterval;
    std::exception_ptr error_;
    std::atomic<bool> is_ended_ = false;
};

}  // namespace ricochet::python
