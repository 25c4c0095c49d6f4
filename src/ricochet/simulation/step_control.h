/// \file
/// Private to the simulation: the phases of a run, and steps that their caller can stop. The file also has the state to
/// which a stopped step goes back, and the report of contact records to the user's function.
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

/// A state that is saved now and then. After going back, the steps since then are repeated with the same bits. So the
/// wall-clock time decides when a state is saved, and never the results.
class ReturnPoint {
public:
    /// Parts of the simulation outside a saved state.
    struct Beside {
        std::vector<Emitter> emitters;
        std::vector<Violation> violations;
    };

    /// Returns true if saving the state now costs a small part of the time since it was last saved.
    [[nodiscard]] bool is_due() const;
    /// Saves the bytes that `save` writes. A state of more than kMostBytes is not kept.
    void keep(const std::function<void(const ByteSink&)>& save, Beside beside);
    /// Marks the state as changed by more than the steps that add_step() counts.
    void invalidate() { is_valid_ = false; }
    /// Counts a step since the state was saved.
    void add_step(double seconds) { ++steps_, seconds_ += seconds; }

    /// Returns true if going back takes a fraction of a second.
    [[nodiscard]] bool is_near() const { return is_valid_ && seconds_ <= kLongestReplay; }
    /// Returns the number of steps since the state was saved.
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    /// Returns the bytes of the state, from their start.
    [[nodiscard]] ByteSource source() const;
    [[nodiscard]] const Beside& beside() const { return beside_; }

private:
    using Clock = std::chrono::steady_clock;

    /// Most bytes of a saved state: some hundred thousand particles. More would count in estimates of memory.
    static constexpr std::size_t kMostBytes = std::size_t{1} << 24U;
    // Local, because only the cost depends on it.
    static constexpr double kShortestInterval = 0.25;  // s between two states
    static constexpr double kCostInterval = 50.0;      // multiple of the time to save one
    static constexpr double kLongestReplay = 0.5;      // s

    std::vector<std::byte> bytes_;
    Beside beside_;
    bool is_valid_ = false;
    bool has_tried_ = false;
    Clock::time_point tried_at_;
    double cost_ = 0.0;        // s, to save the last state
    std::uint64_t steps_ = 0;  // since then
    double seconds_ = 0.0;     // s, that they took
};

/// Knows whether a run is within a step. After an error in a step the run is broken, because particles in free flight
/// may then be a step ahead of the others.
class StepControl {
public:
    /// Returns the token that loops within a step poll.
    [[nodiscard]] const StopToken& stop() const { return stop_; }
    /// Returns the state to which a stopped step goes back.
    [[nodiscard]] ReturnPoint& return_point() { return return_point_; }
    /// Returns false within a step, and in a broken run.
    [[nodiscard]] bool is_between_steps() const { return phase_ == Phase::between_steps; }
    /// Throws RunError unless the run is between two steps.
    void require_between_steps() const;
    /// Also forgets the return point, because the state changes by more than steps.
    void begin_change();

    /// Makes a step. Throws RunError in a broken run.
    void make(const std::function<void()>& step);
    /// Makes a step, and ends it with a StoppedError when goes_on returns false.
    void make_stoppable(const std::function<bool()>& goes_on, const std::function<void()>& step);
    /// Replaces the state. The run is broken until that has ended without an error.
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
    /// Sets the function; an empty one ends the calls.
    void set(ContactCallback callback);
    [[nodiscard]] bool is_set() const { return static_cast<bool>(callback_); }
    /// Returns the function, and calls none until the next set().
    [[nodiscard]] ContactCallback take() { return std::exchange(callback_, {}); }
    /// Throws RunError if the function runs.
    void require_idle() const;
    /// Calls the function if there are records. Its exceptions leave report().
    void report(const std::vector<ContactRecord>& records);

private:
    void end(ContactCallback running);

    ContactCallback callback_;
    bool is_reporting_ = false;  // the function runs
    bool is_replaced_ = false;   // the running function has called set()
};

}  // namespace ricochet
