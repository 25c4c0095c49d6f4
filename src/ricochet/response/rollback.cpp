#include "ricochet/response/rollback.h"

#include <algorithm>
#include <limits>

#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/supported_acceleration.h"

namespace ricochet {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Next event of a particle as if it moved alone.
struct Event {
    double elapsed = 0.0;  ///< s, time for which it can move before the event
    double time = kNever;  ///< s, time of a collision or of a change of contact; kNever: not in this step
    bool collides = false;
};

/// The classic variant: one step of the whole system.
class SystemRollback {
public:
    SystemRollback(const ResponseRules& rules, std::span<SystemParticle> particles, std::span<MoveScratch> blocks,
                   std::size_t block_size)
        : rules_(rules), particles_(particles), blocks_(blocks), block_size_(block_size), events_(particles.size()) {}

    void run(double from, double to) {
        for (double now = from; now < to;) {
            for_each(
                [&](SystemParticle& p, Event& event, MoveScratch& scratch) { event = next_event(p, now, scratch); });
            double next = to;
            for (const Event& event : events_) next = std::min(next, event.time);
            for_each(
                [&](SystemParticle& p, const Event& event, MoveScratch& scratch) { go(p, event, now, next, scratch); });
            now = next;
        }
    }

private:
    template <class Body>
    void for_each(Body&& body) {
        parallel_for_blocks(particles_.size(), block_size_, [&](std::size_t block, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                SystemParticle& p = particles_[i];
                MoveScratch& scratch = blocks_[block];
                scratch.segments.clear();
                const std::size_t first_hit = scratch.hits.size();
                body(p, events_[i], scratch);
                for (std::size_t k = first_hit; k < scratch.hits.size(); ++k)
                    p.surface_impulse -= scratch.hits[k].impulse;
                p.segments.insert(p.segments.end(), scratch.segments.begin(), scratch.segments.end());
            }
        });
    }

    [[nodiscard]] static bool is_out(const SystemParticle& p) {
        return p.is_out || p.outcome.is_frozen() || p.outcome.is_absorbed();
    }

    /// Returns the time, in s, at which the particle continues. It may be ahead of the system by the time tolerance.
    [[nodiscard]] static double begin_of(const SystemParticle& p, double now) {
        return std::max({now, p.start, p.particle.state.time});
    }

    /// Returns the next event of the particle after `now`, found on a copy.
    [[nodiscard]] Event next_event(SystemParticle& p, double now, MoveScratch& scratch) const {
        const double begin = begin_of(p, now);
        const double duration = p.stop - begin;
        if (is_out(p) || !(duration > 0.0)) return {};
        MovingParticle copy = p.particle;
        RollbackMover mover(rules_, copy, scratch, p.outcome, RollbackMover::Trial::own_step);
        if (!mover.begin(duration)) return {};
        const CollisionBracket found = mover.bracket();
        const bool changes = found.blocked || found.free < duration;
        return {found.free, changes ? begin + found.free : kNever, found.blocked};
    }

    /// Moves a particle with the system to `next`, and resolves its collisions until then. A shorter step may be
    /// blocked or end early although the longer step was free. The particle then moves in pieces.
    void go(SystemParticle& p, const Event& event, double now, double next, MoveScratch& scratch) const {
        const double end = std::min(next, p.stop);
        // A due event is repeated exactly as in its trial, even if it takes less time than the clock can resolve.
        bool needs_query = event.time <= next + (event.collides ? rules_.settings.rollback.time_tolerance : 0.0);
        for (double at = begin_of(p, now); !is_out(p) && (needs_query || at < end); needs_query = false) {
            RollbackMover mover(rules_, p.particle, scratch, p.outcome, RollbackMover::Trial::own_step);
            if (!mover.begin(needs_query ? p.stop - at : end - at)) return;
            const CollisionBracket found = mover.bracket();
            mover.advance(found.free);
            at += found.free;
            if (found.blocked && !mover.has_budget()) {
                p.is_out = true;
                p.outcome.unsimulated_time += p.stop - at;
            } else if (found.blocked) {
                mover.resolve();
            }
            if (p.outcome.is_absorbed()) return;
            rest_in_pit(p, mover, found.free, at);
            mover.keep_contact();
        }
    }

    /// Ends contact without progress as rest, as RollbackMover::run() does.
    static void rest_in_pit(SystemParticle& p, RollbackMover& mover, double elapsed, double at) {
        const bool idles = mover.in_contact() && elapsed < kLeastProgress * (p.stop - p.start);
        p.idle = idles ? p.idle + 1 : 0;
        if (p.idle <= kMaxSlowContacts) return;
        mover.rest(p.stop - at);
        p.is_out = true;
    }

    const ResponseRules& rules_;
    std::span<SystemParticle> particles_;
    std::span<MoveScratch> blocks_;
    std::size_t block_size_;
    std::vector<Event> events_;
};

}  // namespace

MoveOutcome RollbackResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    MoveOutcome outcome;
    RollbackMover(rules_, particle, scratch, outcome, RollbackMover::Trial::same_flight).run(duration);
    return outcome;
}

SupportedAcceleration RollbackResponse::supported_acceleration(const MovingParticle& particle, const Vec3& pull) const {
    return acceleration_in_contact(rules_, particle, pull, rollback_touch(rules_, particle.state, 0.0));
}

void move_together(const ResponseRules& rules, std::span<SystemParticle> particles, double from, double to,
                   std::span<MoveScratch> blocks, std::size_t block_size) {
    SystemRollback(rules, particles, blocks, block_size).run(from, to);
}

}  // namespace ricochet
