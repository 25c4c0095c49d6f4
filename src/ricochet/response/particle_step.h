/// \file
/// The state of one particle within a step. All stages of its motion use the same object.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/motion_log.h"
#include "ricochet/response/reference_frame.h"

namespace ricochet {

/// Remaining time of a step, in s, and of a substep, which ends when the velocity of a touched body changes.
class StepTime {
public:
    explicit StepTime(double duration) : duration_(duration), remaining_(duration) {}

    [[nodiscard]] double duration() const { return duration_; }    ///< s, of the whole step
    [[nodiscard]] double remaining() const { return remaining_; }  ///< s, of the substep, if any, else of the step
    [[nodiscard]] const std::optional<double>& substep_end() const { return substep_end_; }

    void pass(double duration) { remaining_ = std::max(0.0, remaining_ - duration); }
    void end() { remaining_ = 0.0; }
    /// Begins a substep that ends at `until`, but not after the step. Sets MovingParticle::step_end to this end. If a
    /// substep has begun already, shortens it, so that both end together.
    void begin_substep(double until, MovingParticle& particle);
    /// Ends the substep, if there is one. If its time is used up, sets the particle's time to the end of the substep.
    void end_substep(MovingParticle& particle);

private:
    double duration_;
    double remaining_;
    std::optional<double> substep_end_;
    double rest_after_substep_ = 0.0;
    double whole_step_end_ = 0.0;
};

/// The chain of certified segments on which a particle moves. Segments are recorded if MoveScratch asks for that.
class SegmentChain {
public:
    SegmentChain(const MovingParticle& particle, const MoveScratch& scratch, bool is_timed)
        : stored_{particle.state.position, particle.stored_time}, is_timed_(is_timed) {
        begin(particle.state.position, scratch);
    }

    /// Returns true if colliders move. Otherwise the stored position and the times of segments are not used.
    [[nodiscard]] bool is_timed() const { return is_timed_; }
    /// Returns the position in the world, and its time.
    [[nodiscard]] const StoredPosition& stored() const { return stored_; }
    void store(const StoredPosition& position) { stored_ = position; }
    /// Adds a segment from the stored position to `next`, and stores `next`. recorded_at: Segment::time.
    void add(const StoredPosition& next, double recorded_at, MoveScratch& scratch);
    /// Begins a new chain at a position in the reference frame.
    void begin(const Vec3& position, const MoveScratch& scratch) {
        start_ = position;
        first_segment_ = scratch.segments.size();
    }
    /// Returns the start of the chain in the reference frame, beside the surface on which the particle was placed.
    [[nodiscard]] const Vec3& start() const { return start_; }
    /// Returns the index of the chain's first segment in MoveScratch::segments.
    [[nodiscard]] std::size_t first_segment() const { return first_segment_; }

private:
    StoredPosition stored_;
    bool is_timed_;
    Vec3 start_;
    std::size_t first_segment_ = 0;
};

/// One particle within a step. Its state is given in the reference frame: the world, or the frame of a body that it
/// touches. The stored position is in the world. These stages read and change the object:
/// - path_motion.h flies and finds contacts.
/// - certified_motion.h certifies segments and stops the particle.
/// - carried_particle.h lets the particle wait among moving colliders.
/// - impact_resolver.h resolves impacts.
/// - contact_phase.h follows contact.
///
/// All of them refer to the same MovingParticle.
class ParticleStep {
public:
    /// rules, particle and scratch must outlive the object.
    ParticleStep(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch);
    ParticleStep(const ParticleStep&) = delete;
    ParticleStep& operator=(const ParticleStep&) = delete;

    // The particle in the reference frame.

    [[nodiscard]] const ResponseRules& rules() const { return *rules_; }  ///< of the reference frame
    [[nodiscard]] MovingParticle& particle() const { return particle_; }
    [[nodiscard]] ForceInput& state() const { return particle_.state; }
    [[nodiscard]] MoveScratch& scratch() const { return scratch_; }
    [[nodiscard]] const SurfaceGeometry& geometry() const { return geometry_; }
    [[nodiscard]] const ReferenceFrame& reference() const { return reference_; }
    /// Changes the reference frame from the world to that of a body, with its rules. Also turns the contact's normals.
    void enter(BodyId body, const ResponseRules& rules, Contact* contact);
    /// Changes the reference frame back to the world.
    void leave(const ResponseRules& rules, Contact* contact);

    // Results of the stages.

    [[nodiscard]] ImpactResolver& impact() { return impact_; }
    [[nodiscard]] const ImpactResolver& impact() const { return impact_; }
    [[nodiscard]] MotionLog& log() { return log_; }
    [[nodiscard]] MoveOutcome& outcome() { return outcome_; }
    [[nodiscard]] const MoveOutcome& outcome() const { return outcome_; }

    // Time.

    [[nodiscard]] double duration() const { return time_.duration(); }
    [[nodiscard]] double remaining() const { return time_.remaining(); }
    void pass(double duration) {
        state().time += duration;
        time_.pass(duration);
    }
    void end() { time_.end(); }
    void begin_substep(double until) { time_.begin_substep(until, particle_); }
    void end_substep() { time_.end_substep(particle_); }

    [[nodiscard]] SegmentChain& chain() { return chain_; }
    [[nodiscard]] const SegmentChain& chain() const { return chain_; }

    // Tests for moving colliders that may come near.

    [[nodiscard]] PathClock clock_of(const Path& path) const;
    /// Returns false if all moving colliders stay away from the path.
    [[nodiscard]] bool is_among_bodies(const Path& path) const;
    /// Returns true if a moving collider, or the frame's body, may come to the particle's position in the time left.
    [[nodiscard]] bool is_near_bodies() const {
        return is_among_bodies(line_path(particle_.state.position, Vec3{}, remaining()));
    }

    // Limits.

    /// Returns the speed of the slowest rebound, in m/s: the scene's resting speed, or more for a dynamic body.
    [[nodiscard]] double resting_speed() const { return resting_speed_; }
    void set_resting_speed(double speed) { resting_speed_ = speed; }
    void note_interval() { ++intervals_; }
    /// Returns false if the budget of bounces is used up. The first kFreeIntervals contact intervals are free. After
    /// these, kIntervalsOfBounce intervals count as one bounce. Otherwise, fast sliding in a round shape of nearly the
    /// sphere's size could use kFreeIntervals intervals per impact.
    [[nodiscard]] bool has_budget() const {
        const std::uint32_t intervals = std::max(intervals_, kFreeIntervals) - kFreeIntervals;
        const std::uint32_t spent = particle_.bounces_before + outcome_.meetings() + intervals / kIntervalsOfBounce;
        return spent < rules_->settings.bounce_budget;
    }
    /// Returns true if contact may have another interval.
    [[nodiscard]] bool has_intervals() const { return intervals_ < kFreeIntervals || has_budget(); }

private:
    void turn_contact(Contact* contact, const ReferenceFrame& from, const ReferenceFrame& to) const;

    const ResponseRules* rules_;
    MovingParticle& particle_;
    MoveScratch& scratch_;
    ReferenceFrame reference_;
    SurfaceGeometry geometry_;
    MoveOutcome outcome_;
    ImpactResolver impact_;
    MotionLog log_;
    SegmentChain chain_;
    StepTime time_;
    double resting_speed_;
    std::uint32_t intervals_ = 0;  // number of contact intervals
};

}  // namespace ricochet
