#include "ricochet/simulation/step_control.h"

#include <atomic>
#include <chrono>

#include "ricochet/simulation.h"

namespace ricochet {
namespace {

[[noreturn]] void refuse_after_error() {
    throw RunError(
        "the last step or restore() of this simulation has ended with an error; make it anew or restore a saved state");
}

}  // namespace

void StepControl::require_between_steps() const {
    if (phase_ == Phase::between_steps) return;
    if (phase_ == Phase::broken) refuse_after_error();
    throw RunError("particles, forces and callbacks of a simulation can be changed between its steps only");
}

void StepControl::begin_change() {
    require_between_steps();
    return_point_.invalidate();
}

void StepControl::make(const std::function<void()>& step) {
    if (phase_ != Phase::between_steps) refuse_after_error();
    phase_ = Phase::within_step;
    try {
        step();
    } catch (...) {
        phase_ = Phase::broken;
        throw;
    }
    phase_ = Phase::between_steps;
}

void StepControl::make_stoppable(const std::function<bool()>& goes_on, const std::function<void()>& step) {
    std::atomic<bool> is_stopped = false;
    stop_.set([&] {
        if (is_stopped || (return_point_.is_near() && !goes_on())) {
            is_stopped = true;  // for the other threads, too
            throw StoppedError("the step was stopped before its end");
        }
    });
    const auto start = std::chrono::steady_clock::now();
    try {
        step();
    } catch (...) {
        stop_.set({});
        throw;
    }
    stop_.set({});
    return_point_.add_step(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void StepControl::replace(const std::function<void()>& replacement) {
    phase_ = Phase::broken;
    replacement();
    phase_ = Phase::between_steps;
}

}  // namespace ricochet
