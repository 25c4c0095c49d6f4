/// \file
/// Private to the simulation: the particles that need a query in a step, and the forecasts of their next queries.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/collision/clear_space.h"
#include "ricochet/collision/contact.h"
#include "ricochet/core/algorithms.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

/// An interval of simulation time, s.
struct TimeSpan {
    double begin = 0.0;
    double end = 0.0;
};

/// Clock with equal steps from 0 to the end of the run, except a last step that ends there (kStepRounding).
class StepClock {
public:
    /// time_step > 0, duration >= 0, both finite, in s.
    StepClock(double time_step, double duration)
        : time_step_(time_step),
          duration_(duration),
          steps_(static_cast<std::uint64_t>(
              std::max(duration > 0.0 ? 1.0 : 0.0, std::ceil(duration / time_step - kStepRounding)))) {}

    /// Returns the number of steps of the whole run.
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    /// Returns the time, in s, at which a step begins; the end of the run for steps() and larger numbers.
    [[nodiscard]] double time_at(std::uint64_t step) const {
        return step >= steps_ ? duration_ : static_cast<double>(step) * time_step_;
    }
    [[nodiscard]] TimeSpan span_of(std::uint64_t step) const { return {time_at(step), time_at(step + 1)}; }
    /// Returns true if the last step is exactly as long as the other steps.
    [[nodiscard]] bool last_is_whole() const { return duration_ == static_cast<double>(steps_) * time_step_; }
    /// Returns the last step that begins before `until`, in s. The result is at most `most`, and 0 if there is no such
    /// step. A step of time_step seconds must be able to begin there, so a shorter last step does not count.
    [[nodiscard]] std::uint64_t last_step_before(double until, std::uint64_t most) const {
        most = std::min(most, last_is_whole() ? steps_ : steps_ - 1);
        auto step = static_cast<std::uint64_t>(std::min(until / time_step_, static_cast<double>(most)));
        while (step > 0 && time_at(step) >= until) --step;
        return step;
    }

private:
    double time_step_;
    double duration_;
    std::uint64_t steps_;
};

/// Forecast by the look-ahead in a particle's last query. It applies if the particle is in flight.
struct FreeFlightForecast {
    double free_until = 0.0;            ///< s, the particle certainly hits nothing before; not known if in the past
    double candidates_until = 0.0;      ///< s, only the candidates come near the particle's path before
    ClearSpace clear = {};              ///< free space around the particle, if it is known
    ContactCandidates candidates = {};  ///< valid only if candidates_until is in the future
};

/// State of every particle, in four bytes per particle, and the candidates of its next query. A particle is:
/// - in free flight: it certainly hits nothing, so it is not queried.
/// - left alone: it is pinned, frozen, asleep or about to be removed, so it is not queried.
/// - active: it is queried. It may be in contact if its state is unknown.
/// A scan over the states finds the active set of a step in a fraction of the time of the moves. The schedule affects
/// only the speed of a run. If the state of every particle were unknown, results would be bitwise the same.
class QuerySchedule {
public:
    /// clock must outlive the object. keeps_clear_spaces: clear() returns spaces, which uniform forces do not need.
    explicit QuerySchedule(const StepClock& clock, bool keeps_clear_spaces = false)
        : clock_(clock), keeps_clear_spaces_(keeps_clear_spaces) {}

    /// Begins a step. The functions below then return the states of particles in this step.
    void begin_step(std::uint64_t step);

    [[nodiscard]] bool is_left_alone(std::size_t i) const { return next_[i] == kLeftAlone; }
    [[nodiscard]] bool is_in_free_flight(std::size_t i) const { return is_free(next_[i], now_); }
    /// Returns true if the arrays contain no contact of particle i, and need not be read.
    [[nodiscard]] bool is_without_contact(std::size_t i) const {
        return next_[i] != kLeftAlone && next_[i] != kUnknown;
    }
    /// Returns the triangles that come near the path in the next query, if they are known.
    [[nodiscard]] const ContactCandidates& candidates(std::size_t i) const { return candidates_[i]; }
    /// Returns the free space that an earlier query has found around the particle; reach 0 if none is known.
    [[nodiscard]] const ClearSpace& clear(std::size_t i) const {
        static constexpr ClearSpace kNone{};
        return keeps_clear_spaces_ ? clear_[i] : kNone;
    }
    [[nodiscard]] bool keeps_clear_spaces() const { return keeps_clear_spaces_; }

    /// Returns the number of particles of [begin, end) that need a query.
    [[nodiscard]] std::size_t count_active(std::size_t begin, std::size_t end) const {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += is_active(next_[i], now_) ? 1 : 0;
        return count;
    }
    /// Returns the number of particles of [begin, end) that are left alone.
    [[nodiscard]] std::size_t count_left_alone(std::size_t begin, std::size_t end) const {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += is_left_alone(i) ? 1 : 0;
        return count;
    }
    /// Returns true if an interval is the whole present step, and not a substep.
    [[nodiscard]] bool is_whole_step(const TimeSpan& span) const {
        return span.begin == clock_.time_at(step_) && span.end == clock_.time_at(step_ + 1);
    }
    /// Returns true for an active particle without contact around which free space is known.
    [[nodiscard]] bool may_fly_clear(std::size_t i) const {
        return now_ < kLeftAlone - 1 && is_active(next_[i], now_) && next_[i] != kUnknown && clear_[i].reach > 0.0;
    }
    /// Calls visit(i) for the particles of [begin, end) that need a query, in ascending order.
    template <class Visit>
    void visit_active(std::size_t begin, std::size_t end, const Visit& visit) const {
        const std::uint32_t* next = next_.data();
        for_each_if(
            begin, end, [next, now = now_](std::size_t i) { return is_active(next[i], now); }, visit);
    }
    /// Calls visit(i) for the particles of [begin, end) that are not in free flight, in ascending order.
    template <class Visit>
    void visit_all_but_free_flights(std::size_t begin, std::size_t end, const Visit& visit) const {
        const std::uint32_t* next = next_.data();
        for_each_if(
            begin, end, [next, now = now_](std::size_t i) { return !is_free(next[i], now); }, visit);
    }

    /// These functions set a particle's state after its move, on any thread for different particles.
    void leave_alone(std::size_t i) { set(i, kLeftAlone, {}, {}); }
    void forget(std::size_t i, const ClearSpace& clear = {}) { set(i, kUnknown, {}, clear); }
    void set_flying(std::size_t i, const FreeFlightForecast& forecast);
    /// Puts a particle that may fly clear in free flight in this step alone. Keeps its free space.
    void fly_this_step(std::size_t i) { next_[i] = now_ + 1; }

    /// Adds a particle that is unknown or left alone.
    void append(bool is_left_alone);
    void reserve(std::size_t more);
    /// Keeps the particles whose flag is not 0.
    void compact(const std::vector<std::uint8_t>& keep);
    /// Index that marks a new particle in rearrange().
    static constexpr std::size_t kNew = std::numeric_limits<std::size_t>::max();
    /// Rearranges the particles. Particle i had the index from[i] before, or is a new particle of unknown state.
    void rearrange(const std::vector<std::size_t>& from);
    /// Restarts with `count` particles of unknown state. keeps_clear_spaces: clear() returns known free spaces.
    void reset(std::size_t count, bool keeps_clear_spaces);

    /// Prefetches the data of a particle.
    void prefetch(std::size_t i) const {
        __builtin_prefetch(&next_[i], 1);
        __builtin_prefetch(&candidates_[i], 1);
        if (keeps_clear_spaces_) __builtin_prefetch(&clear_[i], 1);
    }

private:
    // Each particle has a number: one more than the step of its next query, or one of two marks, the smallest and the
    // largest number. A particle is active if its number is at most the number of the present step. It is in free
    // flight if its number is still larger after 1 is added to both numbers. The addition turns the largest number
    // into 0, so that one comparison also excludes this mark.
    static constexpr std::uint32_t kUnknown = 0;
    static constexpr std::uint32_t kLeftAlone = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] static bool is_active(std::uint32_t next, std::uint32_t now) { return next <= now; }
    [[nodiscard]] static bool is_free(std::uint32_t next, std::uint32_t now) { return next + 1U > now + 1U; }
    void set(std::size_t i, std::uint32_t next, const ContactCandidates& candidates, const ClearSpace& clear) {
        next_[i] = next;
        candidates_[i] = candidates;
        if (keeps_clear_spaces_) clear_[i] = clear;
    }
    [[nodiscard]] ContactCandidates candidates_for(std::uint32_t next, const FreeFlightForecast& forecast) const;

    const StepClock& clock_;
    std::uint64_t step_ = 0;
    std::uint32_t now_ = 1;  ///< one more than step_, limited to the range of numbers; real runs do not reach the limit
    std::vector<std::uint32_t> next_;
    std::vector<ContactCandidates> candidates_;
    bool keeps_clear_spaces_;
    std::vector<ClearSpace> clear_;  ///< one per particle if they are kept
};

}  // namespace ricochet
