/// \file
/// The rollback response (backtracking). It takes the step and tests whether the particle has collided. If so, it goes
/// back to the time of contact, resolves the contact, and continues with the remaining time.
///
/// Source: the particle systems of computer graphics, e.g. A. Witkin, D. Baraff, "Physically Based Modeling", SIGGRAPH
/// 2001 course notes, part C (colliding and resting contact; bisection for the time of collision), and M. Moore, J.
/// Wilhelms, "Collision detection and response for computer animation", SIGGRAPH 1988 (backing up to the collision).
/// Bisection brackets the time of contact to RollbackSettings::time_tolerance. Every trial is a step of the integrator
/// from the start. The particle is placed at the bracket's free end, so the tolerance is the only error.
///
/// Guarantee: the chord of every accepted step crosses no surface, which is decided exactly (obstacles.h).
///
/// Limits:
/// - A collision is not detected if the chord of the step shows no sign of it. Examples are an arc that dips through a
///   surface and comes back, and a sphere that brushes past an edge.
/// - A detected collision may not be real, because a chord may cut a corner that the arc passes. The distance of the
///   arc from the chord is up to a h^2 / 8.
/// - If several collisions occur in a step, bisection finds one of them, which need not be the first.
/// - The time of impact is not more accurate than the tolerance.
/// - A particle that slides along a convex surface does not follow it. Friction does not include the pressure by the
///   curvature of a bowl.
/// - With the symplectic Euler step, `global` does not keep the energy, because every part of a step has its own kick.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/obstacles.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file. Each particle goes back individually; move_together() is the classic alternative.
class RollbackResponse final : public Response {
public:
    explicit RollbackResponse(const ResponseRules& rules) : Response(rules) {}

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;
};

/// A particle of a system that goes back together.
struct SystemParticle {
    MovingParticle particle;
    double start = 0.0;  ///< s, start of its part of the step
    double stop = 0.0;   ///< s, end of its part of the step
    MoveOutcome outcome = {};
    std::vector<Segment> segments = {};  ///< filled if the scratch memory records segments
    Vec3 surface_impulse{};              ///< N s, given to the particle by surfaces
    bool is_out = false;                 ///< no longer moves in this step: without budget, or at rest in a pit
    int idle = 0;                        ///< number of consecutive pieces of contact without progress
};

/// Moves a system by the global variant, as the course notes describe it for the state vector of the whole system. If
/// any particle collides within the step, all particles go back to the earliest contact. The whole system then takes
/// the rest of the step as a new step. The step lasts from `from` to `to`, in s. A particle whose bounce budget is
/// spent no longer moves; the rest of its time is unsimulated.
///
/// blocks: scratch memory, one element per block of `block_size` particles, each used by one thread at a time.
void move_together(const ResponseRules& rules, std::span<SystemParticle> particles, double from, double to,
                   std::span<MoveScratch> blocks, std::size_t block_size);

// One particle between two collisions.

/// A bracket around the time of a collision, in s from the start of the piece.
struct CollisionBracket {
    double free = 0.0;     ///< latest time tried without a collision
    bool blocked = false;  ///< true: a surface blocks right after `free`; false: the whole piece is free
};

/// Returns the touch rule of this response. A touched surface is nearer than the path of the particle within a few time
/// tolerances. The particle must not leave it faster than the resting speed. force_velocity: speed, in m/s, with which
/// a kick may have moved a resting particle to its surface.
[[nodiscard]] TouchRule rollback_touch(const ResponseRules& rules, const ForceInput& state, double force_velocity);

/// Moves one particle in pieces, each of which is a flight or a contact interval.
class RollbackMover {
public:
    /// Kind of a trial over a shorter time: a point of the same flight, or a separate step.
    enum class Trial { same_flight, own_step };

    RollbackMover(const ResponseRules& rules, MovingParticle& particle, MoveScratch& scratch, MoveOutcome& outcome,
                  Trial trial);

    /// Moves one particle on its own over the whole step, of a duration in s.
    void run(double duration);

    /// Begins the next piece, of at most `duration`, in s: a flight or a contact interval. Returns false if the state
    /// cannot be followed. The particle is then frozen.
    bool begin(double duration);
    /// Returns for how long the piece is free. A contact interval may end before the requested duration.
    [[nodiscard]] CollisionBracket bracket();
    /// Moves along the piece for a time, in s. bracket() must have found this time free.
    void advance(double elapsed);
    /// Resolves the contact at the bracket's blocked end. The particle must be at the free end.
    void resolve();
    /// Returns true if the particle slides, rolls or rests.
    [[nodiscard]] bool in_contact() const { return !manifold_.empty(); }
    /// Lets the particle rest at its position for a duration, in s.
    void rest(double duration);
    /// Stores the contact for the next step.
    void keep_contact() { particle_.contact = manifold_.contact_state(); }
    [[nodiscard]] bool has_budget() const { return outcome_.meetings() < rules_.settings.bounce_budget; }

private:
    [[nodiscard]] Flight flight_for(double duration) const;
    [[nodiscard]] PhaseState state_at(double elapsed) const;
    void fly(double elapsed);
    void follow_interval(double elapsed);
    void leave_surface();
    /// Returns true if this step's force has already acted (symplectic Euler).
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
    Vec3 from_;              // start of the piece
    Vec3 blocked_position_;  // the bracket's blocked end
    Flight flight_;
    std::optional<Flight> flown_;  // the last flight of this step
    Vec3 kick_velocity_;           // m/s, velocity from kicks since the start of the last piece
    std::optional<ContactInterval> interval_;
    bool turns_ = false;  // true: the interval is a chord of a surface that curves towards the particle
    Vec3 pull_;           // acceleration by forces at the start of the interval
    std::vector<ContactSurface> hit_;
};

}  // namespace ricochet
