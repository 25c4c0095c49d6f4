/// \file
/// Handling of Ctrl-C while C++ code runs on many threads.
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

/// Calls work() on a separate thread. Until work() has ended, calls look() repeatedly on the calling thread. The caller
/// must not hold the GIL.
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

/// Lets Ctrl-C end parallel loops. Python handles signals only on its main thread, so only the thread that created the
/// object checks for signals. That thread must hold the GIL when it creates the object.
class CtrlC {
public:
    CtrlC() = default;
    CtrlC(const CtrlC&) = delete;
    CtrlC& operator=(const CtrlC&) = delete;

    /// Calls work() without the GIL and returns its result. Ctrl-C ends the parallel loops of work(); the exception of
    /// Ctrl-C is then rethrown. is_short: work() has a single block. This thread then runs the block and checks for
    /// Ctrl-C meanwhile. Otherwise another thread runs work(), and this thread only checks.
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
        } catch (const Ended&) {  // error_ contains the exception
        }
        if (error_ != nullptr) std::rethrow_exception(error_);
        return std::move(*result);
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kInterval{50};

    /// Exception that ends a parallel loop.
    struct Ended : std::exception {};

    void look() {
        const Locked locked;
        if (PyErr_CheckSignals() == 0) return;
        error_ = std::make_exception_ptr(py::error_already_set());
        is_ended_ = true;
    }
    /// Checks for Ctrl-C inside a parallel loop. Any thread may call this function.
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
