/// \file
/// Private to the simulation: the phases of a run, and steps that the caller can stop. Also contains the saved state
/// that a stopped step restores, and the report of contact records to the user's function.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "ricochet/core/byte_stream.h"
#include "ricochet/core/stop_token.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// A state of the run that is saved from time to time. After this state is restored, the steps since the save are
/// repeated, with bitwise the same results. The wall-clock time therefore decides when a state is saved, but does not
/// affect results.
class ReturnPoint {
public:
    /// Parts of the simulation that a saved state does not contain.
    struct Beside {
        std::vector<Emitter> emitters;
        std::vector<Violation> violations;
    };

    /// Returns true if saving the state now costs only a small part of the time since the last save.
    [[nodiscard]] bool is_due() const;
    /// Stores the bytes that `save` writes. Does not store a state of more than kMostBytes.
    void keep(const std::function<void(const ByteSink&)>& save, Beside beside);
    /// Makes the saved state unusable. Must be called if a change other than the steps in add_step() affects the run.
    void invalidate() { is_valid_ = false; }
    /// Counts a step since the state was saved. seconds: wall-clock time of the step.
    void add_step(double seconds) { ++steps_, seconds_ += seconds; }

    /// Returns true if the steps since the save can be repeated in a fraction of a second.
    [[nodiscard]] bool is_near() const { return is_valid_ && seconds_ <= kLongestReplay; }
    /// Returns the number of steps since the state was saved.
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    /// Returns a source that reads the bytes of the state from the start.
    [[nodiscard]] ByteSource source() const;
    [[nodiscard]] const Beside& beside() const { return beside_; }

private:
    using Clock = std::chrono::steady_clock;

    /// Largest size of a saved state, in bytes, some hundred thousand particles. More would count as memory.
    static constexpr std::size_t kMostBytes = std::size_t{1} << 24U;
    // Local, because only the cost depends on it.
    static constexpr double kShortestInterval = 0.25;  // s, between two saves
    static constexpr double kCostInterval = 50.0;      // interval, as a multiple of the duration of a save
    static constexpr double kLongestReplay = 0.5;      // s

    std::vector<std::byte> bytes_;
    Beside beside_;
    bool is_valid_ = false;
    bool has_tried_ = false;
    Clock::time_point tried_at_;
    double cost_ = 0.0;        // s, duration of the last save
    std::uint64_t steps_ = 0;  // number of steps since the last save
    double seconds_ = 0.0;     // s, duration of these steps
};

/// Phase of a run: between two steps, within a step, or broken. An error in a step breaks the run, because particles in
/// free flight may be one step ahead of the others.
class StepControl {
public:
    /// Returns the stop token, which loops within a step must poll.
    [[nodiscard]] const StopToken& stop() const { return stop_; }
    /// Returns the saved state that a stopped step restores.
    [[nodiscard]] ReturnPoint& return_point() { return return_point_; }
    /// Returns false within a step, and in a broken run.
    [[nodiscard]] bool is_between_steps() const { return phase_ == Phase::between_steps; }
    /// Throws RunError unless the run is between two steps.
    void require_between_steps() const;
    /// Begins a change by the user, which invalidates the return point. Throws like require_between_steps().
    void begin_change();

    /// Makes a step. Throws RunError in a broken run.
    void make(const std::function<void()>& step);
    /// Makes a step, and ends it with a StoppedError when goes_on returns false.
    void make_stoppable(const std::function<bool()>& goes_on, const std::function<void()>& step);
    /// Calls a function that replaces the state. The run is broken until the function has returned without an error.
    void replace(const std::function<void()>& replacement);

private:
    enum class Phase { between_steps, within_step, broken };

    Phase phase_ = Phase::between_steps;
    StopToken stop_;
    ReturnPoint return_point_;
};

/// Calls the function of Simulation::on_contact(). The function can replace itself while it runs.
class ContactReporter {
public:
    /// Sets the function. An empty function ends the calls.
    void set(ContactCallback callback);
    [[nodiscard]] bool is_set() const { return static_cast<bool>(callback_); }
    /// Returns the function and removes it. No function is called until the next set().
    [[nodiscard]] ContactCallback take() { return std::exchange(callback_, {}); }
    /// Throws RunError if the function is running.
    void require_idle() const;
    /// Calls the function if there are records. Does not catch exceptions of the function.
    void report(const std::vector<ContactRecord>& records);

private:
    void end(ContactCallback running);

    ContactCallback callback_;
    bool is_reporting_ = false;  // true while the function runs
    bool is_replaced_ = false;   // true if the running function has called set()
};

}  // namespace ricochet
