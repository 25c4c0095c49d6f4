/// \file
/// The rollback response (backtracking): take the step, find that it collided, go back to the time of contact, answer,
/// go on with the time that is left.
///
/// Source: the particle systems of computer graphics, e.g. A. Witkin, D. Baraff, "Physically Based Modeling", SIGGRAPH
/// 2001 course notes, part C (colliding and resting contact; bisection for the time of collision), and M. Moore, J.
/// Wilhelms, "Collision detection and response for computer animation", SIGGRAPH 1988 (backing up to the collision).
/// The time of contact is bracketed by bisection to RollbackSettings::time_tolerance; every trial is the integrator
/// stepped again from the start. The particle is put at the bracket's free end, so the tolerance is the only error.
///
/// What it guarantees: the chord of every accepted step crosses no surface, exactly (obstacles.h).
/// What it does not guarantee: that a collision is noticed whose traces are gone at the end of the step (an arc that
/// dips through a surface and comes back, a sphere that brushes past an edge), nor that one which is noticed is real (a
/// chord that cuts a corner which the arc passes over, by a sag of up to a h^2 / 8); that the first of several
/// collisions is the one found (bisection finds one at which free turns into blocked); the time of impact to better
/// than the tolerance; that sliding along a surface that bends away follows it, nor that friction feels a bowl's
/// curvature; with the symplectic Euler step, that `global` keeps the energy, since every part of a step kicks anew.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/obstacles.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file. Each particle goes back for itself; move_together() is the classic alternative.
class RollbackResponse final : public Response {
public:
    explicit RollbackResponse(const ResponseRules& rules) : Response(rules) {}

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;
};

/// A particle as one of a system that goes back together.
struct SystemParticle {
    MovingParticle particle;
    double start = 0.0;  ///< s, where its part of the step begins
    double stop = 0.0;   ///< s, and ends
    MoveOutcome outcome = {};
    std::vector<Segment> segments = {};  ///< filled when the scratch records segments
    Vec3 surface_impulse{};              ///< N s, that surfaces have given it
    bool is_out = false;                 ///< it is done with the step: its budget is spent, or it rests in a pit
    int idle = 0;                        ///< pieces of contact in a row without progress
};

/// The global variant, as the lectures teach it for the whole system's state vector: when any particle collides within
/// the step, all go back to the earliest contact, the particles in contact then are answered, and the whole system
/// takes what is left of the step as a new step. Steps from `from` to `to`, s. A particle whose bounce budget is spent
/// is left out for the rest of the step; its time is counted as unsimulated.
///
/// blocks: scratch of the blocks of `block_size` particles, each used by one thread at a time.
void move_together(const ResponseRules& rules, std::span<SystemParticle> particles, double from, double to,
                   std::span<MoveScratch> blocks, std::size_t block_size);

// One particle between two collisions.

/// A bracket around the time of a collision, s from where the piece began.
struct CollisionBracket {
    double free = 0.0;     ///< latest time tried at which nothing blocks
    bool blocked = false;  ///< something blocks right after it; false: the whole piece is free
};

/// In contact is what is nearer than the particle can move within the tolerance of a time of contact, and is not left
/// faster than the resting speed. kick: m/s, at which what rests may have come down.
[[nodiscard]] TouchRule rollback_touch(const ResponseRules& rules, const ForceInput& state, double force_velocity);

/// See above. It goes in pieces, each a flight or a contact interval.
class RollbackMover {
public:
    /// What a trial of a shorter time is: a point of the same flight, or a step of its own.
    enum class Trial { same_flight, own_step };

    RollbackMover(const ResponseRules& rules, MovingParticle& particle, MoveScratch& scratch, MoveOutcome& outcome,
                  Trial trial);

    /// The whole step of one particle on its own.
    void run(double duration);

    /// Begins the next piece, of at most `duration` seconds: a flight or a contact interval. False when the
    /// state cannot be followed: the particle is frozen then.
    bool begin(double duration);
    /// How far the piece goes; a contact interval may end before the duration asked for.
    [[nodiscard]] CollisionBracket bracket();
    /// Goes along the piece for a time that the bracket has found free.
    void advance(double elapsed);
    /// Answers what blocks at the bracket's blocked end. The particle has gone to its free end.
    void resolve();
    /// True while it slides, rolls or rests.
    [[nodiscard]] bool in_contact() const { return !manifold_.empty(); }
    /// Rests where it is for the time given.
    void rest(double duration);
    /// Keeps the contact for the next step.
    void keep_contact() { particle_.contact = manifold_.contact_state(); }
    [[nodiscard]] bool has_budget() const { return outcome_.meetings() < rules_.settings.bounce_budget; }

private:
    [[nodiscard]] Flight flight_for(double duration) const;
    [[nodiscard]] PhaseState state_at(double elapsed) const;
    void fly(double elapsed);
    void follow_interval(double elapsed);
    void leave_surface();
    /// This step's force has acted already (symplectic Euler).
    [[nodiscard]] bool is_kicked() const { return flown_ && flown_->kick_duration > 0.0; }
    [[nodiscard]] bool will_stay() const;

    [[nodiscard]] TouchRule touch_rule() const;
    void plan_contact(double duration);
    void limit_interval();
    void turn_along();

    const ResponseRules& rules_;
    MovingParticle& particle_;
    ForceInput& state_;
    MoveScratch& scratch_;
    MoveOutcome& outcome_;
    SurfaceGeometry geometry_;
    ContactManifold manifold_;
    ImpactResolver impact_;
    Trial trial_;
    Vec3 from_;              // where the piece began
    Vec3 blocked_position_;  // the bracket's blocked end
    Flight flight_;
    std::optional<Flight> flown_;  // the last flight of this step
    Vec3 kick_velocity_;           // what kicks have put into the velocity since the last piece began, m/s
    std::optional<ContactInterval> interval_;
    bool turns_ = false;  // the interval is a chord of a surface that bends towards the particle
    Vec3 pull_;           // the forces' acceleration at the interval's start
    std::vector<ContactSurface> hit_;
};

}  // namespace ricochet
