#include "ricochet/simulation/step_control.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <span>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

[[noreturn]] void refuse_after_error() {
    throw RunError(
        "the last step or restore() of this simulation has ended with an error; make it anew or restore a saved state");
}

double seconds_from(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Exception that ends the writing of a state that is too large.
struct TooLarge {};

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
            is_stopped = true;  // ends the step in the other threads, too
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
    return_point_.add_step(seconds_from(start));
}

void StepControl::replace(const std::function<void()>& replacement) {
    phase_ = Phase::broken;
    replacement();
    phase_ = Phase::between_steps;
}

void ContactReporter::set(ContactCallback callback) {
    is_replaced_ = is_reporting_;
    callback_ = std::move(callback);
}

void ContactReporter::require_idle() const {
    if (is_reporting_) throw RunError("a contact callback must not step its simulation");
}

void ContactReporter::report(const std::vector<ContactRecord>& records) {
    if (!callback_ || records.empty()) return;
    // Takes the function out of the member, because the function may replace the member while it runs.
    ContactCallback running = take();
    is_reporting_ = true;
    is_replaced_ = false;
    try {
        running(records);
    } catch (...) {
        end(std::move(running));
        throw;
    }
    end(std::move(running));
}

void ContactReporter::end(ContactCallback running) {
    is_reporting_ = false;
    if (!is_replaced_) callback_ = std::move(running);
}

bool ReturnPoint::is_due() const {
    if (!has_tried_) return true;
    if (is_valid_ && steps_ == 0) return false;
    return seconds_from(tried_at_) >= std::max(kShortestInterval, kCostInterval * cost_);
}

void ReturnPoint::keep(const std::function<void(const ByteSink&)>& save, Beside beside) {
    const Clock::time_point start = Clock::now();
    bytes_.clear();
    is_valid_ = true;
    has_tried_ = true;
    try {
        save([this](std::span<const std::byte> part) {
            if (part.size() > kMostBytes - bytes_.size()) throw TooLarge();
            bytes_.insert(bytes_.end(), part.begin(), part.end());
        });
    } catch (const TooLarge&) {
        is_valid_ = false;
        bytes_ = {};
    }
    beside_ = std::move(beside);
    steps_ = 0;
    seconds_ = 0.0;
    cost_ = seconds_from(start);
    tried_at_ = Clock::now();
}

ByteSource ReturnPoint::source() const {
    const auto at = std::make_shared<std::size_t>(0);
    return [this, at](std::span<std::byte> part) {
        if (part.size() > bytes_.size() - *at) throw RunError("the state that was kept ends too early");
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(*at), part.size(), part.begin());
        *at += part.size();
    };
}

}  // namespace ricochet
