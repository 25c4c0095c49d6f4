/// \file
/// Private to the simulation: the steps of particles in free flight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/algorithms.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

/// The latest steps, and the number of them that each particle has made. A particle in free flight makes these steps
/// together when it needs a query, so that it is fetched from memory only once for many steps.
class DeferredSteps {
public:
    /// Largest number of stored steps. They stay in the L1 cache, and a count fits into a byte.
    static constexpr std::size_t kMost = 64;

    /// Starts with `count` particles that have no deferred steps.
    explicit DeferredSteps(std::size_t count) : made_(count, 0) {}

    /// Adds a step that all particles in free flight defer. Must not be called if is_full().
    void add(const FreeFlight& step) {
        is_straight_ = (is_empty() || is_straight_) && step.is_straight() && step.duration() >= kShortestStraight;
        steps_.push_back(step);
    }
    [[nodiscard]] bool is_full() const { return steps_.size() == kMost; }
    [[nodiscard]] bool is_empty() const { return steps_.empty(); }

    /// Adds a particle that is spawned in the present step. The particle has no deferred steps.
    void append() { made_.push_back(static_cast<std::uint8_t>(steps_.size())); }
    /// Reserves memory for `more` particles.
    void reserve(std::size_t more) { grow_capacity_by(made_, more); }
    /// Keeps the particles whose flag is not 0.
    void compact(const std::vector<std::uint8_t>& keep) { keep_marked(made_, keep); }

    /// Returns the state of a particle after its deferred steps.
    [[nodiscard]] PhaseState after(std::size_t i, PhaseState state) const {
        std::size_t k = made_[i];
        if (k >= steps_.size()) return state;  // a failed step can leave made_[i] above the number of steps
        state = steps_[k++].step(state.position, state.velocity);
        if (is_straight_ && moves_far(state.velocity)) return straight_on(k, state);
        for (; k < steps_.size(); ++k) state = steps_[k].step(state.position, state.velocity);
        return state;
    }
    /// Marks a particle that has made all stored steps and the present step.
    void make_next(std::size_t i) { made_[i] = static_cast<std::uint8_t>(steps_.size() + 1); }
    /// Marks a particle that has slept during all stored steps, so that it has no deferred steps.
    void skip(std::size_t i) { made_[i] = static_cast<std::uint8_t>(steps_.size()); }
    /// Removes all steps. Must be called only after every particle has made them.
    void clear() {
        steps_.clear();
        std::ranges::fill(made_, std::uint8_t{0});
    }

private:
    // flush_tiny() does not change the end of a step along an axis by 0 or by at least 2^-230 m. If the position nearly
    // cancels it, both are multiples of 2^-283 m, and so is their sum. Local: this proof needs the bounds.
    static constexpr double kShortestStraight = 0x1p-100;  ///< s
    static constexpr double kSlowestStraight = 0x1p-130;   ///< m/s

    [[nodiscard]] static bool moves_far(const Vec3& velocity) {
        const auto far = [](double v) { return v == 0.0 || std::fabs(v) >= kSlowestStraight; };
        return far(velocity.x) && far(velocity.y) && far(velocity.z);
    }

    /// Returns the same result as FreeFlight::step() with fewer operations that depend on each other.
    [[nodiscard]] PhaseState straight_on(std::size_t k, PhaseState state) const {
        for (; k < steps_.size(); ++k) state.position += steps_[k].duration() * state.velocity;
        return state;
    }

    bool is_straight_ = true;  ///< true if all steps are straight and no step is very short
    std::vector<FreeFlight> steps_;
    std::vector<std::uint8_t> made_;  ///< number of steps that each particle has made
};

/// Advances the particles in free flight, and finds those that need a query, at the beginning of every step.
class FreeFlights {
public:
    /// All arguments must outlive the object.
    FreeFlights(ParticleStore& store, QuerySchedule& schedule, const ResponseRules& rules, const MoveHooks& hooks)
        : store_(store), schedule_(schedule), rules_(rules), hooks_(hooks) {}

    /// Advances the free flights of the range, and the flights that stay in known free space. Returns the particles
    /// that need a query, ascending, in blocks of the range.
    [[nodiscard]] ActiveSet advance(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// Starts to defer steps. Particles in free flight then keep their stored state, and make several steps together
    /// before their next query. Must be called only if no code reads the states of these particles in between. Has no
    /// effect if the particles have different accelerations.
    void begin_deferring();
    [[nodiscard]] bool is_deferring() const { return deferred_.has_value(); }
    /// Integrates the deferred steps of all particles, and stops deferring.
    void end_deferring();
    /// Includes a woken particle from the next step on.
    void wake(std::size_t i) {
        if (deferred_) deferred_->skip(i);
    }
    /// Discards deferred steps without integrating them.
    void drop_deferred() { deferred_.reset(); }

    // These functions have the same meaning as the functions of Particles.
    void append() {
        if (deferred_) deferred_->append();
    }
    void reserve(std::size_t more) {
        if (deferred_) deferred_->reserve(more);
    }
    void compact(const std::vector<std::uint8_t>& keep) {
        if (deferred_) deferred_->compact(keep);
    }

private:
    void advance_together(std::size_t begin, std::size_t end, const FreeFlight& flight);
    void advance_each(std::size_t begin, std::size_t end, const TimeSpan& step, BlockRecord* record);
    void fly_in_clear_spaces(std::size_t begin, std::size_t end, const TimeSpan& step, BlockRecord* record);
    [[nodiscard]] std::optional<Flight> clear_flight(std::size_t i, const TimeSpan& step) const;
    [[nodiscard]] FlownPiece piece_to(std::size_t i, const PhaseState& end, const Vec3& acceleration,
                                      const TimeSpan& step) const;
    void report(std::size_t i, const FlownPiece& piece, const TimeSpan& step, BlockRecord& record) const;
    void catch_up(std::size_t i);
    void catch_up_active(std::span<const std::uint32_t> active);
    void catch_up_all();

    ParticleStore& store_;
    QuerySchedule& schedule_;
    const ResponseRules& rules_;
    const MoveHooks& hooks_;
    std::optional<DeferredSteps> deferred_;
};

}  // namespace ricochet
