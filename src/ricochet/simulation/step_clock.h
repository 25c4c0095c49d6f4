/// \file
/// Private to the simulation: the times at which a run's steps begin and end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ricochet {

/// An interval of simulation time, s.
struct TimeSpan {
    double begin = 0.0;
    double end = 0.0;
};

/// Equal steps from 0 to the end of the run; the last one is cut there.
class StepClock {
public:
    /// time_step > 0, duration >= 0, both finite, s.
    StepClock(double time_step, double duration)
        : time_step_(time_step),
          duration_(duration),
          steps_(static_cast<std::uint64_t>(std::max(0.0, std::ceil(duration / time_step - kStepRounding)))) {}

    /// Steps of the whole run.
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    /// s at which a step begins; that of steps() and all beyond is the end of the run.
    [[nodiscard]] double time_at(std::uint64_t step) const {
        return step >= steps_ ? duration_ : static_cast<double>(step) * time_step_;
    }
    [[nodiscard]] TimeSpan span_of(std::uint64_t step) const { return {time_at(step), time_at(step + 1)}; }
    /// True when the last step is exactly as long as the others.
    [[nodiscard]] bool last_is_whole() const { return duration_ == static_cast<double>(steps_) * time_step_; }
    /// The last step, up to `most`, that begins before `until`, or 0: a step of time_step s may begin there, so not a
    /// last one that is shorter.
    [[nodiscard]] std::uint64_t last_step_before(double until, std::uint64_t most) const {
        most = std::min(most, last_is_whole() ? steps_ : steps_ - 1);
        auto step = static_cast<std::uint64_t>(std::min(until / time_step_, static_cast<double>(most)));
        while (step > 0 && time_at(step) >= until) --step;
        return step;
    }

private:
    /// A final step shorter than this fraction of a step is not made: duration / time_step is meant to be whole.
    static constexpr double kStepRounding = 1e-6;

    double time_step_;
    double duration_;
    std::uint64_t steps_;
};

}  // namespace ricochet
