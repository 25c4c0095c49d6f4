/// \file
/// Private to the simulation: the phases of a run, and steps that their caller can stop.
#pragma once

#include <functional>

#include "ricochet/core/stop_token.h"
#include "ricochet/simulation/return_point.h"

namespace ricochet {

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

}  // namespace ricochet
