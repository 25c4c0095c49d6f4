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

#include <span>
#include <vector>

#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file. Each particle goes back for itself; move_together() is the classic alternative.
class RollbackResponse final : public Response {
public:
    explicit RollbackResponse(const ResponseRules& rules) : Response(rules) {}

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
};

/// A particle as one of a system that goes back together.
struct SystemParticle {
    MovingParticle particle;
    double start = 0.0;  ///< s, where its part of the step begins
    double stop = 0.0;   ///< s, and ends
    MoveOutcome outcome = {};
    std::vector<Segment> segments = {};  ///< filled when the scratch records segments
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

}  // namespace ricochet
