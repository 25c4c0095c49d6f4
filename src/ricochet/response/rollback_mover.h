/// \file
/// Private to the rollback response: one particle between two collisions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/obstacles.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/impact_answer.h"

namespace ricochet {

/// A bracket around the time of a collision, s from where the piece began.
struct CollisionBracket {
    double free = 0.0;     ///< latest time tried at which nothing is in the way
    bool blocked = false;  ///< something is in the way right after it; false: the whole piece is free
};

/// Pieces of contact shorter than this part of the step are no progress; kMaxSlowContacts of them in a row are rest.
inline constexpr double kLeastProgress = 0x1p-20;

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
    /// Answers what is in the way at the bracket's blocked end. The particle has gone to its free end.
    void answer();
    /// True while it slides, rolls or rests.
    [[nodiscard]] bool in_contact() const { return !manifold_.empty(); }
    /// Rests where it is for the time given.
    void rest(double duration);
    /// Keeps the contact for the next step.
    void keep_contact() { particle_.contact = manifold_.kept(); }
    [[nodiscard]] bool has_budget() const { return outcome_.bounces < rules_.settings.bounce_budget; }

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
    ImpactAnswer impact_;
    Trial trial_;
    Vec3 from_;              // where the piece began
    Vec3 blocked_position_;  // the bracket's blocked end
    Flight flight_;
    std::optional<Flight> flown_;  // the last flight of this step
    Vec3 kick_velocity_;           // what kicks have put into the velocity since the last piece began, m/s
    std::optional<ContactInterval> interval_;
    bool turns_ = false;  // the interval is a chord of a surface that bends towards the particle
    Vec3 pull_;           // the forces' acceleration at the interval's start
    std::vector<ContactSurface> met_;
};

}  // namespace ricochet
